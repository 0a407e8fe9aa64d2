//! The thread that paints: drafts while things move, then the whole picture, region by region.

use crate::enlarge::{enlarge, pack};
use crate::quality::{Draft, Quality};
use crate::screen::{Finished, Screen, Stage, copy_rect};
use rayon::ThreadPool;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, OnceLock, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use whitted::math::Vec3f;
use whitted::render::{Aov, AovPicture, Cancel, Cancelled, Execution, Frame, Image, PixelRect, Progress, Region};
use whitted::render::{Renderer, Unwatched, aovs};
use whitted::scene::{Antialias, Camera, NamedCamera, Prepared, Settings};

/// Regions for each thread, at least: else some would wait for others. Four times as many do not lessen the time in which
/// threads wait (1.7 to 3.8 % in the still life, 9 to 11 % in mix-1000, 1280×720, two threads).
const REGIONS_PER_THREAD: u32 = 4;

/// Sides of the regions of drafts in pixels, from which the largest that gives enough regions is taken.
const REGION_SIDES: [u32; 3] = [64, 32, 16];

/// What the window shall show.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    pub(crate) scene: Arc<Prepared>,
    pub(crate) camera: Camera,
    /// Of the finished picture; its size is that of the window.
    pub(crate) settings: Settings,
    /// What is shown instead of light.
    pub(crate) view: Option<Aov>,
    /// Things move: there is no use in refining.
    pub(crate) moving: bool,
}

impl Wanted {
    /// Whether both give the same picture.
    pub(crate) fn looks_like(&self, other: &Self) -> bool {
        self.view == other.view && self.has_light_of(&other.scene, &other.camera, &other.settings)
    }

    /// Whether this is that scene, seen by that camera, with those settings.
    pub(crate) fn has_light_of(&self, scene: &Arc<Prepared>, camera: &Camera, settings: &Settings) -> bool {
        Arc::ptr_eq(&self.scene, scene) && self.camera == *camera && self.settings == *settings
    }
}

/// The painting thread, from outside.
pub(crate) struct Painter {
    desk: Arc<Desk>,
    thread: Option<JoinHandle<()>>,
}

/// Where orders are left and picked up.
#[derive(Default)]
struct Desk {
    order: Mutex<Order>,
    changed: Condvar,
}

#[derive(Default)]
struct Order {
    wanted: Option<Arc<Wanted>>,
    /// Stops what is being refined.
    refining: Option<Arc<Cancel>>,
    closing: bool,
}

impl Painter {
    /// Start the thread; it paints on `screen` with the threads of `pool`, so many pictures a second while things move.
    ///
    /// # Errors
    /// If the system has no thread left.
    pub(crate) fn start(
        screen: Arc<Screen>,
        pool: Arc<ThreadPool>,
        execution: Execution,
        fps: f64,
    ) -> std::io::Result<Self> {
        let desk = Arc::<Desk>::default();
        let mut work = Work {
            desk: Arc::clone(&desk),
            screen,
            quality: Quality::new(fps, pool.current_num_threads()),
            pool,
            execution,
            renderer: Renderer::default(),
            spare: Vec::new(),
            finished: None,
            scene: None,
        };
        let thread = std::thread::Builder::new().name("painter".to_owned()).spawn(move || work.run())?;
        Ok(Self { desk, thread: Some(thread) })
    }

    /// Let this be painted, instead of what was wanted before.
    pub(crate) fn want(&self, wanted: Wanted) {
        let mut order = self.desk.lock();
        if let Some(cancel) = &order.refining {
            cancel.cancel();
        }
        order.wanted = Some(Arc::new(wanted));
        self.desk.changed.notify_one();
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        let mut order = self.desk.lock();
        order.closing = true;
        if let Some(cancel) = &order.refining {
            cancel.cancel();
        }
        self.desk.changed.notify_one();
        drop(order);
        if let Some(thread) = self.thread.take() {
            // If it panicked, it has said so already.
            let _ = thread.join();
        }
    }
}

impl Desk {
    fn lock(&self) -> std::sync::MutexGuard<'_, Order> {
        // Orders are replaced whole: a panic elsewhere leaves none half written.
        self.order.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Wait for an order other than `done`. `None`: the viewer is closed.
    fn next(&self, done: Option<&Arc<Wanted>>) -> Option<Arc<Wanted>> {
        let mut order = self.lock();
        loop {
            if order.closing {
                return None;
            }
            match &order.wanted {
                Some(wanted) if done.is_none_or(|done| !Arc::ptr_eq(done, wanted)) => return Some(Arc::clone(wanted)),
                _ => order = self.changed.wait(order).unwrap_or_else(PoisonError::into_inner),
            }
        }
    }

    /// Begin to refine `wanted`, unless something else is wanted by now.
    fn begin_refining(&self, wanted: &Arc<Wanted>) -> Option<Arc<Cancel>> {
        let mut order = self.lock();
        let is_current = order.wanted.as_ref().is_some_and(|current| Arc::ptr_eq(current, wanted));
        if order.closing || !is_current {
            return None;
        }
        let cancel = Arc::new(Cancel::new());
        order.refining = Some(Arc::clone(&cancel));
        Some(cancel)
    }
}

/// What the painting thread owns.
struct Work {
    desk: Arc<Desk>,
    screen: Arc<Screen>,
    pool: Arc<ThreadPool>,
    execution: Execution,
    quality: Quality,
    renderer: Renderer,
    /// The pixels of the picture before, whose memory is used for the next: fresh memory costs as much as enlarging.
    spare: Vec<u32>,
    /// What was finished last: another view of it needs no other render.
    finished: Option<Arc<Finished>>,
    /// The scene that was painted last with the camera of the moment, and the one that it was made from.
    scene: Option<(Arc<Prepared>, Prepared)>,
}

impl Work {
    fn run(&mut self) {
        let mut drafted: Option<Arc<Wanted>> = None;
        let mut done = None;
        while let Some(wanted) = self.desk.next(done.as_ref()) {
            done = Some(Arc::clone(&wanted));
            let Some(prepared) = self.prepared(&wanted) else { continue };
            let is_drafted = drafted.as_ref().is_some_and(|before| before.looks_like(&wanted));
            if !is_drafted && self.finished_light(&wanted).is_none() {
                self.draft(&wanted, &prepared);
                drafted = Some(Arc::clone(&wanted));
            }
            if !wanted.moving
                && let Some(cancel) = self.desk.begin_refining(&wanted)
            {
                self.refine(&wanted, &prepared, &cancel);
            }
            self.scene = Some((Arc::clone(&wanted.scene), prepared));
        }
    }

    /// The scene with the camera that is wanted; `None` if the camera is impossible.
    fn prepared(&mut self, wanted: &Wanted) -> Option<Prepared> {
        let prepared = match self.scene.take() {
            Some((source, prepared)) if Arc::ptr_eq(&source, &wanted.scene) => prepared,
            before => {
                let geometry = before.map(|(source, _)| source);
                if geometry.is_none_or(|before| !std::ptr::eq(before.geometry(), wanted.scene.geometry())) {
                    self.quality.forget();
                }
                Prepared::clone(&wanted.scene)
            }
        };
        prepared.with_camera(&nameless(&wanted.camera)).ok()
    }

    /// The finished frame of what is wanted, if it was finished already.
    fn finished_light(&self, wanted: &Wanted) -> Option<&Arc<Finished>> {
        let finished = self.finished.as_ref()?;
        wanted.has_light_of(&finished.scene, &finished.camera, &finished.settings).then_some(finished)
    }

    /// What `view` shows of a frame.
    fn view(
        &self,
        view: Option<Aov>,
        frame: &Frame,
        prepared: &Prepared,
        settings: &Settings,
        cancel: &Cancel,
    ) -> Result<Option<AovPicture>, Cancelled> {
        let Some(view) = view else { return Ok(None) };
        let pictures = self.pool.install(|| aovs(&[view], frame, prepared, settings, &self.execution, &clock, cancel));
        pictures.map(|pictures| pictures.into_iter().next())
    }

    /// Paint in time.
    fn draft(&mut self, wanted: &Wanted, prepared: &Prepared) {
        loop {
            let start = Instant::now();
            let draft = self.quality.draft(&wanted.settings);
            let settings = draft_settings(&wanted.settings, &draft);
            let end = self.quality.patience().map(|patience| start + patience);
            let deadline = Deadline::new(end, &settings);
            let frame = self.pool.install(|| {
                let execution = Execution { first_samples: wanted.view.is_some(), ..self.execution_of(&draft) };
                let whole = PixelRect::whole(draft.size);
                let (renderer, cancel) = (&self.renderer, &deadline.cancel);
                renderer.render(prepared, &settings, &execution, &whole, &deadline, cancel, &Unwatched)
            });
            let share = deadline.share();
            let painted = frame.and_then(|frame| {
                let view = self.view(wanted.view, &frame, prepared, &settings, &deadline.cancel)?;
                self.renderer.recycle(frame);
                Ok(view.map(|view| pack(&view.rgb8)))
            });
            match painted {
                Ok(view) => {
                    let small = view.unwrap_or_else(|| deadline.into_pixels());
                    let pixels = self.enlarged(small, draft.size, wanted.settings.size);
                    let time = start.elapsed();
                    self.quality.measured(&draft, time.as_secs_f64(), 1.0);
                    return self.show(wanted, &draft, pixels, time);
                }
                Err(_) => self.quality.measured(&draft, start.elapsed().as_secs_f64(), share),
            }
        }
    }

    /// A draft in the size of the window.
    fn enlarged(&mut self, small: Vec<u32>, from: [u32; 2], to: [u32; 2]) -> Vec<u32> {
        if from == to {
            return small;
        }
        let mut large = std::mem::take(&mut self.spare);
        self.pool.install(|| enlarge(&small, from, to, &mut large));
        large
    }

    fn execution_of(&self, draft: &Draft) -> Execution {
        let enough = REGIONS_PER_THREAD * self.pool.current_num_threads() as u32;
        let regions = |side: u32| draft.size[0].div_ceil(side) * draft.size[1].div_ceil(side);
        let [.., smallest] = REGION_SIDES;
        let side = REGION_SIDES.into_iter().find(|&side| regions(side) >= enough).unwrap_or(smallest);
        Execution { region: Region::Rectangle(side, side), ..self.execution }
    }

    fn show(&mut self, wanted: &Wanted, draft: &Draft, pixels: Vec<u32>, time: Duration) {
        let spare = &mut self.spare;
        self.screen.change(|picture| {
            picture.size = wanted.settings.size;
            *spare = std::mem::replace(&mut picture.pixels, pixels);
            picture.stage = Stage::Draft;
            picture.draft = *draft;
            picture.draft_time = time;
            picture.scene = Some(Arc::clone(&wanted.scene));
            picture.drafts += 1;
            picture.finished = None;
        });
    }

    /// Paint in full, unless stopped.
    fn refine(&mut self, wanted: &Wanted, prepared: &Prepared, cancel: &Cancel) {
        if let Ok(finished) = self.finish(wanted, prepared, cancel) {
            let settings = &wanted.settings;
            let pixels = self.pool.install(|| pack(&finished.rgb8()));
            self.finished = Some(Arc::clone(&finished));
            self.screen.change(|picture| {
                picture.size = settings.size;
                picture.pixels = pixels;
                picture.stage = Stage::Finished;
                picture.finished = Some(finished);
            });
        }
    }

    fn finish(&self, wanted: &Wanted, prepared: &Prepared, cancel: &Cancel) -> Result<Arc<Finished>, Cancelled> {
        let start = Instant::now();
        let settings = &wanted.settings;
        let (frame, time) = match self.finished_light(wanted) {
            Some(finished) => (Arc::clone(&finished.frame), finished.time),
            None => {
                let sink = Brush { screen: &self.screen, settings, paints: wanted.view.is_none() };
                let frame = self.pool.install(|| {
                    let whole = PixelRect::whole(settings.size);
                    self.renderer.render(prepared, settings, &self.execution, &whole, &sink, cancel, &Unwatched)
                })?;
                (Arc::new(frame), start.elapsed())
            }
        };
        let view = self.view(wanted.view, &frame, prepared, settings, cancel)?;
        let Wanted { scene, settings, camera, .. } = wanted.clone();
        Ok(Arc::new(Finished { frame, view, settings, scene, camera, time }))
    }
}

/// Nanoseconds since the first call.
fn clock() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64
}

/// A camera that needs no name.
pub(crate) fn nameless(camera: &Camera) -> NamedCamera {
    NamedCamera { name: String::new(), camera: *camera }
}

/// The settings of a draft: one sample a pixel.
fn draft_settings(settings: &Settings, draft: &Draft) -> Settings {
    let Draft { size, depth, min_weight } = *draft;
    Settings { size, depth, min_weight, antialias: Antialias::Off, ..settings.clone() }
}

/// Collects a draft, and gives it up when its time is over.
struct Deadline<'a> {
    end: Option<Instant>,
    cancel: Cancel,
    /// Regions that were done, and all of them.
    done: AtomicU64,
    total: AtomicU64,
    settings: &'a Settings,
    pixels: Mutex<Vec<u32>>,
}

impl<'a> Deadline<'a> {
    /// For a picture with these settings.
    fn new(end: Option<Instant>, settings: &'a Settings) -> Self {
        let [width, height] = settings.size.map(|side| side as usize);
        let pixels = Mutex::new(vec![0; width * height]);
        Self { end, cancel: Cancel::new(), done: AtomicU64::new(0), total: AtomicU64::new(0), settings, pixels }
    }

    /// The share of the picture that was painted.
    fn share(&self) -> f64 {
        let done = self.done.load(Ordering::Relaxed) as f64;
        done.max(0.5) / self.total.load(Ordering::Relaxed).max(1) as f64
    }

    fn into_pixels(self) -> Vec<u32> {
        self.pixels.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Progress for Deadline<'_> {
    fn regions_done(&self, _: u32, done: usize, total: usize) {
        self.done.fetch_max(done as u64, Ordering::Relaxed);
        self.total.store(total as u64, Ordering::Relaxed);
        if done < total && self.end.is_some_and(|end| Instant::now() > end) {
            self.cancel.cancel();
        }
    }

    fn painted(&self, rect: &PixelRect, colors: &mut dyn Iterator<Item = Vec3f>) {
        // Encoded here, by all threads, and not at the end by one of them.
        let rgb8 = encoded(colors.collect(), self.settings);
        let mut pixels = self.pixels.lock().unwrap_or_else(PoisonError::into_inner);
        copy_rect(&mut pixels, self.settings.size[0], rect, &rgb8);
    }
}

fn encoded(pixels: Vec<Vec3f>, settings: &Settings) -> Vec<u8> {
    Image { width: pixels.len() as u32, height: 1, pixels }.to_rgb8(settings)
}

/// Paints finished regions on the screen.
struct Brush<'a> {
    screen: &'a Screen,
    settings: &'a Settings,
    /// False if something else than light is shown: then only progress is.
    paints: bool,
}

impl Progress for Brush<'_> {
    fn regions_done(&self, phase: u32, done: usize, total: usize) {
        let share = (phase - 1) as f32 + done as f32 / total.max(1) as f32;
        self.screen.change(|picture| picture.stage = Stage::Refining(share));
    }

    fn painted(&self, rect: &PixelRect, colors: &mut dyn Iterator<Item = Vec3f>) {
        if self.paints {
            self.screen.paint(self.settings.size, rect, &encoded(colors.collect(), self.settings));
        }
    }

    fn refined(&self, pixels: &mut dyn Iterator<Item = ([u32; 2], Vec3f)>) {
        if !self.paints {
            return;
        }
        let (places, colors): (Vec<_>, Vec<_>) = pixels.unzip();
        self.screen.touch_up(self.settings.size, &places, &encoded(colors, self.settings));
    }
}
