//! What a record says about where it was taken.

use cpu_time::ProcessTime;
use std::process::Command;
use std::time::Instant;

/// The processor's name, or "unknown CPU".
pub(crate) fn cpu() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("model name"));
    line.and_then(|line| line.split_once(':')).map_or("unknown CPU".into(), |(_, name)| name.trim().into())
}

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

/// Today (UTC) as `2026-01-31`, by the calendar formula of Hinnant ("chrono-compatible low-level date algorithms").
pub(crate) fn date() -> String {
    const SECONDS_PER_DAY: u64 = 86_400;
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
    let (year, month, day) = civil((now.as_secs() / SECONDS_PER_DAY) as i64);
    format!("{year:04}-{month:02}-{day:02}")
}

/// Year, month and day of a number of days since 1970-01-01.
fn civil(days: i64) -> (i64, i64, i64) {
    // Years begin in March, so that the leap day comes last; eras of 400 years repeat.
    let days = days + 719_468;
    let (era, day_of_era) = (days.div_euclid(146_097), days.rem_euclid(146_097));
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    (year_of_era + era * 400 + i64::from(month <= 2), month, day)
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

    #[test]
    fn days_become_dates() {
        assert_eq!(civil(0), (1970, 1, 1));
        assert_eq!(civil(11_016), (2000, 2, 29));
        assert_eq!(civil(20_454), (2026, 1, 1));
        assert_eq!(civil(-1), (1969, 12, 31));
    }
}
