//! Loading a scene again after changes: meshes whose files are as they were are not read again.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, SystemTime};

use crate::error::{Error, Warning};
use crate::files::{Context, LoadOptions};
use crate::mesh::MeshFile;
use crate::{Format, Loaded, read};

/// Loads a scene again and again. What is loaded is always what [`load`](crate::load) loads.
///
/// A mesh is read again only if the length or the time of change of one of its files is another one. A file that was
/// changed less than two seconds before the scene's own file was saved is always read: its time may not tell.
#[derive(Debug, Default)]
pub struct Loader {
    known: KnownMeshes,
}

impl Loader {
    /// See [`load`](crate::load).
    ///
    /// # Errors
    /// As [`load`](crate::load); what is known of meshes is kept.
    pub fn load(&mut self, path: &Path, options: &LoadOptions) -> Result<Loaded, Error> {
        let format = Format::of(path)?;
        self.known.begin(path);
        let mut context = Context::knowing(options, &mut self.known);
        let bytes = context.read_first(path)?;
        let loaded = read(format, path, bytes, context)?;
        self.known.meshes.retain(|_, mesh| mesh.is_used);
        Ok(loaded)
    }
}

/// Meshes that were read before, by the canonical path of their file.
#[derive(Debug, Default)]
pub(crate) struct KnownMeshes {
    meshes: HashMap<PathBuf, KnownMesh>,
    /// When the scene was saved: a moment before anything is read now.
    saved: Option<SystemTime>,
}

/// A mesh as it was read.
#[derive(Clone, Debug)]
pub(crate) struct KnownMesh {
    pub(crate) mesh: Arc<MeshFile>,
    /// What was odd about it.
    pub(crate) warnings: Vec<Warning>,
    /// The files that it was read from: its own and those of its materials.
    pub(crate) files: Vec<PathBuf>,
    stamps: Vec<Stamp>,
    /// By the load under way.
    is_used: bool,
}

/// What tells whether a file is as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stamp {
    length: u64,
    changed: SystemTime,
}

impl KnownMesh {
    /// Bytes of all its files.
    pub(crate) fn length(&self) -> u64 {
        self.stamps.iter().map(|stamp| stamp.length).sum()
    }
}

impl Stamp {
    fn of(path: &Path) -> Option<Self> {
        let metadata = path.metadata().ok()?;
        Some(Self { length: metadata.len(), changed: metadata.modified().ok()? })
    }
}

/// The coarsest clock of a file system in use.
const COARSEST_CLOCK: Duration = Duration::from_secs(2);

impl KnownMeshes {
    fn begin(&mut self, scene: &Path) {
        self.saved = Stamp::of(scene).map(|stamp| stamp.changed);
        self.meshes.values_mut().for_each(|mesh| mesh.is_used = false);
    }

    /// The mesh in the file `path`, if all its files are as they were when it was read.
    pub(crate) fn get(&mut self, path: &Path) -> Option<&KnownMesh> {
        let known = self.meshes.get_mut(path)?;
        let as_they_were = |(file, stamp): (&PathBuf, &Stamp)| Stamp::of(file) == Some(*stamp);
        known.is_used = known.files.iter().zip(&known.stamps).all(as_they_were);
        known.is_used.then_some(known)
    }

    /// Keep a mesh that was read from `files` just now.
    pub(crate) fn insert(&mut self, path: PathBuf, mesh: Arc<MeshFile>, files: Vec<PathBuf>, warnings: Vec<Warning>) {
        let stamps: Option<Vec<Stamp>> = files.iter().map(|file| Stamp::of(file)).collect();
        let Some(stamps) = stamps.filter(|stamps| stamps.iter().all(|stamp| self.can_tell(stamp))) else { return };
        self.meshes.insert(path, KnownMesh { mesh, warnings, files, stamps, is_used: true });
    }

    /// Whether a file of this stamp, had it been changed while it was read, would have got another one.
    fn can_tell(&self, stamp: &Stamp) -> bool {
        let latest = stamp.changed.checked_add(COARSEST_CLOCK);
        self.saved.zip(latest).is_some_and(|(saved, latest)| latest < saved)
    }
}
