//! A session with its overlay: what a window shows and whom its events are for.

use crate::enlarge::stretch;
use crate::input::{Input, Key};
use crate::opener::Activity;
use crate::overlay::Overlay;
use crate::session::Session;
use std::time::{Duration, Instant};

/// While the picture gets better at rest, it is shown this often: often enough to see it, rarely enough not to take
/// time from it.
const REFINING_FRAME: Duration = Duration::from_millis(40);

/// What is shown before there is a picture.
const GROUND: u32 = 0x0016_1719;

/// A session with its overlay.
pub(crate) struct App {
    pub(crate) session: Session,
    overlay: Overlay,
    size: [u32; 2],
    /// The version of the picture that was drawn last.
    drawn: u64,
    /// What lay over it: its revision, and what the opener was doing.
    drawn_over: (u64, Activity),
    last_draw: Option<Instant>,
    /// Something else than the picture has changed.
    stale: bool,
}

impl App {
    /// A window of this size with so many physical pixels for each unit of layout.
    pub(crate) fn new(session: Session, size: [u32; 2], scale: f32) -> Self {
        Self {
            session,
            overlay: Overlay::new(scale),
            size,
            drawn: 0,
            drawn_over: (0, Activity::Idle),
            last_draw: None,
            stale: true,
        }
    }

    /// The window has this size now.
    pub(crate) fn resize(&mut self, size: [u32; 2]) {
        self.size = size;
        self.stale = true;
        self.session.resize(size, Instant::now());
    }

    /// As [`resize`](Self::resize), if it is news.
    pub(crate) fn resize_if_needed(&mut self, size: [u32; 2]) {
        if size != self.size {
            self.resize(size);
        }
    }

    /// The display has so many physical pixels for each unit of layout now.
    pub(crate) fn set_scale(&mut self, scale: f32) {
        self.overlay.set_scale(scale);
        self.stale = true;
    }

    /// What the person does.
    pub(crate) fn input(&mut self, input: &Input) {
        self.stale |=
            !matches!(input, Input::Pointer(_)) || self.session.shown().panel || self.session.inspection().is_some();
        let is_for_overlay = self.overlay.take(input, self.session.is_dragging());
        // Tab moves the focus among the panel's fields, and shows and hides the panel: the latter is what is expected.
        if !is_for_overlay || matches!(input, Input::Key(Key::Tab, _)) {
            self.session.input(input);
        }
    }

    /// Move on. When to be called again at the latest, and whether to draw now.
    pub(crate) fn tick(&mut self, now: Instant) -> (Option<Duration>, bool) {
        let next = self.session.tick(now);
        let (version, is_draft) = {
            let picture = self.session.picture();
            (picture.version, matches!(picture.stage, crate::Stage::Draft | crate::Stage::Finished))
        };
        self.stale |= self.drawn_over != (self.session.revision(), self.session.activity());
        let is_due = self.overlay.next(now).is_some_and(|rest| rest.is_zero());
        if self.stale || is_due || (version != self.drawn && is_draft) {
            return (next, true);
        }
        let overlay = self.overlay.next(now);
        let picture = (version != self.drawn).then(|| {
            let since = self.last_draw.map_or(REFINING_FRAME, |last| now.duration_since(last));
            REFINING_FRAME.saturating_sub(since)
        });
        let is_time = picture.is_some_and(|rest| rest.is_zero());
        ([next, overlay, picture].into_iter().flatten().min(), is_time)
    }

    /// Draw the picture and what lies over it into `pixels`, `0x00RRGGBB` row by row, as many as the window has.
    pub(crate) fn draw(&mut self, pixels: &mut [u32]) {
        let size = self.size;
        if size.contains(&0) || pixels.len() != size[0] as usize * size[1] as usize {
            return;
        }
        let now = Instant::now();
        self.drawn = self.copy_picture(pixels);
        self.drawn_over = (self.session.revision(), self.session.activity());
        self.last_draw = Some(now);
        self.stale = false;
        self.overlay.draw(&mut self.session, pixels, size);
    }

    /// Copy the picture, stretched for a moment if the window's size has just changed. Tells its version.
    fn copy_picture(&self, pixels: &mut [u32]) -> u64 {
        let picture = self.session.picture();
        if picture.size == self.size {
            pixels.copy_from_slice(&picture.pixels);
        } else if picture.pixels.is_empty() {
            pixels.fill(GROUND);
        } else {
            stretch(&picture.pixels, picture.size, pixels, self.size);
        }
        picture.version
    }
}
