//! How good a picture can be while things move: from what the last ones took to the size and depth of the next.

use std::time::Duration;

/// The part of a frame's time that a draft may take on the average, enlarged: the rest is for frames that take longer.
const SHARE: f64 = 0.92;

/// The least resolution, in pixels of the window along an edge of a pixel that is drawn, before depth is given up, and
/// in all.
const COARSE: f64 = 8.0;
const COARSEST: f64 = 12.0;

/// Depth comes back when the resolution is this fine again: one generation more rarely doubles the rays.
const FINE: f64 = 5.5;

/// Sizes that differ by less than this factor are not worth the flicker of changing between them.
const STEADY: f64 = 1.06;

/// How much of what the last frame took is believed, if it was more or less than expected: a scene that looked cheap for a
/// moment is met slowly. Much less for the latter keeps the rate a half above its target where other programs take the
/// processor now and then: a fifth of the resolution.
const TRUST: [f64; 2] = [0.5, 0.35];

/// A frame that took more than this many times what was expected is believed at once.
const SURPRISE: f64 = 2.0;

/// A frame that takes this many times its budget is given up for a coarser one.
const PATIENCE: f64 = 1.6;

/// Before anything was measured: seconds for a pixel on one thread of a slow machine.
const FIRST_GUESS: f64 = 4e-6;

/// Fewest generations of secondary rays that are kept if there are as many: light goes into glass, out of it, and is
/// mirrored. With less, glass is black.
const LEAST_DEPTH: u32 = 3;

/// A picture to be drawn while things move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Draft {
    pub(crate) size: [u32; 2],
    pub(crate) depth: u32,
}

/// Decides how good drafts are.
#[derive(Clone, Debug)]
pub(crate) struct Quality {
    /// Seconds that a draft may take.
    budget: f64,
    /// Seconds for a pixel at the present depth.
    cost: f64,
    /// Pixels of the window along an edge of a pixel of the draft, ≥ 1.
    coarseness: f64,
    /// Generations that are left out.
    less_depth: u32,
    /// Whether the cost was measured in this scene, or is guessed.
    is_measured: bool,
}

impl Quality {
    /// For so many pictures a second, with so many threads.
    pub(crate) fn new(fps: f64, threads: usize) -> Self {
        Self {
            budget: SHARE / fps,
            cost: FIRST_GUESS / threads as f64,
            coarseness: COARSEST,
            less_depth: 0,
            is_measured: false,
        }
    }

    /// Forget what is known of the scene: it is another one.
    pub(crate) fn forget(&mut self) {
        // Half the resolution that was possible: if it is no longer, patience ends soon.
        self.cost *= 4.0;
        self.is_measured = false;
    }

    /// The next draft of a picture of this size and depth.
    pub(crate) fn draft(&mut self, size: [u32; 2], depth: u32) -> Draft {
        let [width, height] = size.map(f64::from);
        let coarseness = (self.cost * width * height / self.budget).sqrt();
        if self.is_measured {
            self.adapt_depth(coarseness, depth);
        }
        let coarseness = coarseness.clamp(1.0, COARSEST);
        let change = coarseness / self.coarseness;
        // Full resolution is a goal of its own: the last small step to it is taken.
        if !(1.0 / STEADY..=STEADY).contains(&change) || (coarseness == 1.0 && self.coarseness > 1.0) {
            self.coarseness = coarseness;
        }
        let side = |pixels: f64| (pixels / self.coarseness).round().max(1.0) as u32;
        Draft { size: [side(width), side(height)], depth: depth.saturating_sub(self.less_depth) }
    }

    fn adapt_depth(&mut self, coarseness: f64, depth: u32) {
        if coarseness > COARSE && depth.saturating_sub(self.less_depth) > LEAST_DEPTH {
            self.less_depth += 1;
        } else if coarseness < FINE {
            self.less_depth = self.less_depth.saturating_sub(1);
        }
    }

    /// `draft` took `seconds`, or that long for `share` of it when it was given up.
    pub(crate) fn measured(&mut self, draft: &Draft, seconds: f64, share: f64) {
        let pixels = f64::from(draft.size[0]) * f64::from(draft.size[1]) * share.max(f64::EPSILON);
        let cost = seconds / pixels;
        if cost.is_finite() {
            let trust = match cost / self.cost {
                ratio if ratio > SURPRISE => 1.0,
                ratio => TRUST[usize::from(ratio < 1.0)],
            };
            self.cost += (cost - self.cost) * trust;
            self.is_measured = true;
        }
    }

    /// How long a draft may take before it is given up; for the coarsest as long as it takes.
    pub(crate) fn patience(&self) -> Option<Duration> {
        (self.coarseness < COARSEST).then(|| Duration::from_secs_f64(self.budget * PATIENCE))
    }

    /// Linear resolution of drafts: 1 for that of the window.
    #[cfg(test)]
    fn resolution(&self) -> f64 {
        1.0 / self.coarseness
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FULL: [u32; 2] = [1280, 720];

    /// Let a machine with this cost of a pixel for each generation draw for some frames; what the last one took.
    fn draw(quality: &mut Quality, frames: usize, cost: f64, overhead: f64) -> (Draft, f64) {
        let mut last = (Draft { size: [0; 2], depth: 0 }, 0.0);
        for _ in 0..frames {
            let draft = quality.draft(FULL, 5);
            let [width, height] = draft.size.map(f64::from);
            let seconds = overhead + cost * f64::from(1 + draft.depth) * width * height;
            match quality.patience().map(|p| p.as_secs_f64()).filter(|&p| seconds > p) {
                Some(patience) => quality.measured(&draft, patience, patience / seconds),
                None => quality.measured(&draft, seconds, 1.0),
            }
            last = (draft, seconds);
        }
        last
    }

    #[test]
    fn the_rate_is_met_whatever_a_pixel_costs() {
        let mut quality = Quality::new(30.0, 2);
        for cost in [1e-9, 3e-8, 1e-7, 5e-7, 1e-8, 2e-7] {
            let (draft, seconds) = draw(&mut quality, 25, cost, 1e-3);
            assert!(seconds < 1.0 / 30.0, "{seconds} s for {draft:?} at {cost}");
        }
    }

    #[test]
    fn an_uneven_machine_is_used_to_the_full() {
        let mut quality = Quality::new(30.0, 2);
        let mut seconds = 0.0;
        for frame in 0..300 {
            seconds += draw(&mut quality, 1, 1e-7 * [0.8, 1.3, 0.9, 1.0, 1.1][frame % 5], 0.0).1;
        }
        let rate = 300.0 / seconds;
        assert!((30.0..36.0).contains(&rate), "{rate}");
    }

    #[test]
    fn what_is_cheap_is_drawn_in_full() {
        let mut quality = Quality::new(30.0, 2);
        let (draft, _) = draw(&mut quality, 20, 1e-9, 1e-3);
        assert_eq!(draft, Draft { size: FULL, depth: 5 });
    }

    #[test]
    fn resolution_gives_way_first_and_depth_comes_back() {
        let mut quality = Quality::new(30.0, 2);
        let (draft, _) = draw(&mut quality, 30, 6e-8, 0.0);
        assert_eq!(draft.depth, 5, "half the resolution is enough: {draft:?}");
        let (draft, _) = draw(&mut quality, 30, 3e-6, 0.0);
        assert!(draft.depth == LEAST_DEPTH && quality.resolution() < 0.2, "{draft:?}");
        let (draft, _) = draw(&mut quality, 60, 1e-9, 0.0);
        assert_eq!(draft, Draft { size: FULL, depth: 5 });
    }

    #[test]
    fn small_changes_do_not_flicker() {
        let mut quality = Quality::new(30.0, 2);
        draw(&mut quality, 30, 1e-7, 0.0);
        let size = quality.draft(FULL, 5).size;
        for step in 0..50 {
            let (draft, _) = draw(&mut quality, 1, 1e-7 * [0.97, 1.0, 1.03][step % 3], 0.0);
            assert_eq!(draft.size, size);
        }
    }

    #[test]
    fn a_tiny_window_and_odd_clocks_do_no_harm() {
        let mut quality = Quality::new(30.0, 2);
        for seconds in [0.0, f64::NAN, f64::INFINITY, 1e9] {
            let draft = quality.draft([1, 1], 0);
            assert_eq!(draft, Draft { size: [1, 1], depth: 0 });
            quality.measured(&draft, seconds, 1.0);
        }
    }
}
