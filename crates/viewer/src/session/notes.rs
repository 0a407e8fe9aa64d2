//! Short messages that are shown for a while.

use std::time::{Duration, Instant};

/// How long a message is shown.
const SHOWN: Duration = Duration::from_secs(4);

/// The most messages at a time; older ones make room.
const MOST: usize = 5;

/// A message.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// What it says.
    pub text: String,
    /// When it began to be shown.
    pub since: Instant,
}

/// The messages that are shown.
#[derive(Clone, Debug, Default)]
pub(super) struct Notes(Vec<Note>);

impl Notes {
    pub(super) fn add(&mut self, text: impl Into<String>, now: Instant) {
        self.0.push(Note { text: text.into(), since: now });
        let surplus = self.0.len().saturating_sub(MOST);
        self.0.drain(..surplus);
    }

    /// Time until the next one ends.
    pub(super) fn next_end(&self, now: Instant) -> Option<Duration> {
        self.0.iter().map(|note| SHOWN.saturating_sub(now.duration_since(note.since))).min()
    }

    /// Forget what was shown long enough. Tells whether that was anything.
    pub(super) fn clear_old(&mut self, now: Instant) -> bool {
        let before = self.0.len();
        self.0.retain(|note| now.duration_since(note.since) < SHOWN);
        self.0.len() < before
    }

    pub(super) fn all(&self) -> &[Note] {
        &self.0
    }
}
