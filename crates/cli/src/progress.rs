//! How far the render is: a bar on a terminal, a plain line now and then elsewhere, nothing when quiet.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use whitted::render::Progress;

/// Plain lines come this far apart, and none before this much time has passed.
const LINE_INTERVAL: Duration = Duration::from_secs(2);

/// A sink for the renderer that shows progress on standard error.
pub(crate) enum Display {
    Quiet,
    Lines(Mutex<Ticker>),
    Bar(ProgressBar),
}

impl Display {
    /// The display that suits standard error.
    pub(crate) fn new(quiet: bool) -> Self {
        match (quiet, std::io::stderr().is_terminal()) {
            (true, _) => Self::Quiet,
            (false, false) => Self::Lines(Mutex::new(Ticker::new(Instant::now()))),
            (false, true) => Self::Bar(bar()),
        }
    }

    /// Removes the bar, so that what is printed next stands alone.
    pub(crate) fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:15} {bar:40} {percent:>3} %  {elapsed} of about {duration}");
    let style = style.expect("the template is well-formed");
    let draw = ProgressDrawTarget::stderr_with_hz(10);
    ProgressBar::with_draw_target(Some(1), draw).with_style(style)
}

impl Display {
    /// As [`new`](Self::new), for work of many steps that have names.
    pub(crate) fn for_steps(quiet: bool) -> Self {
        let display = Self::new(quiet);
        if let Self::Bar(bar) = &display {
            let style = ProgressStyle::with_template("{bar:24} {percent:>3} %  {elapsed}{wide_msg}");
            bar.set_style(style.expect("the template is well-formed"));
        }
        display
    }

    /// Shows how far the tree is, from any thread; of what is told at once the greatest share stays.
    pub(crate) fn built(&self, share: f32) {
        const STEPS: u64 = 1000;
        match self {
            Self::Quiet => {}
            Self::Lines(ticker) => line_if_due(ticker, |_| format!("building the tree {:.0} %", 100.0 * share)),
            Self::Bar(bar) => {
                bar.set_message("building");
                bar.set_length(STEPS);
                bar.set_position(bar.position().max((STEPS as f32 * share) as u64));
            }
        }
    }
}

impl paper::Watch for Display {
    fn at(&self, part: f64, what: &str) {
        const STEPS: f64 = 1000.0;
        match self {
            Self::Quiet => {}
            Self::Lines(ticker) => {
                line_if_due(ticker, |elapsed| format!("{:3.0} %{} {what}", 100.0 * part, left(elapsed, part)));
            }
            Self::Bar(bar) => {
                bar.set_message(format!("{} {what}", left(bar.elapsed(), part)));
                bar.set_length(STEPS as u64);
                bar.set_position((STEPS * part) as u64);
            }
        }
    }
}

/// How long the rest of the work takes if it goes on as it did, after a comma; nothing before that can be said.
fn left(elapsed: Duration, part: f64) -> String {
    const ENOUGH: f64 = 0.02;
    const MINUTE: f64 = 60.0;
    /// Seconds are told in steps of ten: the last digit would be a guess.
    const STEP: f64 = 10.0;
    if part < ENOUGH {
        return String::new();
    }
    match elapsed.as_secs_f64() * (1.0 - part) / part {
        seconds if seconds < 2.0 * MINUTE => format!(", about {:.0} s left:", STEP * (seconds / STEP).ceil()),
        seconds => format!(", about {:.0} min left:", seconds / MINUTE),
    }
}

/// How far a table of rays is.
pub(crate) struct Done {
    pub(crate) rays: u64,
    /// Bytes read.
    pub(crate) read: u64,
    /// Bytes to read in all, if that is known.
    pub(crate) bytes: Option<u64>,
}

impl Done {
    fn words(&self) -> String {
        match self.bytes {
            Some(bytes) => format!("tracing {} %", (100 * self.read).checked_div(bytes).unwrap_or(100)),
            None => format!("tracing {} rays", self.rays),
        }
    }
}

impl Display {
    /// Shows how far a table of rays is.
    pub(crate) fn rays_done(&self, done: &Done) {
        match self {
            Self::Quiet => {}
            Self::Lines(ticker) => line_if_due(ticker, |_| done.words()),
            Self::Bar(bar) => {
                bar.set_message(if done.bytes.is_some() { "tracing".to_owned() } else { done.words() });
                bar.set_length(done.bytes.unwrap_or(1));
                bar.set_position(if done.bytes.is_some() { done.read } else { 0 });
            }
        }
    }
}

/// Prints a plain line if the last one is long enough ago; `words` are told how long the work took until now.
fn line_if_due(ticker: &Mutex<Ticker>, words: impl FnOnce(Duration) -> String) {
    // A poisoned ticker only means that another thread panicked while printing.
    let Ok(mut ticker) = ticker.lock() else { return };
    let now = Instant::now();
    if ticker.is_due(now) {
        eprintln!("{}", words(now.duration_since(ticker.start)));
    }
}

impl Progress for Display {
    fn regions_done(&self, phase: u32, done: usize, total: usize) {
        match self {
            Self::Quiet => {}
            Self::Lines(ticker) => {
                line_if_due(ticker, |_| format!("{} {} %", phase_name(phase), 100 * done / total.max(1)));
            }
            Self::Bar(bar) => {
                bar.set_message(phase_name(phase));
                bar.set_length(total as u64);
                bar.set_position(done as u64);
            }
        }
    }
}

fn phase_name(phase: u32) -> &'static str {
    if phase <= 1 { "tracing" } else { "refining edges" }
}

/// Says when the next line is due.
pub(crate) struct Ticker {
    start: Instant,
    last: Instant,
}

impl Ticker {
    fn new(start: Instant) -> Self {
        Self { start, last: start }
    }

    fn is_due(&mut self, now: Instant) -> bool {
        let due = now.duration_since(self.last) >= LINE_INTERVAL;
        if due {
            self.last = now;
        }
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_keep_their_distance() {
        let start = Instant::now();
        let mut ticker = Ticker::new(start);
        let due_at = |ticker: &mut Ticker, seconds| ticker.is_due(start + Duration::from_secs(seconds));
        assert!(!due_at(&mut ticker, 1));
        assert!(due_at(&mut ticker, 2));
        assert!(!due_at(&mut ticker, 3));
        assert!(due_at(&mut ticker, 5));
    }

    #[test]
    fn what_is_left_is_told_once_it_can_be() {
        let left = |seconds, part| left(Duration::from_secs(seconds), part);
        assert_eq!(left(5, 0.01), "");
        assert_eq!(left(30, 0.5), ", about 30 s left:");
        assert_eq!(left(95, 0.95), ", about 10 s left:");
        assert_eq!(left(60, 0.1), ", about 9 min left:");
        assert_eq!(left(600, 1.0), ", about 0 s left:");
    }
}
