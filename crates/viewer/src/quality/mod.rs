//! How good a picture can be while things move: from what the last ones took to what the next one is like.

mod ladder;

use ladder::Ladder;
use std::time::Duration;
use whitted::scene::Settings;

/// The part of a frame's time that a draft may take on the average, enlarged: the rest is for frames that take longer.
const SHARE: f64 = 0.92;

/// The least resolution, in pixels of the window along an edge of a pixel that is drawn.
const COARSEST: f64 = 12.0;

/// Sizes that differ by less than this factor are not worth the flicker of changing between them.
const STEADY: f64 = 1.04;

/// How much of what the last frame took is believed, if it was more or less than expected: a scene that looked cheap for a
/// moment is met slowly. Much less for the latter keeps the rate a half above its target where other programs take the
/// processor now and then: a fifth of the resolution.
const TRUST: [f64; 2] = [0.5, 0.35];

/// A frame that took more than this many times what was expected is believed at once, as is the first of a scene.
const SURPRISE: f64 = 2.0;

/// A frame that takes this many times its budget is given up for a coarser one.
const PATIENCE: f64 = 1.6;

/// Before anything was measured: seconds for a pixel on one thread of a slow machine.
const FIRST_GUESS: f64 = 4e-6;

/// What a picture that is drawn while things move is like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Draft {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Generations of secondary rays.
    pub depth: u32,
    /// Rays of less weight were not traced.
    pub min_weight: f32,
}

impl Draft {
    /// The least weight as it is said: `1/255`.
    pub fn weight(&self) -> String {
        let parts = 1.0 / self.min_weight;
        if parts.is_finite() && parts >= 2.0 { format!("1/{parts:.0}") } else { self.min_weight.to_string() }
    }
}

/// Decides how good drafts are.
#[derive(Clone, Debug)]
pub(crate) struct Quality {
    /// Seconds that a draft may take.
    budget: f64,
    /// Seconds for a pixel on the present rung of the ladder.
    cost: f64,
    /// Pixels of the window along an edge of a pixel of the draft, ≥ 1.
    coarseness: f64,
    ladder: Ladder,
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
            ladder: Ladder::default(),
            is_measured: false,
        }
    }

    /// Forget what is known of the scene: it is another one.
    pub(crate) fn forget(&mut self) {
        // Half the resolution that was possible: if it is no longer, patience ends soon.
        self.cost *= 4.0;
        self.ladder = Ladder::default();
        self.is_measured = false;
    }

    /// The next draft of a picture with these settings.
    pub(crate) fn draft(&mut self, settings: &Settings) -> Draft {
        let [width, height] = settings.size.map(f64::from);
        let coarseness = |cost: f64| (cost * width * height / self.budget).sqrt();
        if self.is_measured {
            let coarseness = coarseness(self.cost);
            // While drafts still become finer, nothing need be given up.
            let is_settled = coarseness * STEADY >= self.coarseness;
            self.cost *= self.ladder.step(coarseness, is_settled, self.cost, settings.depth);
        }
        let coarseness = coarseness(self.cost).clamp(1.0, COARSEST);
        let change = coarseness / self.coarseness;
        // Full resolution is a goal of its own: the last small step to it is taken.
        if !(1.0 / STEADY..=STEADY).contains(&change) || (coarseness == 1.0 && self.coarseness > 1.0) {
            self.coarseness = coarseness;
        }
        let side = |pixels: f64| (pixels / self.coarseness).round().max(1.0) as u32;
        let (depth, min_weight) = self.ladder.limits(settings.depth, settings.min_weight);
        Draft { size: [side(width), side(height)], depth, min_weight }
    }

    /// `draft` took `seconds`, or that long for `share` of it when it was given up.
    pub(crate) fn measured(&mut self, draft: &Draft, seconds: f64, share: f64) {
        let pixels = f64::from(draft.size[0]) * f64::from(draft.size[1]) * share.max(f64::EPSILON);
        let cost = seconds / pixels;
        if cost.is_finite() {
            let trust = match cost / self.cost {
                ratio if ratio > SURPRISE || !self.is_measured => 1.0,
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

    /// What is wanted, in a window of this size.
    fn settings(size: [u32; 2]) -> Settings {
        Settings { size, ..Settings::default() }
    }

    const FULL: [u32; 2] = [1280, 720];

    /// Let a machine with this cost of a pixel for each generation draw for some frames; what the last one took. A third of
    /// the secondary rays have a weight of less than 1/64, and none less than 1/32.
    fn draw(quality: &mut Quality, frames: usize, cost: f64, overhead: f64) -> (Draft, f64) {
        let mut last = (Draft::default(), 0.0);
        for _ in 0..frames {
            let draft = quality.draft(&settings(FULL));
            let [width, height] = draft.size.map(f64::from);
            let heavy = if draft.min_weight < 1.0 / 64.0 { 1.0 } else { 2.0 / 3.0 };
            let seconds = overhead + cost * (1.0 + heavy * f64::from(draft.depth)) * width * height;
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

    /// As good as it can be.
    fn best() -> Draft {
        let Settings { depth, min_weight, .. } = Settings::default();
        Draft { size: FULL, depth, min_weight }
    }

    #[test]
    fn what_is_cheap_is_drawn_in_full() {
        let mut quality = Quality::new(30.0, 2);
        let (draft, _) = draw(&mut quality, 20, 1e-9, 1e-3);
        assert_eq!(draft, best());
    }

    #[test]
    fn what_is_missed_least_is_given_up_first_and_comes_back() {
        let mut quality = Quality::new(30.0, 2);
        // The whole window, if light that hardly counts is left out.
        let (draft, _) = draw(&mut quality, 60, 7e-9, 0.0);
        assert_eq!(draft, Draft { min_weight: 1.0 / 64.0, ..best() });
        // Half its width is enough.
        let (draft, _) = draw(&mut quality, 60, 2.8e-8, 0.0);
        assert!(draft.depth == 5 && draft.min_weight == 1.0 / 64.0 && quality.resolution() >= 0.5, "{draft:?}");
        // It is kept up by a generation less.
        let (draft, _) = draw(&mut quality, 60, 3.3e-8, 0.0);
        assert!(draft.depth == 4 && draft.min_weight == 1.0 / 32.0 && quality.resolution() >= 0.5, "{draft:?}");
        let (draft, _) = draw(&mut quality, 100, 1e-6, 0.0);
        assert!(draft.depth == 3 && quality.resolution() < 0.2, "{draft:?}");
        let (draft, _) = draw(&mut quality, 150, 1e-9, 0.0);
        assert_eq!(draft, best());
    }

    #[test]
    fn a_moment_without_a_processor_changes_nothing_but_the_size() {
        let mut quality = Quality::new(30.0, 2);
        let (before, _) = draw(&mut quality, 60, 2.5e-8, 0.0);
        draw(&mut quality, 2, 1.5e-7, 0.0);
        for _ in 0..60 {
            let (draft, _) = draw(&mut quality, 1, 2.5e-8, 0.0);
            assert_eq!((draft.depth, draft.min_weight), (before.depth, before.min_weight));
        }
    }

    #[test]
    fn deep_scenes_lose_little_of_their_depth() {
        let mut quality = Quality::new(30.0, 2);
        let deep = Settings { depth: 8, ..settings(FULL) };
        let mut draft = Draft::default();
        for _ in 0..200 {
            draft = quality.draft(&deep);
            let [width, height] = draft.size.map(f64::from);
            quality.measured(&draft, 2e-7 * width * height, 1.0);
        }
        assert_eq!(draft.depth, 6);
        assert!(quality.resolution() > 0.25);
    }

    #[test]
    fn drafts_never_have_more_than_is_asked_for() {
        let mut quality = Quality::new(30.0, 2);
        let coarse = Settings { depth: 2, min_weight: 0.25, ..settings(FULL) };
        for _ in 0..100 {
            let draft = quality.draft(&coarse);
            assert_eq!((draft.depth, draft.min_weight), (2, 0.25));
            let [width, height] = draft.size.map(f64::from);
            quality.measured(&draft, 1e-6 * width * height, 1.0);
        }
    }

    #[test]
    fn no_rung_flickers() {
        // Wherever the cost of a pixel lies, and uneven as it is: once it is found, the rung is kept.
        for step in 0..120 {
            let (mut quality, cost) = (Quality::new(30.0, 2), 3e-9 * 1.05_f64.powi(step));
            let rungs = |(draft, _): (Draft, f64)| (draft.depth, draft.min_weight);
            let settled = rungs(draw(&mut quality, 200, cost, 0.0));
            for frame in 0..200 {
                let uneven = cost * [0.95, 1.05, 1.0, 1.08, 0.94][frame % 5];
                assert_eq!(rungs(draw(&mut quality, 1, uneven, 0.0)), settled, "frame {frame} at {cost}");
            }
        }
    }

    #[test]
    fn weights_are_fractions() {
        let said = |min_weight: f32| Draft { min_weight, ..Draft::default() }.weight();
        assert_eq!([1.0 / 255.0, 1.0 / 32.0, 0.0, 0.75].map(said), ["1/255", "1/32", "0", "0.75"]);
    }

    #[test]
    fn small_changes_do_not_flicker() {
        let mut quality = Quality::new(30.0, 2);
        draw(&mut quality, 100, 1e-7, 0.0);
        let size = quality.draft(&settings(FULL)).size;
        for step in 0..50 {
            let (draft, _) = draw(&mut quality, 1, 1e-7 * [0.97, 1.0, 1.03][step % 3], 0.0);
            assert_eq!(draft.size, size);
        }
    }

    #[test]
    fn a_tiny_window_and_odd_clocks_do_no_harm() {
        let mut quality = Quality::new(30.0, 2);
        for seconds in [0.0, f64::NAN, f64::INFINITY, 1e9] {
            let tiny = Settings { depth: 0, ..settings([1, 1]) };
            let draft = quality.draft(&tiny);
            assert_eq!((draft.size, draft.depth), ([1, 1], 0));
            quality.measured(&draft, seconds, 1.0);
        }
    }
}
