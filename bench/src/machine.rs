//! What a record says about where it was taken, besides what the paper's report says as well.

use cpu_time::ProcessTime;
pub(crate) use paper::machine::{cpu, date};
use std::process::Command;
use std::time::Instant;

/// The commit that is checked out in the current folder, with `+` if files differ from it; "unknown" outside a checkout.
/// It is that of this program if `cargo run` started it.
pub(crate) fn commit() -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let Some(commit) = git(&["rev-parse", "--short=10", "HEAD"]) else { return "unknown".into() };
    let dirty = git(&["status", "--porcelain", "--untracked-files=no"]).is_some_and(|files| !files.is_empty());
    if dirty { commit + "+" } else { commit }
}

/// Other programs that keep fewer cores busy than this on average leave wall-clock times as they are.
pub(crate) const QUIET: f64 = 0.1;

/// Tells how much of the machine other programs use.
pub(crate) struct Neighbours {
    start: Instant,
    own: ProcessTime,
    ticks: Option<Ticks>,
}

impl Neighbours {
    /// Watch them from now on.
    pub(crate) fn watch() -> Self {
        Self { start: Instant::now(), own: ProcessTime::now(), ticks: Ticks::now() }
    }

    /// Cores that they kept busy since then, on average; `None` where the system does not tell.
    pub(crate) fn cores(&self) -> Option<f64> {
        let (before, now) = (self.ticks.as_ref()?, Ticks::now()?);
        let busy = now.cores * (now.busy - before.busy) / (now.all - before.all);
        let own = self.own.elapsed().as_secs_f64() / self.start.elapsed().as_secs_f64();
        // Too short a time, a part of a tick, gives 0/0 and counts as unknown.
        let others = (busy - own).max(0.0);
        busy.is_finite().then_some(others)
    }
}

/// What all cores have done since the start, in units of the system.
#[derive(Debug, PartialEq)]
struct Ticks {
    busy: f64,
    all: f64,
    cores: f64,
}

impl Ticks {
    fn now() -> Option<Self> {
        Self::parse(&std::fs::read_to_string("/proc/stat").ok()?)
    }

    /// The first line of `/proc/stat` has the sums over all cores: user, nice, system, idle, waiting for input or output,
    /// two sorts of interrupts, stolen; a line for each core follows.
    fn parse(stat: &str) -> Option<Self> {
        const IDLE: [usize; 2] = [3, 4];
        const KNOWN: usize = 8;
        let sums = stat.lines().next()?.strip_prefix("cpu ")?.split_whitespace();
        let sums = sums.take(KNOWN).map(|sum| sum.parse().ok()).collect::<Option<Vec<f64>>>()?;
        let idle: f64 = IDLE.iter().filter_map(|&index| sums.get(index)).sum();
        let all: f64 = sums.iter().sum();
        let cores = stat.lines().skip(1).take_while(|line| line.starts_with("cpu")).count() as f64;
        Some(Self { busy: all - idle, all, cores })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_read() {
        let stat = "cpu  10 1 5 100 4 1 1 2 9 9\ncpu0 5 0 2 50 2 0 0 1 4 4\ncpu1 5 1 3 50 2 1 1 1 5 5\nintr 7\n";
        assert_eq!(Ticks::parse(stat), Some(Ticks { busy: 20.0, all: 124.0, cores: 2.0 }));
        assert_eq!(Ticks::parse("cpu  10 x\n"), None);
        assert_eq!(Ticks::parse(""), None);
    }
}
