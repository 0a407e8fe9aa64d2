//! The thread that reads the scene, builds its tree, and watches its files.

use crate::host::{Host, Opened};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};
use whitted::math::Vec3d;
use whitted::scene::{Change, Prepared, Scene, difference};
use whitted::tree::BuildOptions;

/// How often the files are looked at. Asking the system for the time stamp of a file takes some microseconds, so this
/// costs a thousandth of a core, works on every file system and needs no dependency.
const POLL: Duration = Duration::from_millis(30);

/// A file that has changed is read when it stays as it is for so long: a large one would be read half written, and told
/// to be broken only after the time in which the whole could have been read. Files that are written all the time are read
/// after the latter time.
const WRITING: Duration = Duration::from_millis(5);
const LONGEST_WRITING: Duration = Duration::from_millis(100);

/// A broken scene is shown as such only if its files stay as they are for so long: editors that write a file in
/// several steps leave it empty for a moment.
const SETTLED: Duration = Duration::from_millis(60);

/// A scene that is ready to be shown.
#[derive(Clone, Debug)]
pub(crate) struct Ready {
    pub(crate) scene: Arc<Scene>,
    pub(crate) prepared: Arc<Prepared>,
    /// The corners of a box around everything bounded.
    pub(crate) bounds: Option<[Vec3d; 2]>,
    pub(crate) warnings: Vec<String>,
    /// How long reading and building took. The latter is zero if nothing had to be built.
    pub(crate) read_time: Duration,
    pub(crate) build_time: Duration,
    /// When the files were saved, if it was read because they have changed.
    pub(crate) saved: Option<SystemTime>,
}

/// What the opener is doing.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Activity {
    /// It waits for files to change.
    #[default]
    Idle,
    /// It reads files, since then.
    Reading(Instant),
    /// It builds the tree over so many primitives, since then.
    Building(usize, Instant),
}

/// What the opener tells.
#[derive(Debug)]
pub(crate) enum News {
    /// The files were read; the picture shall have this size.
    Read([u32; 2]),
    /// The scene is new or has changed.
    Ready(Box<Ready>),
    /// It cannot be read.
    Broken(String),
}

/// The opening thread, from outside. It ends by itself when this is dropped.
pub(crate) struct Opener {
    orders: Sender<()>,
    news: Receiver<News>,
    activity: Arc<Mutex<Activity>>,
    built: Arc<Share>,
    closing: Arc<AtomicBool>,
}

/// A share that only grows, until it is set back.
#[derive(Debug, Default)]
struct Share(AtomicU32);

impl Share {
    fn set_back(&self) {
        self.0.store(0, Ordering::Relaxed);
    }

    /// Positive numbers have the order of their bits. Tells whether it has grown by a hundredth.
    fn grow(&self, share: f32) -> bool {
        let before = f32::from_bits(self.0.fetch_max(share.max(0.0).to_bits(), Ordering::Relaxed));
        (before * 100.0).floor() < (share * 100.0).floor()
    }

    fn get(&self) -> f32 {
        f32::from_bits(self.0.load(Ordering::Relaxed))
    }
}

impl Opener {
    /// Start to open the scene; `wake` is called when there are news.
    ///
    /// # Errors
    /// If the system has no thread left.
    pub(crate) fn start(
        host: Arc<dyn Host>,
        options: BuildOptions,
        threads: usize,
        wake: Arc<dyn Fn() + Send + Sync>,
    ) -> std::io::Result<Self> {
        let (orders, inbox) = channel();
        let (outbox, news) = channel();
        let activity = Arc::<Mutex<Activity>>::default();
        let (built, closing) = (Arc::<Share>::default(), Arc::new(AtomicBool::new(false)));
        let mut work = Work {
            options,
            threads,
            inbox,
            outbox,
            wake,
            activity: Arc::clone(&activity),
            built: Arc::clone(&built),
            closing: Arc::clone(&closing),
            watched: vec![Watched::new(host.path().to_owned())],
            current: None,
            gave_up: false,
            host,
        };
        std::thread::Builder::new().name("opener".to_owned()).spawn(move || work.run())?;
        Ok(Self { orders, news, activity, built, closing })
    }

    /// Read the scene again, even if its files have not changed.
    pub(crate) fn reload(&self) {
        // If the thread has gone, nothing can be read any more.
        let _ = self.orders.send(());
    }

    /// What happened since this was last asked.
    pub(crate) fn news(&self) -> Option<News> {
        self.news.try_recv().ok()
    }

    /// What it is doing.
    pub(crate) fn activity(&self) -> Activity {
        self.activity.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The share of the tree that is built, 0 to 1; what it says means nothing unless a tree is being built.
    pub(crate) fn built_share(&self) -> f32 {
        self.built.get()
    }
}

impl Drop for Opener {
    fn drop(&mut self) {
        self.closing.store(true, Ordering::Relaxed);
    }
}

/// A file and how it was when it was last read.
#[derive(Debug)]
struct Watched {
    path: PathBuf,
    stamp: Option<(SystemTime, u64)>,
}

impl Watched {
    fn new(path: PathBuf) -> Self {
        Self { stamp: stamp(&path), path }
    }

    /// True if it is another file now than when [`changed`](Self::changed) was last asked.
    fn is_outdated(&self) -> bool {
        stamp(&self.path) != self.stamp
    }

    /// As [`is_outdated`](Self::is_outdated), and remembers how it is now.
    fn changed(&mut self) -> bool {
        let now = stamp(&self.path);
        std::mem::replace(&mut self.stamp, now) != now
    }
}

/// Time and length of a file; `None` if it is not there.
fn stamp(path: &Path) -> Option<(SystemTime, u64)> {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

/// What the opening thread owns.
struct Work {
    host: Arc<dyn Host>,
    options: BuildOptions,
    threads: usize,
    inbox: Receiver<()>,
    outbox: Sender<News>,
    wake: Arc<dyn Fn() + Send + Sync>,
    activity: Arc<Mutex<Activity>>,
    built: Arc<Share>,
    closing: Arc<AtomicBool>,
    watched: Vec<Watched>,
    /// What was told last.
    current: Option<Ready>,
    /// The last build was given up for the next one, which is not: files that are written all the time shall be seen.
    gave_up: bool,
}

impl Work {
    fn run(&mut self) {
        let mut is_due = true;
        let mut changed = false;
        let mut trouble: Option<(Instant, String)> = None;
        while !self.closing.load(Ordering::Relaxed) {
            if is_due {
                trouble = self.open(changed).err().map(|text| (Instant::now(), text));
            }
            if let Some((_, text)) = trouble.take_if(|(since, _)| since.elapsed() >= SETTLED) {
                self.tell(News::Broken(text));
            }
            let ordered = match self.inbox.recv_timeout(POLL) {
                Ok(()) => true,
                Err(RecvTimeoutError::Timeout) => false,
                Err(RecvTimeoutError::Disconnected) => return,
            };
            changed = self.changed();
            is_due = ordered || changed;
            if changed {
                wait_while(|| self.changed());
            }
        }
    }

    /// Whether any file is another one than when this was last asked.
    fn changed(&mut self) -> bool {
        // All of them are asked, so that each remembers how it is.
        self.watched.iter_mut().fold(false, |any, file| file.changed() | any)
    }

    fn tell(&self, news: News) {
        // If nobody listens any more, the viewer is about to close.
        let _ = self.outbox.send(news);
        (self.wake)();
    }

    fn set(&self, activity: Activity) {
        *self.activity.lock().unwrap_or_else(PoisonError::into_inner) = activity;
        (self.wake)();
    }

    /// Read the scene, perhaps because its files have changed, and make it ready.
    fn open(&mut self, changed: bool) -> Result<(), String> {
        let start = Instant::now();
        self.set(Activity::Reading(start));
        let result = self.host.open().and_then(|opened| self.prepare(opened, start.elapsed()));
        let saved = self.watched.iter().filter_map(|watched| watched.stamp).map(|(time, _)| time).max();
        // Before it is idle: whoever sees it idle has heard of what it did.
        let told = result.map(|ready| {
            if let Some(ready) = ready {
                self.tell(News::Ready(Box::new(Ready { saved: saved.filter(|_| changed), ..ready })));
            }
        });
        self.set(Activity::Idle);
        told
    }

    /// Make a scene ready; `None` if its files have changed again before the tree was built.
    fn prepare(&mut self, opened: Opened, read_time: Duration) -> Result<Option<Ready>, String> {
        let Opened { scene, files, warnings } = opened;
        self.watch(files);
        self.tell(News::Read(scene.settings.size));
        let start = Instant::now();
        let same = self.current.as_ref().filter(|ready| difference(&ready.scene, &scene) != Change::Geometry);
        let prepared = match same {
            Some(ready) => ready.prepared.with_look_of(&scene).map(Some),
            None => self.build(&scene),
        };
        let prepared = prepared.map_err(|error| format!("{}: {error}", self.host.path().display()))?;
        self.gave_up = prepared.is_none();
        let Some(prepared) = prepared.map(Arc::new) else { return Ok(None) };
        let (bounds, build_time) = match same {
            Some(ready) => (ready.bounds, Duration::ZERO),
            None => (scene.bounds().map(|(lo, hi)| [lo, hi]), start.elapsed()),
        };
        let ready = Ready { scene: Arc::new(scene), prepared, bounds, warnings, read_time, build_time, saved: None };
        self.current = Some(ready.clone());
        Ok(Some(ready))
    }

    fn build(&self, scene: &Scene) -> Result<Option<Prepared>, whitted::scene::SceneError> {
        self.built.set_back();
        self.set(Activity::Building(scene.primitive_count(), Instant::now()));
        // A pool of its own: the picture of before must be able to move meanwhile.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads).build();
        let options = &self.options;
        let Self { built, closing, watched, gave_up, .. } = self;
        let watch = |share| {
            let is_next = built.grow(share);
            // Whoever has saved again does not want to wait for the tree of before.
            let is_outdated = || watched.iter().any(Watched::is_outdated);
            closing.load(Ordering::Relaxed) || !gave_up && is_next && is_outdated()
        };
        let build = || Prepared::new_until(scene, options, &watch);
        pool.map_or_else(|_| build(), |pool| pool.install(build))
    }

    /// Watch these files from now on; those that were watched before keep their stamps.
    fn watch(&mut self, files: Vec<PathBuf>) {
        self.watched.retain(|watched| files.contains(&watched.path));
        for path in files {
            if !self.watched.iter().any(|watched| watched.path == path) {
                self.watched.push(Watched::new(path));
            }
        }
    }
}

/// Wait until files are written.
fn wait_while(mut change: impl FnMut() -> bool) {
    let start = Instant::now();
    loop {
        std::thread::sleep(WRITING);
        if !change() || start.elapsed() >= LONGEST_WRITING {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_when_they_are_written_or_never_will_be() {
        let mut left = 3;
        let start = Instant::now();
        wait_while(|| {
            left -= 1;
            left > 0
        });
        assert!(left == 0 && start.elapsed() >= 3 * WRITING || start.elapsed() >= LONGEST_WRITING);
        wait_while(|| true);
        assert!(start.elapsed() >= LONGEST_WRITING);
    }
}
