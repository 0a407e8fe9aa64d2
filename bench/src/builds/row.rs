//! A line of the table of builds.

use super::Build;
use super::walked::Walked;
use crate::contest::median;
use crate::machine::QUIET;
use crate::scenes::Scene;
use serde_json::{Value, json};

/// What one builder did.
pub(super) struct Row {
    scene: String,
    primitives: usize,
    build: String,
    /// Millions of primitives per second of CPU time with one thread.
    cpu: f64,
    /// The same of the wall clock, with one thread and with two.
    wall: [f64; 2],
    speed_up: SpeedUp,
    /// Bytes of the tree per primitive.
    bytes: f64,
    walked: Option<Walked>,
}

/// How many times faster two threads are than one.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SpeedUp {
    /// By the wall clock: the median of rounds.
    Measured(f64),
    /// Other programs used the cores as well. All that can be said is how much more CPU time two threads took than one:
    /// with two free cores they would be at most this much faster.
    AtMost(f64),
}

impl SpeedUp {
    /// `one` and `two` are the builds with one and two threads, round by round; `others` is how many cores other programs
    /// kept busy meanwhile, if that is known.
    fn new(one: &[Build], two: &[Build], others: Option<f64>) -> Self {
        let ratio = |seconds: fn(&Build) -> f64| {
            median(one.iter().zip(two).map(|(one, two)| seconds(one) / seconds(two)).collect())
        };
        match others.is_some_and(|cores| cores < QUIET) {
            true => Self::Measured(ratio(|build| build.wall)),
            false => Self::AtMost(2.0 * ratio(|build| build.cpu)),
        }
    }

    fn text(self) -> String {
        match self {
            Self::Measured(factor) => format!("{factor:.2}"),
            Self::AtMost(factor) => format!("≤ {factor:.2}"),
        }
    }

    /// The factor, and the clock that it is by.
    fn by(self) -> (f64, &'static str) {
        match self {
            Self::Measured(factor) => (factor, "wall"),
            Self::AtMost(factor) => (factor, "cpu"),
        }
    }
}

impl Row {
    /// `one` and `two` are the builds with one and two threads; for `others` see [`SpeedUp::new`].
    pub(super) fn new(
        scene: &Scene,
        build: &str,
        [one, two]: [&[Build]; 2],
        others: Option<f64>,
        walked: Option<Walked>,
    ) -> Self {
        const MILLION: f64 = 1e6;
        let count = scene.len() as f64;
        let middle = |builds: &[Build], number: fn(&Build) -> f64| median(builds.iter().map(number).collect());
        let rate = |builds: &[Build], seconds: fn(&Build) -> f64| count / middle(builds, seconds) / MILLION;
        Self {
            scene: scene.name.clone(),
            primitives: scene.len(),
            build: build.into(),
            cpu: rate(one, |build| build.cpu),
            wall: [one, two].map(|builds| rate(builds, |build| build.wall)),
            speed_up: SpeedUp::new(one, two, others),
            bytes: middle(one, |build| build.bytes) / count,
            walked,
        }
    }

    /// The line above all rows.
    pub(super) fn header() -> String {
        let ours = " refs depth   cost tests/ray steps/ray Mrays/s";
        format!(
            "{:<12} {:>9} {:<14} {:>9} {:>8} {:>8} {:>8} {:>7} {ours}",
            "scene", "primitives", "build", "M/s CPU", "M/s wall", "2 thr", "speed-up", "B/prim"
        )
    }

    /// References per primitive.
    fn references(&self) -> Option<f64> {
        self.walked.as_ref().map(|walked| walked.report.references as f64 / self.primitives as f64)
    }

    /// The line of the table.
    pub(super) fn text(&self) -> String {
        let walked = self.walked.as_ref().zip(self.references()).map(|(walked, references)| {
            let Walked { report, cost, tests, steps, mrays } = walked;
            format!("{references:>5.2} {:>5} {cost:>6.3} {tests:>9.2} {steps:>9.2} {mrays:>7.2}", report.depth)
        });
        let Self { scene, primitives, build, cpu, wall: [one, two], speed_up, bytes, .. } = self;
        let speed_up = speed_up.text();
        format!(
            "{scene:<12} {primitives:>9} {build:<14} {cpu:>9.3} {one:>8.3} {two:>8.3} {speed_up:>8} {bytes:>7.1} {}",
            walked.unwrap_or_default()
        )
    }

    /// The row with stable keys; what is known of our trees only is null for others.
    pub(super) fn json(&self) -> Value {
        let walked = self.walked.as_ref();
        let (speed_up, by) = self.speed_up.by();
        json!({
            "scene": self.scene,
            "primitives": self.primitives,
            "build": self.build,
            "mprim_per_cpu_second": self.cpu,
            "mprim_per_second": self.wall[0],
            "mprim_per_second_2_threads": self.wall[1],
            "speed_up": speed_up,
            "speed_up_by": by,
            "bytes_per_primitive": self.bytes,
            "references": walked.map(|walked| walked.report.references),
            "references_per_primitive": self.references(),
            "dropped": walked.map(|walked| walked.report.dropped),
            "depth": walked.map(|walked| walked.report.depth),
            "cost_of_exact_sweep": walked.map(|walked| walked.cost),
            "tests_per_ray": walked.map(|walked| walked.tests),
            "steps_per_ray": walked.map(|walked| walked.steps),
            "mrays": walked.map(|walked| walked.mrays),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_busy_machine_gives_only_a_bound() {
        let build = |wall, cpu| Build { wall, cpu, bytes: 0.0 };
        let (one, two) = ([build(2.0, 2.0), build(9.0, 2.0)], [build(1.0, 2.5), build(3.0, 2.5)]);
        assert_eq!(SpeedUp::new(&one, &two, Some(0.0)), SpeedUp::Measured(2.5));
        for others in [Some(1.0), None] {
            assert_eq!(SpeedUp::new(&one, &two, others), SpeedUp::AtMost(1.6));
        }
        assert_eq!(SpeedUp::AtMost(1.6).text(), "≤ 1.60");
    }
}
