//! A scene that is being looked at: everything but the window.
//!
//! Whoever owns a session tells it what the person does ([`Session::input`], [`Session::act`]), calls
//! [`Session::tick`] now and then, and shows [`Session::picture`]. No call waits for the renderer, the reader or the disk.

mod actions;
mod following;
mod inspection;
mod notes;
mod rate;
mod recorder;

use crate::camera::{Click, Controls, Navigator};
use crate::errands::Errands;
use crate::host::Host;
use crate::input::{Button, Input, Key};
use crate::opener::{Activity, Opener, Ready};
use crate::options::Options;
use crate::painter::{Painter, Wanted, nameless};
use crate::pick::{self, Picked};
use crate::screen::{Finished, Picture, Screen, Stage};
use inspection::Inspector;
use notes::Notes;
use rate::Rate;
use recorder::Recorder;
use std::sync::{Arc, MutexGuard};
use std::time::{Duration, Instant, SystemTime};
use whitted::math::Vec3d;
use whitted::render::Aov;
use whitted::scene::{Camera, Prepared, Scene, Settings};

pub use actions::Destination;
pub use inspection::Inspection;
pub use notes::Note;

/// The picture is refined when nothing has moved for so long.
const QUIET: Duration = Duration::from_millis(90);

/// Time between two steps of a motion: somewhat less than a frame of any display that shows more than the painter paints.
const STEP: Duration = Duration::from_millis(8);

/// Something for the window to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Print this text on standard output, and put it on the clipboard.
    Copy(String),
    /// Close the window.
    Close,
}

/// What of the overlay is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// The cheat sheet.
    pub help: bool,
    /// The panel.
    pub panel: bool,
    /// Nothing at all but the picture.
    pub clean: bool,
}

/// A scene that is being looked at.
pub struct Session {
    host: Arc<dyn Host>,
    // Declared before the painter and the opener: a recording that is under way ends before them.
    errands: Errands,
    painter: Painter,
    opener: Opener,
    screen: Arc<Screen>,
    pool: Arc<rayon::ThreadPool>,
    options: Options,
    controls: Controls,
    navigator: Navigator,
    ready: Option<Ready>,
    /// The scene without its shapes, as changed by the person.
    look: Option<Scene>,
    /// The scene that is shown: that of `ready` with this look.
    shown_scene: Option<Arc<Prepared>>,
    /// Of the finished picture; the scene's, as changed by the person, in the size of the window.
    settings: Settings,
    /// Counts what has changed beside the picture.
    revision: u64,
    proposed_size: Option<[u32; 2]>,
    trouble: Option<String>,
    /// When the file was saved whose change is not seen yet.
    edit: Option<SystemTime>,
    edit_time: Option<Duration>,
    /// What is shown instead of light.
    view: Option<Aov>,
    inspector: Inspector,
    notes: Notes,
    rate: Rate,
    recorder: Recorder,
    shown: Shown,
    /// Somebody can see the picture: else nothing moves and nothing new is painted.
    is_visible: bool,
    effects: Vec<Effect>,
    saves: Vec<Destination>,
    wanted: Option<Wanted>,
    last_tick: Option<Instant>,
    last_change: Option<Instant>,
}

impl Session {
    /// Open the scene of `host` in a window of this size. `wake` is called from other threads when there is something
    /// new to show: the next [`tick`](Self::tick) should follow soon.
    ///
    /// # Errors
    /// If the system has no threads left.
    pub fn new(
        host: Arc<dyn Host>,
        options: Options,
        size: [u32; 2],
        wake: impl Fn() + Send + Sync + 'static,
    ) -> std::io::Result<Self> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build();
        let pool = Arc::new(pool.map_err(std::io::Error::other)?);
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(wake);
        let screen = Arc::new(Screen::new(Arc::clone(&wake)));
        let threads = pool.current_num_threads();
        let opener = Opener::start(Arc::clone(&host), options.build, threads, Arc::clone(&wake))?;
        let painter = Painter::start(Arc::clone(&screen), Arc::clone(&pool), options.execution, options.fps_target)?;
        Ok(Self {
            errands: Errands::start(Arc::clone(&wake))?,
            inspector: Inspector::new(wake),
            view: None,
            painter,
            opener,
            screen,
            pool,
            options,
            host,
            controls: Controls::default(),
            navigator: Navigator::new(Camera::default(), 1.0),
            ready: None,
            look: None,
            shown_scene: None,
            settings: Settings { size, ..Settings::default() },
            revision: 0,
            proposed_size: None,
            trouble: None,
            edit: None,
            edit_time: None,
            notes: Notes::default(),
            rate: Rate::default(),
            recorder: Recorder::default(),
            shown: Shown { help: false, panel: false, clean: false },
            is_visible: true,
            effects: Vec::new(),
            saves: Vec::new(),
            wanted: None,
            last_tick: None,
            last_change: None,
        })
    }

    /// Move on to `now`: take in what other threads have done, move the camera, order what is missing. When to be called
    /// again at the latest; `None`: not before something happens.
    pub fn tick(&mut self, now: Instant) -> Option<Duration> {
        while let Some(news) = self.opener.news() {
            self.hear(news, now);
        }
        self.revision += u64::from(self.inspector.listen());
        while let Some(line) = self.errands.told() {
            self.notes.add(line, now);
            self.revision += 1;
        }
        if self.is_visible {
            self.advance(now);
        }
        self.save_what_waits();
        self.revision += u64::from(self.notes.clear_old(now));
        self.next_tick(now)
    }

    /// Move the camera, and order the picture that it sees.
    fn advance(&mut self, now: Instant) {
        let seconds = self.last_tick.map_or(0.0, |last| now.duration_since(last).as_secs_f64());
        self.last_tick = Some(now);
        if self.navigator.advance(seconds) {
            self.touch(now);
        }
        self.recorder.observe(self.navigator.camera(), now);
        self.order(now);
        self.tell_of_edit(now);
    }

    /// Whether anybody can see the picture. While nobody can, nothing moves, and nothing new is painted.
    pub fn set_visible(&mut self, is_visible: bool) {
        if !is_visible {
            // Nobody has waited for what happens meanwhile.
            (self.last_tick, self.edit) = (None, None);
        }
        self.is_visible = is_visible;
    }

    fn next_tick(&self, now: Instant) -> Option<Duration> {
        let quiet = self.quiet_in(now).filter(|_| self.is_visible);
        let step = (self.is_visible && self.navigator.is_moving()).then_some(STEP);
        let note = self.notes.next_end(now);
        [step, quiet, note].into_iter().flatten().min()
    }

    /// Time until the picture may be refined; `None` if it may.
    fn quiet_in(&self, now: Instant) -> Option<Duration> {
        let rest = QUIET.checked_sub(now.duration_since(self.last_change?))?;
        (!rest.is_zero()).then_some(rest)
    }

    /// Something that is seen has changed.
    fn touch(&mut self, now: Instant) {
        self.last_change = Some(now);
    }

    /// Order the picture that should be seen now, if it is not on order.
    fn order(&mut self, now: Instant) {
        let Some(scene) = &self.shown_scene else { return };
        let wanted = Wanted {
            scene: Arc::clone(scene),
            camera: *self.navigator.camera(),
            settings: self.settings.clone(),
            view: self.view,
            moving: self.quiet_in(now).is_some() || self.navigator.is_moving(),
        };
        let is_new = self.wanted.as_ref().is_none_or(|old| !old.looks_like(&wanted) || old.moving != wanted.moving);
        if is_new && !wanted.settings.size.contains(&0) {
            self.painter.want(wanted.clone());
            self.wanted = Some(wanted);
        }
    }

    /// What the person does.
    pub fn input(&mut self, input: &Input) {
        if let Input::Key(key, true) = *input
            && !self.controls.modifiers().alt
        {
            self.key(key);
        }
        let scene = self.shown_scene.clone();
        let (camera, pivot) = (*self.navigator.camera(), self.navigator.pivot());
        let (size, sampling) = (self.settings.size, self.settings.sampling);
        let under = |at: [f64; 2]| {
            let direction = pick::direction(&camera, size, sampling, at);
            let picked = scene.as_deref().and_then(|scene| pick::pick(scene, camera.eye, direction));
            picked.map_or_else(|| beside(&camera, pivot, direction), |picked| picked.point)
        };
        let click = self.controls.take(input, f64::from(size[1]).max(1.0), &mut self.navigator, under);
        if let Some(click) = click {
            self.clicked(click);
        }
    }

    fn clicked(&mut self, click: Click) {
        match click.button {
            Button::Left => self.inspect(click.at),
            Button::Middle => {
                if let Some(picked) = self.pick(click.at) {
                    self.navigator.look_at(picked.point);
                }
            }
            Button::Right => {}
        }
    }

    /// Ask why a pixel of the picture looks as it does.
    fn inspect(&mut self, at: [f64; 2]) {
        let Some(scene) = &self.shown_scene else { return };
        if let Ok(scene) = scene.with_camera(&nameless(self.navigator.camera())) {
            self.inspector.ask(at.map(|a| a.max(0.0) as u32), scene, self.settings.clone());
        }
    }

    /// The pixel that is looked at.
    pub fn inspection(&self) -> Option<&Inspection> {
        self.inspector.current()
    }

    /// Look at a ray of that pixel, by its number.
    pub fn choose_ray(&mut self, ray: Option<usize>) {
        self.inspector.choose(ray);
    }

    /// Look at no pixel any more.
    pub fn forget_pixel(&mut self) {
        self.inspector.forget();
    }

    /// What is shown instead of light.
    pub fn view(&self) -> Option<Aov> {
        self.view
    }

    /// Show this instead of light; `None`: light.
    pub fn set_view(&mut self, view: Option<Aov>) {
        self.view = view;
    }

    fn key(&mut self, key: Key) {
        let modifiers = self.controls.modifiers();
        if modifiers.control {
            if key == Key::Char('s') {
                self.act(crate::action::Action::Save);
            }
            return;
        }
        if let Some(action) = crate::action::Action::of(key, modifiers.shift) {
            self.act(action);
        }
    }

    /// What is at a pixel.
    pub(crate) fn pick(&self, at: [f64; 2]) -> Option<Picked> {
        let scene = self.shown_scene.as_ref()?;
        let camera = self.navigator.camera();
        let direction = pick::direction(camera, self.settings.size, self.settings.sampling, at);
        pick::pick(scene, camera.eye, direction)
    }

    /// The window has this size now, in pixels. Nothing is painted while a side is zero.
    pub fn resize(&mut self, size: [u32; 2], now: Instant) {
        if size != self.settings.size {
            self.settings.size = size;
            self.touch(now);
        }
    }

    /// The size of the picture that the scene asks for, once it is read.
    pub fn proposed_size(&self) -> Option<[u32; 2]> {
        self.proposed_size
    }

    /// Counts what has changed beside the picture: with another number, what lies over the picture is another.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The picture, for a moment: copy it and let it go.
    pub fn picture(&self) -> MutexGuard<'_, Picture> {
        self.screen.look()
    }

    /// The finished picture of what is wanted now, if it is finished.
    pub fn finished(&self) -> Option<Arc<Finished>> {
        let wanted = self.wanted.as_ref().filter(|wanted| !wanted.moving)?;
        let picture = self.picture();
        let finished = picture.finished.as_ref().filter(|_| picture.stage == Stage::Finished)?;
        let is_it = wanted.has_light_of(&finished.scene, &finished.camera, &finished.settings)
            && finished.view.as_ref().map(|view| view.aov) == wanted.view;
        is_it.then(|| Arc::clone(finished))
    }

    /// True when everything is done that can be done: the scene is read, the picture finished, nothing moves.
    pub fn is_at_rest(&self) -> bool {
        let is_idle = self.opener.activity() == Activity::Idle && !self.navigator.is_moving();
        is_idle && (self.finished().is_some() || self.ready.is_none() && self.trouble.is_some())
    }

    /// What was asked of the window since this was last called.
    pub fn take_effects(&mut self) -> Vec<Effect> {
        std::mem::take(&mut self.effects)
    }

    /// What is wrong with the scene as it is now; an older state of it is shown then.
    pub fn trouble(&self) -> Option<&str> {
        self.trouble.as_deref()
    }

    /// Short messages that are shown for a while.
    pub fn notes(&self) -> &[Note] {
        self.notes.all()
    }

    /// The scene that is shown.
    pub fn scene(&self) -> Option<&Scene> {
        self.ready.as_ref().map(|ready| &*ready.scene)
    }

    /// The same, ready to be rendered.
    pub fn prepared(&self) -> Option<&Prepared> {
        self.shown_scene.as_deref()
    }

    /// Materials, lights, ambient light and background as they are shown: a scene without shapes.
    pub fn look(&self) -> Option<&Scene> {
        self.look.as_ref()
    }

    /// Show other materials, lights, ambient light or background; impossible ones are refused. The file stays as it is,
    /// and when it is changed, it is followed again.
    pub fn set_look(&mut self, look: Scene) {
        let Some(ready) = &self.ready else { return };
        if let Ok(prepared) = ready.prepared.with_look_of(&look) {
            self.shown_scene = Some(Arc::new(prepared));
            self.look = Some(look);
        }
    }

    /// Pictures a second that are shown while things move.
    pub fn rate(&mut self, now: Instant) -> f64 {
        let drafts = self.picture().drafts;
        self.rate.observe(drafts, now);
        self.rate.per_second()
    }

    /// The name of the scene's file.
    pub fn title(&self) -> String {
        self.host.path().file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// How long reading and building the scene took.
    pub fn opening_times(&self) -> Option<[Duration; 2]> {
        self.ready.as_ref().map(|ready| [ready.read_time, ready.build_time])
    }

    /// From the last time that the scene's files were saved until the change was seen.
    pub fn edit_time(&self) -> Option<Duration> {
        self.edit_time
    }

    /// What is being read or built.
    pub fn activity(&self) -> Activity {
        self.opener.activity()
    }

    /// The share of the tree that is built, 0 to 1, while it is being built.
    pub fn built_share(&self) -> f32 {
        self.opener.built_share()
    }

    /// The camera of this moment.
    pub fn camera(&self) -> &Camera {
        self.navigator.camera()
    }

    /// The settings of the finished picture.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Change the settings of the finished picture; its size stays that of the window. Impossible ones are refused.
    pub fn set_settings(&mut self, settings: Settings) {
        let settings = Settings { size: self.settings.size, ..settings };
        if settings.check().is_ok() {
            self.settings = settings;
        }
    }

    /// What of the overlay is shown.
    pub fn shown(&self) -> Shown {
        self.shown
    }

    /// True while the person holds the picture with the mouse.
    pub fn is_dragging(&self) -> bool {
        self.controls.is_dragging()
    }
}

/// The point where a ray that hits nothing passes the pivot.
fn beside(camera: &Camera, pivot: Vec3d, direction: Vec3d) -> Vec3d {
    let ahead = (pivot - camera.eye).length();
    camera.eye + direction * ahead
}
