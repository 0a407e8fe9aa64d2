//! Doing what a script says.

use super::Step;
use crate::app::App;
use crate::host::{Host, Shot};
use crate::input::{Input, Key, Modifiers};
use crate::options::Options;
use crate::quality::Draft;
use crate::screen::Stage;
use crate::session::{Effect, Session};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// The size of a window for which none is given.
const DEFAULT_SIZE: [u32; 2] = [1280, 720];

/// A wait that takes longer than this has failed.
const PATIENCE: Duration = Duration::from_secs(600);

/// Steps of a motion come this far apart, as those of a mouse.
const MOTION: Duration = Duration::from_millis(8);

/// Why a script was not done to its end.
#[derive(Debug, thiserror::Error)]
pub enum ScriptFailure {
    /// The system has no thread left.
    #[error("cannot start a thread: {0}")]
    Thread(#[from] std::io::Error),
    /// What it waited for did not come, or a picture could not be saved.
    #[error("step {step}: {what}")]
    Step {
        /// The step, from 1.
        step: usize,
        /// What went wrong.
        what: String,
    },
}

/// Do `steps` with the scene of `host`, without a display. What the session prints is handed to `print`.
///
/// # Errors
/// The first step that cannot be done.
pub fn run(
    host: Arc<dyn Host>,
    options: Options,
    steps: &[Step],
    print: &mut dyn FnMut(&str),
) -> Result<(), ScriptFailure> {
    let size = options.size.unwrap_or(DEFAULT_SIZE);
    let (wake, woken) = channel();
    let wake = move || {
        // If the script has ended, there is nothing left to show.
        let _ = wake.send(());
    };
    let session = Session::new(Arc::clone(&host), options, size, wake)?;
    let mut puppet = Puppet { app: App::new(session, size, 1.0), host, size, pixels: Vec::new(), woken, print };
    puppet.resize(size);
    for (number, step) in (1..).zip(steps) {
        puppet.act(step).map_err(|what| ScriptFailure::Step { step: number, what })?;
        if puppet.is_closed() {
            break;
        }
    }
    Ok(())
}

/// A window that nobody sees.
struct Puppet<'a> {
    app: App,
    host: Arc<dyn Host>,
    size: [u32; 2],
    pixels: Vec<u32>,
    woken: Receiver<()>,
    print: &'a mut dyn FnMut(&str),
}

impl Puppet<'_> {
    fn act(&mut self, step: &Step) -> Result<(), String> {
        match step {
            Step::Size(size) => self.resize(*size),
            Step::WaitRefined => return self.wait_until("a finished picture", |app| app.session.is_at_rest()),
            Step::WaitTrouble => return self.wait_until("trouble", |app| app.session.trouble().is_some()),
            Step::Wait(time) => self.serve(*time),
            Step::Key(modifiers, key) => self.key(*modifiers, *key),
            Step::Hold(key, is_pressed) => self.app.input(&Input::Key(*key, *is_pressed)),
            Step::Move(to) => self.app.input(&Input::Pointer(*to)),
            Step::Click(button, at) => {
                // The panels must have seen the pointer before they are clicked.
                self.app.input(&Input::Pointer(*at));
                self.frame();
                self.app.input(&Input::Button(*button, true));
                self.frame();
                self.app.input(&Input::Button(*button, false));
            }
            Step::Drag(button, modifiers, [from, to], time) => {
                self.app.input(&Input::Modifiers(*modifiers));
                self.app.input(&Input::Pointer(*from));
                self.app.input(&Input::Button(*button, true));
                self.glide(*from, *to, *time);
                self.app.input(&Input::Button(*button, false));
                self.app.input(&Input::Modifiers(Modifiers::default()));
            }
            Step::Wheel(notches) => self.app.input(&Input::Wheel(*notches)),
            Step::Screenshot(path) => return self.screenshot(path),
            Step::Save(path) => return self.save(path),
            Step::Report => self.report(),
            Step::Quit => self.app.session.act(crate::Action::Close),
        }
        self.frame();
        Ok(())
    }

    fn resize(&mut self, size: [u32; 2]) {
        self.size = size;
        self.pixels.resize(size[0] as usize * size[1] as usize, 0);
        self.app.resize(size);
    }

    fn key(&mut self, modifiers: Modifiers, key: Key) {
        self.app.input(&Input::Modifiers(modifiers));
        self.app.input(&Input::Key(key, true));
        self.app.input(&Input::Key(key, false));
        self.app.input(&Input::Modifiers(Modifiers::default()));
    }

    /// Move the pointer evenly.
    fn glide(&mut self, from: [f64; 2], to: [f64; 2], time: Duration) {
        let start = Instant::now();
        loop {
            let elapsed = start.elapsed();
            let share = if elapsed >= time { 1.0 } else { elapsed.as_secs_f64() / time.as_secs_f64() };
            let at = [from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share];
            self.app.input(&Input::Pointer(at));
            if elapsed >= time {
                return;
            }
            self.serve(MOTION);
        }
    }

    /// Draw if anything is to be drawn. Time until that may be so again.
    fn frame(&mut self) -> Option<Duration> {
        let (next, draw) = self.app.tick(Instant::now());
        if draw {
            self.app.draw(&mut self.pixels);
        }
        if draw { Some(Duration::ZERO) } else { next }
    }

    /// Serve the window for so long.
    fn serve(&mut self, time: Duration) {
        let end = Instant::now() + time;
        loop {
            let next = self.frame();
            let rest = end.saturating_duration_since(Instant::now());
            if rest.is_zero() {
                return;
            }
            // Woken or not: there is something to do.
            let _ = self.woken.recv_timeout(next.unwrap_or(rest).min(rest));
            while self.woken.try_recv().is_ok() {}
        }
    }

    fn wait_until(&mut self, what: &str, is_done: impl Fn(&App) -> bool) -> Result<(), String> {
        let end = Instant::now() + PATIENCE;
        while !is_done(&self.app) {
            if Instant::now() > end {
                return Err(format!("waited for {what} in vain"));
            }
            self.serve(Duration::from_millis(10));
        }
        self.frame();
        Ok(())
    }

    fn screenshot(&mut self, path: &Path) -> Result<(), String> {
        // Twice: the first time a card is laid out, its size is not known before.
        self.frame();
        self.app.draw(&mut self.pixels);
        self.app.draw(&mut self.pixels);
        let rgb8: Vec<u8> = self.pixels.iter().flat_map(|pixel| pixel.to_be_bytes().into_iter().skip(1)).collect();
        self.host.save(path, &Shot { size: self.size, rgb8: &rgb8, linear: None })
    }

    fn save(&mut self, path: &Path) -> Result<(), String> {
        self.act(&Step::WaitRefined)?;
        let finished = self.app.session.finished().ok_or("there is no finished picture")?;
        finished.save(&*self.host, path)
    }

    fn report(&mut self) {
        let rate = self.app.session.rate(Instant::now());
        let edit = self.app.session.edit_time().map(|time| format!(", change seen after {} ms", time.as_millis()));
        let picture = self.app.session.picture();
        let Draft { size: [width, height], depth, .. } = picture.draft;
        let finished = match (&picture.finished, picture.stage) {
            (Some(finished), Stage::Finished) => format!(", finished in {:.3} s", finished.time.as_secs_f64()),
            _ => String::new(),
        };
        let weight = picture.draft.weight();
        let edit = edit.unwrap_or_default();
        let line = format!("{rate:.1} fps, {width}x{height}, depth {depth}, weights from {weight}{finished}{edit}");
        drop(picture);
        (self.print)(&line);
    }

    fn is_closed(&mut self) -> bool {
        let mut closed = false;
        for effect in self.app.session.take_effects() {
            match effect {
                Effect::Copy(text) => (self.print)(&text),
                Effect::Close => closed = true,
            }
        }
        closed
    }
}
