//! Whether a window can be seen, from all that window systems tell of it.

use std::time::{Duration, Instant};

/// How often a window is looked after that cannot be seen, or of which that must be asked; and how long a window in sight
/// lets a picture wait at most.
pub(crate) const GLANCE_AWAY: Duration = Duration::from_millis(400);

/// What is known of a window.
#[derive(Debug, Default)]
pub(crate) struct Sight {
    /// Other windows cover it, or it was put away: told by an event.
    is_covered: bool,
    /// Minimised or unmapped: X11 says so only when it is asked.
    is_away: bool,
    /// When that was asked last.
    asked: Option<Instant>,
    /// Since when a picture waits to be taken: Wayland takes none for windows that cannot be seen.
    waiting: Option<Instant>,
}

impl Sight {
    /// Others cover it wholly, or no longer.
    pub(crate) fn cover(&mut self, is_covered: bool) {
        *self = Self { is_covered, ..Self::default() };
    }

    /// There is something to be drawn.
    pub(crate) fn picture_waits(&mut self, now: Instant) {
        self.waiting.get_or_insert(now);
    }

    /// It is being drawn.
    pub(crate) fn picture_is_taken(&mut self) {
        self.waiting = None;
    }

    /// Whether anybody may see it.
    pub(crate) fn is_seen(&mut self, now: Instant, is_away: impl FnOnce() -> bool) -> bool {
        let is_long_ago = |time: Instant| now.duration_since(time) >= GLANCE_AWAY;
        if self.asked.is_none_or(is_long_ago) {
            self.asked = Some(now);
            self.is_away = is_away();
        }
        !(self.is_covered || self.is_away || self.waiting.is_some_and(is_long_ago))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_out_of_sight_in_several_ways() {
        let (mut sight, start) = (Sight::default(), Instant::now());
        let at = |millis| start + Duration::from_millis(millis);
        assert!(sight.is_seen(at(0), || false));
        assert!(sight.is_seen(at(100), || true), "not asked again so soon");
        assert!(!sight.is_seen(at(500), || true) && !sight.is_seen(at(600), || false));
        assert!(sight.is_seen(at(1000), || false));
        sight.cover(true);
        assert!(!sight.is_seen(at(1100), || false));
        sight.cover(false);
        sight.picture_waits(at(1200));
        sight.picture_waits(at(1500));
        assert!(sight.is_seen(at(1500), || false) && !sight.is_seen(at(1700), || false));
        sight.picture_is_taken();
        assert!(sight.is_seen(at(1800), || false));
    }
}
