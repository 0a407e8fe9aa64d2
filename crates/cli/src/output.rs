//! Where results go: checked before work begins, complete under their final name or not there at all.

use crate::exit::Failure;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A checked destination.
#[derive(Clone, Debug)]
pub(crate) struct Target {
    place: Place,
    /// As the user named it.
    name: String,
}

#[derive(Clone, Debug, PartialEq)]
enum Place {
    Stdout,
    /// A regular file, which need not exist yet, in a folder that does.
    File(PathBuf),
    /// Something that can only be written into as it is: a pipe or a device.
    Special(PathBuf),
}

impl Target {
    /// Checks that `path` (`-` for standard output) can be written, without leaving a trace.
    pub(crate) fn check(path: &Path) -> Result<Self, Failure> {
        if path == Path::new("-") {
            return Ok(Self { place: Place::Stdout, name: "standard output".to_owned() });
        }
        let name = format!("'{}'", path.display());
        match Place::check(path) {
            Ok(place) => Ok(Self { place, name }),
            Err(reason) => Err(Failure::Io(format!("cannot write {name}: {reason}"))),
        }
    }

    /// Whether both lead to the same place.
    pub(crate) fn is_same_as(&self, other: &Self) -> bool {
        self.place == other.place
    }

    /// True for standard output.
    pub(crate) fn is_stdout(&self) -> bool {
        self.place == Place::Stdout
    }

    /// True for a regular file, whose beginning can be written last.
    pub(crate) fn is_file(&self) -> bool {
        matches!(self.place, Place::File(_))
    }

    /// Opens it for writing piece by piece: a file appears under its name only when it is finished.
    pub(crate) fn open(&self) -> Result<Sink, Failure> {
        let opened = match &self.place {
            Place::Stdout => Ok((Stream::Stdout(io::stdout()), None)),
            Place::Special(path) => File::options().write(true).open(path).map(|file| (Stream::File(file), None)),
            Place::File(path) => {
                let temporary = temporary_beside(path);
                let file = File::create_new(&temporary);
                file.map(|file| (Stream::File(file), Some(Unfinished { temporary, path: path.clone() })))
            }
        };
        let (stream, unfinished) = opened.map_err(|error| self.refused(&error))?;
        Ok(Sink { target: self.clone(), stream, unfinished })
    }

    fn refused(&self, error: &io::Error) -> Failure {
        Failure::Io(format!("cannot write {self}: {error}"))
    }

    /// Writes everything: a file appears under its name only when whole and on disk.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        let written = match &self.place {
            Place::Stdout => write_all(io::stdout().lock(), bytes),
            Place::Special(path) => File::options().write(true).open(path).and_then(|file| write_all(file, bytes)),
            Place::File(path) => replace(path, bytes),
        };
        written.map_err(|error| self.refused(&error))
    }
}

/// A destination that is being written. Dropped before it is finished, it leaves no file.
pub(crate) struct Sink {
    target: Target,
    stream: Stream,
    unfinished: Option<Unfinished>,
}

enum Stream {
    Stdout(io::Stdout),
    File(File),
}

/// A file under a temporary name; removed when dropped.
struct Unfinished {
    temporary: PathBuf,
    path: PathBuf,
}

impl Sink {
    /// Appends bytes.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let written = match &mut self.stream {
            Stream::Stdout(stdout) => write_all(stdout, bytes),
            Stream::File(file) => file.write_all(bytes),
        };
        written.map_err(|error| self.target.refused(&error))
    }

    /// Replaces the first bytes; only for a [file](Target::is_file).
    pub(crate) fn rewrite_start(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let Stream::File(file) = &mut self.stream else { return Ok(()) };
        let written = file.seek(SeekFrom::Start(0)).and_then(|_| file.write_all(bytes));
        written.map_err(|error| self.target.refused(&error))
    }

    /// Brings a file to disk and under its name.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let (Stream::File(file), Some(unfinished)) = (&self.stream, &self.unfinished) else { return Ok(()) };
        let finished = file.sync_all().and_then(|()| fs::rename(&unfinished.temporary, &unfinished.path));
        finished.map_err(|error| self.target.refused(&error))
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        // After it was renamed there is nothing to remove; else the error that ended the work is the one to report.
        let _ = fs::remove_file(&self.temporary);
    }
}

impl Place {
    /// What `path` names, or why it cannot be written.
    fn check(path: &Path) -> Result<Self, String> {
        let path = resolved(path);
        match fs::metadata(&path) {
            Ok(found) if found.is_dir() => return Err("it is a folder".to_owned()),
            Ok(found) if !found.is_file() => return Ok(Self::Special(path)),
            Ok(found) if found.permissions().readonly() => return Err("it is read-only".to_owned()),
            _ => {}
        }
        let folder = folder_of(&path);
        if !folder.is_dir() {
            return Err(format!("there is no folder '{}'", folder.display()));
        }
        let temporary = temporary_beside(&path);
        File::create_new(&temporary).and_then(|_| fs::remove_file(&temporary)).map_err(|error| error.to_string())?;
        Ok(Self::File(path))
    }
}

impl std::fmt::Display for Target {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.name)
    }
}

fn write_all(mut writer: impl Write, bytes: &[u8]) -> io::Result<()> {
    writer.write_all(bytes)?;
    writer.flush()
}

/// Writes a temporary file in the same folder (renaming works only inside one file system), then renames it.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let temporary = temporary_beside(path);
    let result = File::create_new(&temporary)
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .and_then(|()| fs::rename(&temporary, path));
    if result.is_err() {
        // The first error is the one to report; a file that was never made cannot be removed.
        let _ = fs::remove_file(&temporary);
    }
    result
}

/// The path without links, so that a link's target is replaced and not the link, and one file has one name.
fn resolved(path: &Path) -> PathBuf {
    let in_folder = || Ok(fs::canonicalize(folder_of(path))?.join(path.file_name().unwrap_or_default()));
    fs::canonicalize(path).or_else(|_: io::Error| in_folder()).unwrap_or_else(|_: io::Error| path.to_owned())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A hidden name that no other running process uses.
fn temporary_beside(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.tmp", std::process::id()));
    path.with_file_name(name)
}
