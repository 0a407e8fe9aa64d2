//! Rays in and hits out, as tables of any length: read and written piece by piece.
//!
//! | format | extension | rays | hits |
//! | --- | --- | --- | --- |
//! | CSV | `.csv` | a line that names the columns `ox,oy,oz,dx,dy,dz[,t_min,t_max]`, in any order, and a line for each ray | columns `t,primitive,u,v,nx,ny,nz`; for a miss `inf` and empty fields |
//! | NPY | `.npy` | NumPy array of shape (n, 6) or (n, 8), `float32` or `float64` | NumPy structured array with these fields; for a miss t = ∞, primitive = −1, the rest 0 |
//! | raw | `.f32` | six little-endian `f32` for each ray | the records of the NPY array: 28 bytes, primitive as `i32`, the rest `f32` |
//! | raw | `.f32x8` | eight: with `t_min`, `t_max` | |

mod binary;
mod csv;
mod hits;
mod npy;

use crate::error::{Error, ErrorKind, Warning, quoted};
use std::io::{BufRead, Read};
use std::path::{Path, PathBuf};
use whitted::ray::RayBatch;

pub use hits::HitFormat;

/// How rays are written down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayFormat {
    /// Comma-separated values with a line that names the columns.
    Csv,
    /// NumPy's array format.
    Npy,
    /// Six `f32` for each ray.
    F32,
    /// Eight `f32` for each ray.
    F32x8,
}

impl RayFormat {
    /// All formats with their names, which are also their extensions.
    pub const ALL: [(&'static str, Self); 4] =
        [("csv", Self::Csv), ("npy", Self::Npy), ("f32", Self::F32), ("f32x8", Self::F32x8)];

    /// The format of the file `path` by its extension, in any case of letters.
    ///
    /// # Errors
    /// If it is none of those known.
    pub fn of(path: &Path) -> Result<Self, Error> {
        by_extension(path, &Self::ALL)
    }
}

/// The entry of `known` for the extension of `path`.
fn by_extension<T: Copy>(path: &Path, known: &[(&str, T)]) -> Result<T, Error> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let found = known.iter().find(|(name, _)| *name == extension);
    found.map(|(_, format)| *format).ok_or_else(|| {
        let what = match extension.as_str() {
            "" => "the file has no extension that tells its format".to_owned(),
            other => format!("the format {} is not supported", quoted(format!(".{other}"))),
        };
        let names: Vec<String> = known.iter().map(|(name, _)| format!(".{name}")).collect();
        Error::new(ErrorKind::Unsupported, path, what).hint(format!("known here: {}", names.join(", ")))
    })
}

/// Reads rays piece by piece.
#[derive(Debug)]
pub struct RayReader<R> {
    input: R,
    /// The name for messages.
    file: PathBuf,
    body: Body,
    warnings: Vec<Warning>,
}

/// What is to be read next.
#[derive(Debug)]
enum Body {
    Csv(csv::Table),
    Binary(binary::Records),
}

impl<R: BufRead> RayReader<R> {
    /// Read the head of `input`; `file` is its name for messages.
    ///
    /// # Errors
    /// If the head is wrong or cannot be read.
    pub fn new(format: RayFormat, file: &Path, mut input: R) -> Result<Self, Error> {
        let mut warnings = Vec::new();
        let body = match format {
            RayFormat::Csv => Body::Csv(csv::Table::begin(file, &mut input, &mut warnings)?),
            RayFormat::Npy => Body::Binary(npy::begin(file, &mut input)?),
            RayFormat::F32 => Body::Binary(binary::Records::endless(6)),
            RayFormat::F32x8 => Body::Binary(binary::Records::endless(8)),
        };
        Ok(Self { input, file: file.to_owned(), body, warnings })
    }

    /// The number of rays, if the head tells it.
    pub fn total(&self) -> Option<u64> {
        match &self.body {
            Body::Csv(_) => None,
            Body::Binary(records) => records.total(),
        }
    }

    /// What was odd about the head.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Replace `rays` by the next ones, `max` at most; none at the end.
    ///
    /// # Errors
    /// If they are wrong or cannot be read; `rays` then holds those before.
    pub fn read(&mut self, rays: &mut RayBatch, max: usize) -> Result<(), Error> {
        rays.clear();
        match &mut self.body {
            Body::Csv(table) => table.read(&self.file, &mut self.input, rays, max),
            Body::Binary(records) => records.read(&self.file, &mut self.input, rays, max),
        }
    }
}

/// Fill `bytes` as far as the input reaches; return how far.
fn fill(file: &Path, input: &mut impl Read, bytes: &mut [u8]) -> Result<usize, Error> {
    let mut len = 0;
    while len < bytes.len() {
        match input.read(&mut bytes[len..]) {
            Ok(0) => break,
            Ok(more) => len += more,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(Error::io(file, "read the rays", &error)),
        }
    }
    Ok(len)
}
