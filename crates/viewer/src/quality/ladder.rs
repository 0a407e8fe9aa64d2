//! What drafts give up so that they need not be coarser, one thing after the other: what is missed least goes first.
//!
//! At first light that hardly counts: rays of little weight are not traced. Then one or two generations of rays, if the
//! draft had less than half the window's width otherwise; and all that can be spared only if it had less than a quarter.
//!
//! What drafts of the same time (61 ms of processor time, 1280×720) are like on each rung: their share of the width, and how
//! like they are, enlarged, to the finished picture (peak signal-to-noise ratio, mean of three views):
//!
//! | | mix-50000 | mix-1000 | all4-1000 | still life |
//! | --- | --- | --- | --- | --- |
//! | as set | 41 %, 26.1 dB | 72 %, 33.1 dB | 23 %, 33.6 dB | 44 %, 28.9 dB |
//! | weights from 1/64 | 47 %, 27.0 dB | 82 %, 33.7 dB | 32 %, 34.1 dB | 47 %, 29.3 dB |
//! | weights from 1/32 | 48 %, 27.0 dB | 82 %, 33.7 dB | 41 %, 33.5 dB | 50 %, 29.1 dB |
//! | and a generation less | 51 %, 27.2 dB | 85 %, 33.3 dB | 41 %, 33.5 dB | 49 %, 29.4 dB |
//! | and two less | 55 %, 26.9 dB | 90 %, 30.9 dB | 42 %, 33.6 dB | 50 %, 29.4 dB |
//! | weights from 1/16 instead | 54 %, 27.4 dB | 91 %, 33.5 dB | 46 %, 30.3 dB | 57 %, 26.2 dB |
//!
//! Half the depth would make the bubble in the still life's glass black, for one part in a hundred of its width.

/// Least weights of rays, after that of the settings. With 1/24, the mirror images in glass would be lost, which reflects a
/// 25th: they are missed more than resolution.
const WEIGHTS: [f32; 2] = [1.0 / 64.0, 1.0 / 32.0];

/// How coarse drafts may be on each rung before the next is taken, in pixels of the window along an edge of a pixel that is
/// drawn; and on all others. Light of less than 1/64 is worth no resolution at all.
const BEARABLE: [f64; 4] = [1.0, 2.0, 2.0, 2.0];
const BARELY_BEARABLE: f64 = 4.0;

/// The rung above is taken if it would leave so much of what is bearable there.
const MARGIN: f64 = 0.92;

/// So many drafts in a row must ask for a step: a moment in which other programs take the processor is no reason, and what
/// comes and goes is worse than what is missing.
const DOWN: u32 = 8;
const UP: u32 = 20;

/// Before it was measured: how many times as dear a pixel is on the rung above.
const GUESS: f64 = 1.2;

/// What is believed of such a measurement: the camera moves meanwhile.
const LIKELY: [f64; 2] = [1.0, 4.0];

/// Fewest generations of secondary rays that are kept if there are as many: light goes into glass, out of it, and is
/// mirrored. With less, glass is black.
const LEAST_DEPTH: u32 = 3;

/// Which of them are given up.
#[derive(Clone, Debug, Default)]
pub(super) struct Ladder {
    /// 0: nothing.
    rung: usize,
    /// How many times as dear a pixel is on a rung as on the next.
    prices: Vec<f64>,
    /// The way to which drafts have pointed lately, and how many in a row.
    asked: (Way, u32),
    /// The rung before this one, the cost of a pixel there, and the drafts since.
    left: Option<(usize, f64, u32)>,
}

/// A step on the ladder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Way {
    #[default]
    Stay,
    Down,
    Up,
}

impl Ladder {
    /// Depth and least weight of a draft where the settings have these.
    pub(super) fn limits(&self, depth: u32, min_weight: f32) -> (u32, f32) {
        let less_depth = self.rung.saturating_sub(WEIGHTS.len()) as u32;
        let least_depth = depth.min(LEAST_DEPTH);
        let weight = self.rung.min(WEIGHTS.len()).checked_sub(1).map_or(0.0, |index| WEIGHTS[index]);
        (depth.saturating_sub(less_depth).max(least_depth), min_weight.max(weight))
    }

    /// The next draft of a picture of this depth would have to be so coarse, at this cost of a pixel: perhaps take another
    /// rung, the next only if that `is_settled`. How many times as dear a pixel is there, about.
    pub(super) fn step(&mut self, coarseness: f64, is_settled: bool, cost: f64, depth: u32) -> f64 {
        let lowest = WEIGHTS.len() + depth.saturating_sub(LEAST_DEPTH) as usize;
        self.learn(cost);
        let way = self.way(coarseness, is_settled, lowest);
        let (asked, times) = self.asked;
        self.asked = (way, if way == asked { times + 1 } else { 1 });
        let before = self.rung;
        match (way, self.asked.1) {
            (Way::Down, DOWN..) => self.rung += 1,
            (Way::Up, UP..) => self.rung -= 1,
            _ => return 1.0,
        }
        self.asked = (Way::Stay, 0);
        self.left = Some((before, cost, 0));
        let price = self.price(before.min(self.rung));
        if self.rung < before { price } else { 1.0 / price }
    }

    fn way(&self, coarseness: f64, is_settled: bool, lowest: usize) -> Way {
        match self.rung.checked_sub(1) {
            // Settings with less depth have fewer rungs.
            Some(above) if self.rung > lowest || coarseness * self.price(above).sqrt() < bearable(above) * MARGIN => {
                Way::Up
            }
            _ if is_settled && self.rung < lowest && coarseness > bearable(self.rung) => Way::Down,
            _ => Way::Stay,
        }
    }

    /// What the last step has changed, once it has lasted.
    fn learn(&mut self, cost: f64) {
        let Some((other, there, drafts)) = &mut self.left else { return };
        *drafts += 1;
        if *drafts >= DOWN {
            let (upper, ratio) = if *other < self.rung { (*other, *there / cost) } else { (self.rung, cost / *there) };
            self.left = None;
            if self.prices.len() <= upper {
                self.prices.resize(upper + 1, GUESS);
            }
            self.prices[upper] = if ratio.is_nan() { GUESS } else { ratio.clamp(LIKELY[0], LIKELY[1]) };
        }
    }

    fn price(&self, upper: usize) -> f64 {
        self.prices.get(upper).copied().unwrap_or(GUESS)
    }
}

/// How coarse drafts may be on this rung.
fn bearable(rung: usize) -> f64 {
    BEARABLE.get(rung).copied().unwrap_or(BARELY_BEARABLE)
}
