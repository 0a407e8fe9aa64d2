//! Timing several ways to answer the same rays, fairly.
//!
//! All contestants run in turn, pass after pass, so that whatever else the machine does falls on all of them. What
//! counts is the CPU time of the thread; ratios are taken within a pass and then the median of passes.

use cpu_time::ThreadTime;

/// One way to answer the rays.
pub(crate) trait Contestant {
    /// What tables call it.
    fn name(&self) -> String;

    /// Whether it belongs to another program: then it may drop out if it is far from that program's best.
    fn is_peer(&self) -> bool;

    /// Make ready for a pass; not timed.
    fn prepare(&mut self) {}

    /// Answer all rays; timed.
    fn run(&mut self);

    /// The answers of the last pass: t, infinite for a miss, 0 for a blocked ray.
    fn answers(&self) -> Vec<f32>;
}

/// CPU seconds of each pass.
#[derive(Clone, Debug)]
pub(crate) struct Times(Vec<f64>);

impl Times {
    /// The median pass.
    pub(crate) fn median(&self) -> f64 {
        median(self.0.clone())
    }

    /// How many times faster `self` is than `other`: the median over passes.
    pub(crate) fn speed_up_over(&self, other: &Self) -> f64 {
        median(self.0.iter().zip(&other.0).map(|(own, other)| other / own).collect())
    }
}

/// The middle value, or the mean of the two in the middle; NaN for none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let (below, above) = (values.len().saturating_sub(1) / 2, values.len() / 2);
    match values.len() {
        0 => f64::NAN,
        _ => (values[below] + values[above]) / 2.0,
    }
}

/// Seconds of CPU time that this thread spends in `work`.
pub(crate) fn thread_seconds(work: impl FnOnce()) -> f64 {
    let start = ThreadTime::now();
    work();
    start.elapsed().as_secs_f64()
}

/// A peer's way that took this many times as long as its best way in each of two passes drops out.
const HOPELESS: f64 = 1.6;

/// Run every contestant `passes` times after two passes to warm up; `None` for those that dropped out.
pub(crate) fn run(contestants: &mut [Box<dyn Contestant + '_>], passes: usize) -> Vec<Option<Times>> {
    let mut warm_up = vec![f64::INFINITY; contestants.len()];
    for _ in 0..2 {
        for (best, contestant) in warm_up.iter_mut().zip(contestants.iter_mut()) {
            *best = best.min(pass(contestant.as_mut()));
        }
    }
    let peers = warm_up.iter().zip(contestants.iter()).filter(|(_, contestant)| contestant.is_peer());
    let limit = HOPELESS * peers.map(|(&seconds, _)| seconds).fold(f64::INFINITY, f64::min);
    let stays = |is_peer: bool, seconds: f64| (!is_peer || seconds <= limit).then(|| Times(Vec::new()));
    let started = contestants.iter().zip(&warm_up);
    let mut times: Vec<Option<Times>> = started.map(|(one, &seconds)| stays(one.is_peer(), seconds)).collect();
    for _ in 0..passes {
        for (times, contestant) in times.iter_mut().zip(contestants.iter_mut()) {
            if let Some(Times(times)) = times {
                times.push(pass(contestant.as_mut()));
            }
        }
    }
    times
}

fn pass(contestant: &mut dyn Contestant) -> f64 {
    contestant.prepare();
    thread_seconds(|| contestant.run())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_taken_within_passes() {
        // The second pass met a busy machine.
        let (ours, peer) = (Times(vec![1.0, 10.0, 1.0]), Times(vec![2.0, 20.0, 3.0]));
        assert_eq!(ours.speed_up_over(&peer), 2.0);
        assert_eq!(median(vec![4.0, 1.0]), 2.5);
        assert!(median(Vec::new()).is_nan());
    }

    struct Idle(bool, u32);

    impl Contestant for Idle {
        fn name(&self) -> String {
            String::new()
        }
        fn is_peer(&self) -> bool {
            self.0
        }
        fn run(&mut self) {
            let spin = std::hint::black_box(self.1);
            (0..spin).for_each(|i| {
                std::hint::black_box(i);
            });
        }
        fn answers(&self) -> Vec<f32> {
            Vec::new()
        }
    }

    #[test]
    fn a_hopeless_peer_drops_out_and_ours_never() {
        let mut contestants: Vec<Box<dyn Contestant>> =
            [(true, 1 << 16), (true, 1 << 22), (false, 1 << 22)].map(|(p, n)| Box::new(Idle(p, n)) as _).into();
        let times = run(&mut contestants, 1);
        assert_eq!(times.iter().map(Option::is_some).collect::<Vec<_>>(), [true, false, true]);
    }
}
