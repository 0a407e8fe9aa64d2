//! How many pictures a second are shown.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// The rate is the mean over so long.
const SPAN: Duration = Duration::from_secs(1);

/// Counts pictures.
#[derive(Clone, Debug, Default)]
pub(super) struct Rate {
    seen: u64,
    times: VecDeque<Instant>,
}

impl Rate {
    /// So many pictures were shown until now, in all.
    pub(super) fn observe(&mut self, total: u64, now: Instant) {
        let new = total.saturating_sub(std::mem::replace(&mut self.seen, total));
        self.times.extend((0..new.min(1000)).map(|_| now));
        while self.times.front().is_some_and(|&time| now.duration_since(time) > SPAN) {
            self.times.pop_front();
        }
    }

    /// Pictures a second; 0 if there were not two of them lately.
    pub(super) fn per_second(&self) -> f64 {
        let (Some(first), Some(last)) = (self.times.front(), self.times.back()) else { return 0.0 };
        let seconds = last.duration_since(*first).as_secs_f64();
        if seconds > 0.0 { (self.times.len() - 1) as f64 / seconds } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_pictures_a_second() {
        let (mut rate, start) = (Rate::default(), Instant::now());
        for number in 0..90 {
            rate.observe(number + 1, start + Duration::from_millis(number * 1000 / 30));
        }
        assert!((rate.per_second() - 30.0).abs() < 1.0, "{}", rate.per_second());
        rate.observe(90, start + Duration::from_secs(9));
        assert_eq!(rate.per_second(), 0.0);
    }
}
