//! From OBJ's separate indices of positions, texture coordinates and normals to vertices that have all three.

use std::collections::HashMap;

use whitted::scene::Mesh;

use crate::error::{Error, quoted};
use crate::source::{Source, lossy};

/// No index.
pub(super) const NONE: u32 = u32::MAX;

/// What a corner of a face refers to, counted from 0; [`NONE`] for what it lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    position: u32,
    uv: u32,
    normal: u32,
}

impl Corner {
    pub(super) fn new(position: u32, uv: Option<u32>, normal: Option<u32>) -> Self {
        Self { position, uv: uv.unwrap_or(NONE), normal: normal.unwrap_or(NONE) }
    }
}

/// The largest index used: indices may refer to what is defined later, so they are checked at the end.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct IndexRange<'a> {
    /// One more than the largest index from 0, and the word that gave it.
    end: usize,
    word: &'a [u8],
}

impl<'a> IndexRange<'a> {
    /// The index `word` from 0, where `defined` things are defined so far: `word` counts from 1 on, or backwards from −1.
    /// [`NONE`], for which [`check`](Self::check) will answer, if it is 0 or before the first.
    pub(super) fn resolve(&mut self, source: &Source<'a>, word: &'a [u8], defined: usize) -> Result<u32, Error> {
        let number = std::str::from_utf8(word).ok().and_then(|w| w.parse::<i64>().ok());
        let number = number.ok_or_else(|| source.error_at(word, format!("{} is no index", quoted(word))))?;
        let from = if number < 0 { defined as i64 } else { -1 };
        let index = u32::try_from(number.saturating_add(from)).unwrap_or(NONE);
        if index as usize >= self.end {
            (self.end, self.word) = (index as usize + 1, word);
        }
        Ok(index)
    }

    /// Refuse indices past the `defined` things of the whole file.
    pub(super) fn check(&self, source: &Source<'a>, what: &str, defined: usize) -> Result<(), Error> {
        if self.end <= defined {
            return Ok(());
        }
        let word = self.word;
        let error = source.error_at(word, format!("{what} {} does not exist: there are {defined}", lossy(word)));
        Err(if word == b"0" { error.hint("indices start at 1") } else { error })
    }
}

/// All faces of a file.
#[derive(Debug)]
pub(super) struct Faces {
    corners: Vec<Corner>,
    /// Where each face ends in `corners`, and its material.
    ends: Vec<(usize, u32)>,
    /// The material of the faces to come.
    pub(super) material: u32,
}

impl Default for Faces {
    fn default() -> Self {
        Self { corners: Vec::new(), ends: Vec::new(), material: NONE }
    }
}

impl Faces {
    /// Number of corners so far.
    pub(super) fn corners(&self) -> usize {
        self.corners.len()
    }

    pub(super) fn add_corner(&mut self, corner: Corner) {
        self.corners.push(corner);
    }

    pub(super) fn end_face(&mut self) {
        self.ends.push((self.corners.len(), self.material));
    }

    /// The mesh; all positions must exist. A vertex without a normal in a mesh with normals gets a zero one.
    pub(super) fn build(&self, positions: Vec<[f32; 3]>, uvs: &[[f32; 2]], normals: &[[f32; 3]]) -> Mesh {
        let mut mesh = Mesh::default();
        if self.corners.iter().all(|c| c.uv == NONE && c.normal == NONE) {
            mesh.positions = positions;
            self.cut_fans(&mut mesh, |_, corner| corner.position);
            return mesh;
        }
        let has_uvs = self.corners.iter().any(|c| uvs.get(c.uv as usize).is_some());
        let has_normals = self.corners.iter().any(|c| normals.get(c.normal as usize).is_some());
        let mut vertices: HashMap<Corner, u32> = HashMap::new();
        self.cut_fans(&mut mesh, |mesh, corner| {
            *vertices.entry(corner).or_insert_with(|| {
                mesh.positions.push(positions[corner.position as usize]);
                if has_uvs {
                    mesh.uvs.push(uvs.get(corner.uv as usize).copied().unwrap_or_default());
                }
                if has_normals {
                    mesh.normals.push(normals.get(corner.normal as usize).copied().unwrap_or_default());
                }
                mesh.positions.len() as u32 - 1
            })
        });
        mesh
    }

    /// Add all faces as fans from their first corner, with `vertex` giving the vertex of a corner.
    fn cut_fans(&self, mesh: &mut Mesh, mut vertex: impl FnMut(&mut Mesh, Corner) -> u32) {
        let has_materials = self.ends.iter().any(|(_, material)| *material != NONE);
        mesh.triangles.reserve_exact(self.corners.len() - 2 * self.ends.len());
        let mut start = 0;
        for &(end, material) in &self.ends {
            let first = vertex(mesh, self.corners[start]);
            let mut previous = vertex(mesh, self.corners[start + 1]);
            for &corner in &self.corners[start + 2..end] {
                let next = vertex(mesh, corner);
                mesh.triangles.push([first, previous, next]);
                if has_materials {
                    mesh.triangle_materials.push(material);
                }
                previous = next;
            }
            start = end;
        }
    }
}
