//! Hits as tables.

use super::{by_extension, npy};
use crate::error::Error;
use std::io::Write;
use std::path::Path;
use whitted::ray::{Hit, HitBatch};

/// How hits are written down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitFormat {
    /// Comma-separated values with a line that names the columns.
    Csv,
    /// NumPy's array format.
    Npy,
    /// The records of the NumPy array alone.
    F32,
}

/// NumPy's description of a record.
const DESCRIPTION: &str =
    "[('t', '<f4'), ('primitive', '<i4'), ('u', '<f4'), ('v', '<f4'), ('nx', '<f4'), ('ny', '<f4'), ('nz', '<f4')]";

/// Stands for the primitive of a miss in records.
const MISS: i32 = -1;

impl HitFormat {
    /// All formats with their names, which are also their extensions.
    pub const ALL: [(&'static str, Self); 3] = [("csv", Self::Csv), ("npy", Self::Npy), ("f32", Self::F32)];

    /// The format of the file `path` by its extension, in any case of letters.
    ///
    /// # Errors
    /// If it is none of those known.
    pub fn of(path: &Path) -> Result<Self, Error> {
        by_extension(path, &Self::ALL)
    }

    /// True if the head tells how many hits follow.
    pub fn announces_count(self) -> bool {
        self == Self::Npy
    }

    /// What stands before the hits, of which there will be `count`; its length does not depend on `count`.
    pub fn head(self, count: u64) -> Vec<u8> {
        match self {
            Self::Csv => b"t,primitive,u,v,nx,ny,nz\n".to_vec(),
            Self::Npy => npy::head(DESCRIPTION, count),
            Self::F32 => Vec::new(),
        }
    }

    /// Append hits with their geometric normals to `out`.
    ///
    /// # Panics
    /// If a row of `normals` is shorter than `hits`.
    pub fn append(self, hits: &HitBatch, normals: &[Vec<f32>; 3], out: &mut Vec<u8>) {
        for index in 0..hits.len() {
            let normal = [0, 1, 2].map(|axis| normals[axis][index]);
            match self {
                Self::Csv => append_line(&hits.get(index), normal, out),
                Self::Npy | Self::F32 => append_record(&hits.get(index), normal, out),
            }
        }
    }
}

/// The shortest numbers that are read back as they were.
fn append_line(hit: &Hit, [nx, ny, nz]: [f32; 3], out: &mut Vec<u8>) {
    let Hit { t, u, v, primitive, .. } = hit;
    let written = match hit.is_hit() {
        true => writeln!(out, "{t:?},{primitive},{u:?},{v:?},{nx:?},{ny:?},{nz:?}"),
        false => writeln!(out, "inf,,,,,,"),
    };
    written.expect("memory takes all bytes");
}

fn append_record(hit: &Hit, normal: [f32; 3], out: &mut Vec<u8>) {
    // Primitives are numbered below 2³¹.
    let primitive = if hit.is_hit() { hit.primitive as i32 } else { MISS };
    out.extend(hit.t.to_le_bytes());
    out.extend(primitive.to_le_bytes());
    for number in [hit.u, hit.v].into_iter().chain(normal) {
        out.extend(number.to_le_bytes());
    }
}
