//! Opening files: only where the user allows it and no more than fits.

use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use crate::error::{Error, ErrorKind, Warning};
use crate::mesh::MeshFile;
use crate::reload::KnownMeshes;

/// What a file may do to the machine that loads it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadOptions {
    /// Open files outside the scene's folder if the scene names them. Default: false.
    pub allow_outside: bool,
    /// Give a scene without a camera what it lacks to be seen, and a bare mesh smooth normals. Default: true.
    pub furnish: bool,
    /// Longest file in bytes. Default: 4 GiB.
    pub max_file_bytes: u64,
    /// Sum of the lengths of all files in bytes; a mesh counts as often as it is used. Default: 8 GiB.
    pub max_total_bytes: u64,
    /// Largest picture in pixels that a file may ask for. Default: 2²⁷.
    pub max_pixels: u64,
    /// Most primitives that the generators of one file may make. Default: 10⁷.
    pub max_generated: u64,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            allow_outside: false,
            furnish: true,
            max_file_bytes: 4 << 30,
            max_total_bytes: 8 << 30,
            max_pixels: 1 << 27,
            max_generated: 10_000_000,
        }
    }
}

/// The state of one load: what may be read, what has been, and what was odd.
#[derive(Debug)]
pub(crate) struct Context<'a> {
    pub(crate) options: &'a LoadOptions,
    /// The scene's folder, canonical; none if nothing but the given bytes may be read.
    root: Option<PathBuf>,
    /// All files read, in order.
    pub(crate) files: Vec<PathBuf>,
    bytes_left: u64,
    warnings: Vec<Warning>,
    warnings_left_out: usize,
    /// Meshes that need not be read again.
    known: Option<&'a mut KnownMeshes>,
}

/// Where a mesh began to be read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beginning {
    files: usize,
    warnings: usize,
}

impl<'a> Context<'a> {
    /// A context in which no file can be opened.
    pub(crate) fn closed(options: &'a LoadOptions) -> Self {
        Self {
            options,
            root: None,
            files: Vec::new(),
            bytes_left: options.max_total_bytes,
            warnings: Vec::new(),
            warnings_left_out: 0,
            known: None,
        }
    }

    /// As [`closed`](Self::closed), with meshes that need not be read again.
    pub(crate) fn knowing(options: &'a LoadOptions, known: &'a mut KnownMeshes) -> Self {
        Self { known: Some(known), ..Self::closed(options) }
    }

    /// The mesh in the file `name` that the file `namer` names and the length of its files, if it is known from before.
    pub(crate) fn known_mesh(&mut self, namer: &Path, name: &str) -> Result<Option<(u64, Arc<MeshFile>)>, Error> {
        if self.known.is_none() {
            return Ok(None);
        }
        let path = self.find(folder_of(namer), &portable(name))?;
        let Some(known) = self.known.as_mut().and_then(|known| known.get(&path)).cloned() else { return Ok(None) };
        let length = known.length();
        self.charge(&path, length)?;
        self.files.extend(known.files);
        known.warnings.into_iter().for_each(|warning| self.warn(warning));
        Ok(Some((length, known.mesh)))
    }

    /// Where the reading of a mesh begins.
    pub(crate) fn beginning(&self) -> Beginning {
        Beginning { files: self.files.len(), warnings: self.warnings.len() }
    }

    /// Keep a mesh whose reading began at `from` for the next load.
    pub(crate) fn keep_mesh(&mut self, from: Beginning, mesh: &Arc<MeshFile>) {
        let files = self.files[from.files..].to_vec();
        if let (Some(known), Some(path)) = (&mut self.known, files.first().cloned()) {
            known.insert(path, Arc::clone(mesh), files, self.warnings[from.warnings..].to_vec());
        }
    }

    /// Read the file that the user named, and let it name files in its own folder.
    pub(crate) fn read_first(&mut self, path: &Path) -> Result<Vec<u8>, Error> {
        let bytes = self.read(path, path)?;
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        self.root = Some(folder.canonicalize().map_err(|e| Error::io(folder, "find the folder", &e))?);
        Ok(bytes)
    }

    /// Read the file `name` that the file `namer` names, relative to the folder of `namer`. Gives its path too.
    pub(crate) fn read_named(&mut self, namer: &Path, name: &str) -> Result<(PathBuf, Vec<u8>), Error> {
        let path = self.find(folder_of(namer), &portable(name))?;
        let shown = self.path_named(namer, name);
        let bytes = self.read(&path, &shown)?;
        Ok((shown, bytes))
    }

    /// The path of the file `name` that the file `namer` names, whether it may be read or not.
    pub(crate) fn path_named(&self, namer: &Path, name: &str) -> PathBuf {
        folder_of(namer).join(portable(name))
    }

    /// Count `bytes` that are used once more without being read again.
    pub(crate) fn charge(&mut self, path: &Path, bytes: u64) -> Result<(), Error> {
        match self.bytes_left.checked_sub(bytes) {
            Some(left) => self.bytes_left = left,
            None => {
                let limit = self.options.max_total_bytes;
                let what = format!("all files together are longer than the limit of {limit} bytes");
                return Err(Error::new(ErrorKind::Limit, path, what));
            }
        }
        Ok(())
    }

    /// Where the file `relative` is that a file in `folder` names. Links are followed before the place is checked.
    fn find(&self, folder: &Path, relative: &Path) -> Result<PathBuf, Error> {
        let refuse = |what: &str| Err(Error::new(ErrorKind::Input, relative, what));
        let Some(root) = &self.root else {
            return refuse("a scene that is not loaded from a file cannot name files");
        };
        let outside = "the file lies outside the scene's folder and was not opened";
        // Before the file system is asked anything: a name that climbs out must not even tell whether its file exists.
        if !self.options.allow_outside && escapes(root, folder, relative) {
            return refuse(outside);
        }
        let path = folder.join(relative).canonicalize().map_err(|e| Error::io(relative, "open the file", &e))?;
        if !self.options.allow_outside && !path.starts_with(root) {
            return refuse(outside);
        }
        Ok(path)
    }

    /// Read `path`, called `shown` in messages.
    #[expect(clippy::disallowed_methods, reason = "the one place where files are opened")]
    fn read(&mut self, path: &Path, shown: &Path) -> Result<Vec<u8>, Error> {
        let metadata = path.metadata().map_err(|e| Error::io(shown, "open the file", &e))?;
        if !metadata.is_file() {
            return Err(Error::new(ErrorKind::Io, shown, "not a regular file"));
        }
        let limit = self.options.max_file_bytes;
        let too_long = || Error::new(ErrorKind::Limit, shown, format!("the file is longer than {limit} bytes"));
        if metadata.len() > limit {
            return Err(too_long());
        }
        self.charge(shown, metadata.len())?;
        let file = File::open(path).map_err(|e| Error::io(shown, "open the file", &e))?;
        let mut bytes = Vec::with_capacity(metadata.len() as usize);
        // The file may grow while it is read: the limit holds for what arrives.
        file.take(limit.saturating_add(1))
            .read_to_end(&mut bytes)
            .map_err(|e| Error::io(shown, "read the file", &e))?;
        if bytes.len() as u64 > limit {
            return Err(too_long());
        }
        self.files.push(path.to_owned());
        Ok(bytes)
    }

    /// Keep a warning; after the first hundred they are only counted.
    pub(crate) fn warn(&mut self, warning: Warning) {
        const KEPT: usize = 100;
        match self.warnings.len() < KEPT {
            true => self.warnings.push(warning),
            false => self.warnings_left_out += 1,
        }
    }

    /// All warnings, and how many were left out.
    pub(crate) fn take_warnings(&mut self, file: &Path) -> Vec<Warning> {
        let mut warnings = std::mem::take(&mut self.warnings);
        if self.warnings_left_out > 0 {
            let what = format!("{} more warnings", self.warnings_left_out);
            warnings.push(Error::new(ErrorKind::Input, file, what).into_warning());
        }
        warnings
    }
}

fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

/// A file's name as this system writes it: scenes and material libraries written on Windows use backslashes.
fn portable(name: &str) -> PathBuf {
    PathBuf::from(name.replace('\\', "/"))
}

/// True if `relative`, followed from `folder`, begins elsewhere or climbs above `root` by `..` alone.
fn escapes(root: &Path, folder: &Path, relative: &Path) -> bool {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(folder) = folder.canonicalize() else { return true };
    let Ok(below) = folder.strip_prefix(root) else { return true };
    let mut depth = below.components().count();
    for component in relative.components() {
        match component {
            Component::Normal(_) => depth += 1,
            Component::CurDir => {}
            Component::ParentDir if depth > 0 => depth -= 1,
            Component::ParentDir | Component::RootDir | Component::Prefix(_) => return true,
        }
    }
    false
}
