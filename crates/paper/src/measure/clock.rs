//! CPU time of threads.

use cpu_time::ThreadTime;
use std::time::Duration;

/// Threads that render, and their clocks.
pub(crate) struct Threads(rayon::ThreadPool);

impl Threads {
    /// So many, ≥ 1.
    ///
    /// # Errors
    /// If the system gives none.
    pub(crate) fn new(count: usize) -> Result<Self, rayon::ThreadPoolBuildError> {
        rayon::ThreadPoolBuilder::new().num_threads(count).build().map(Self)
    }

    /// Does `work` on these threads; returns what it returned and the CPU seconds of the thread that had most to do.
    ///
    /// On an idle machine that is how long it takes; on a busy one it still is how long it would take.
    pub(crate) fn seconds<R: Send>(&self, work: impl FnOnce() -> R + Send) -> (R, f64) {
        let before = self.times();
        let result = self.0.install(work);
        let spent = self.times().into_iter().zip(before).map(|(after, before)| after.saturating_sub(before));
        (result, spent.max().unwrap_or_default().as_secs_f64())
    }

    fn times(&self) -> Vec<Duration> {
        self.0.broadcast(|_| ThreadTime::now().as_duration())
    }
}

/// CPU seconds that this thread spends in `work`.
pub(crate) fn thread_seconds(work: impl FnOnce()) -> f64 {
    let start = ThreadTime::now();
    work();
    start.elapsed().as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::hint::black_box;

    fn spin() -> u64 {
        (0..20_000_000_u64).fold(0, |sum, i| black_box(sum ^ i))
    }

    #[test]
    fn the_busiest_thread_counts() {
        let threads = Threads::new(2).unwrap();
        let (_, one) = threads.seconds(spin);
        let (_, both) = threads.seconds(|| rayon::join(spin, spin));
        assert!(one > 0.0 && both < 1.9 * one, "{one} {both}");
        let (_, asleep) = threads.seconds(|| std::thread::sleep(Duration::from_millis(50)));
        assert!(asleep < 0.04, "{asleep}");
    }
}
