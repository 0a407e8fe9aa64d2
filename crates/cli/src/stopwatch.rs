//! Where the time of a render goes: the clock that the library does not have.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;
use whitted::render::{Phase, Probe};

/// Phases in the order of [`slot`].
const PHASES: usize = 5;

thread_local! {
    /// When this thread entered the phase that it is in: phases do not nest.
    static ENTERED: Cell<Option<Instant>> = const { Cell::new(None) };
}

/// Adds up the wall-clock time of each phase over all threads.
#[derive(Debug, Default)]
pub(crate) struct Stopwatch {
    nanoseconds: [AtomicU64; PHASES],
}

impl Probe for Stopwatch {
    fn enter(&self, _: Phase) {
        ENTERED.set(Some(Instant::now()));
    }

    fn leave(&self, phase: Phase) {
        if let Some(entered) = ENTERED.take() {
            // 2⁶⁴ ns are five centuries.
            let spent = entered.elapsed().as_nanos() as u64;
            self.nanoseconds[slot(phase)].fetch_add(spent, Ordering::Relaxed);
        }
    }
}

impl Stopwatch {
    /// How much of the time of all phases each took.
    pub(crate) fn shares(&self) -> Shares {
        // Whole nanoseconds: sums of seconds round, and a share would come out above 100.
        let spent = |phase| self.nanoseconds[slot(phase)].load(Ordering::Relaxed);
        let total: u64 =
            [Phase::Queue, Phase::Trace, Phase::Shadow, Phase::Shade, Phase::Refine].map(spent).iter().sum();
        let percent = |phase| if total > 0 { 100.0 * spent(phase) as f64 / total as f64 } else { 0.0 };
        Shares {
            trace: percent(Phase::Trace),
            shadow: percent(Phase::Shadow),
            shade: percent(Phase::Shade),
            queue: percent(Phase::Queue),
            refine: percent(Phase::Refine),
        }
    }
}

/// Percent of the time of all threads; together 100, or 0 if nothing was rendered.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Shares {
    pub(crate) trace: f64,
    pub(crate) shadow: f64,
    pub(crate) shade: f64,
    pub(crate) queue: f64,
    pub(crate) refine: f64,
}

fn slot(phase: Phase) -> usize {
    match phase {
        Phase::Queue => 0,
        Phase::Trace => 1,
        Phase::Shadow => 2,
        Phase::Shade => 3,
        Phase::Refine => 4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn shares_are_percent_of_what_was_watched() {
        assert_eq!(Stopwatch::default().shares().trace, 0.0);
        let watch = Stopwatch::default();
        for (phase, spent) in [(Phase::Trace, 30), (Phase::Shadow, 20), (Phase::Shade, 40), (Phase::Queue, 10)] {
            watch.nanoseconds[slot(phase)].store(spent, Ordering::Relaxed);
        }
        let Shares { trace, shadow, shade, queue, refine } = watch.shares();
        assert_eq!([trace, shadow, shade, queue, refine].map(f64::round), [30.0, 20.0, 40.0, 10.0, 0.0]);
    }

    #[test]
    fn time_in_a_phase_is_counted_there() {
        let watch = Stopwatch::default();
        watch.enter(Phase::Shade);
        std::thread::sleep(Duration::from_millis(1));
        watch.leave(Phase::Shade);
        assert_eq!(watch.shares().shade, 100.0);
    }
}
