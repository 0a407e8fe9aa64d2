//! Building a scene for queries.

use super::RayScene;
use super::scene::Part;
use crate::geometry::{MeshError, Primitives, Sphere};
use crate::math::Vec3f;
use crate::tree::{BuildOptions, Tree, TreeKind};

/// Why a scene could not be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RaySceneError {
    /// A mesh is wrong.
    #[error("geometry {geometry}: {error}")]
    Mesh {
        /// The geometry, in the order in which they were added.
        geometry: usize,
        /// What is wrong with it.
        error: MeshError,
    },
}

/// Collects the geometries of a [`RayScene`].
///
/// Each call of [`mesh`](Self::mesh) and [`spheres`](Self::spheres) adds one geometry, numbered from 0.
#[derive(Clone, Debug, Default)]
pub struct RaySceneBuilder {
    primitives: Primitives,
    meshes: Vec<Part>,
    spheres: Vec<Part>,
    options: BuildOptions,
    error: Option<RaySceneError>,
}

impl RayScene {
    /// A scene of any primitives, all of them geometry 0; planes and other shapes included.
    pub fn from_primitives(primitives: Primitives, options: &BuildOptions) -> Self {
        let vertices = 0..primitives.vertices().len();
        let part = Part { geometry: 0, start: 0, is_mesh: true, items: vertices, mask: u32::MAX };
        let tree = Tree::build(&primitives, options);
        Self { primitives, tree, options: *options, parts: vec![part], level: simd::Level::best() }
    }
}

impl RaySceneBuilder {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Add a mesh: positions of vertices, and for each triangle the numbers of its vertices.
    ///
    /// A triangle with a vertex that is not there is an error of [`build`](Self::build). One with equal or non-finite
    /// vertices is never hit.
    pub fn mesh(mut self, positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Self {
        let geometry = self.geometries();
        let start = self.primitives.triangle_count() as u32;
        let first_vertex = self.primitives.vertices().len();
        let positions: Vec<Vec3f> = positions.iter().map(|&position| position.into()).collect();
        if let Err(error) = self.primitives.push_mesh(&positions, triangles, &[], &[]) {
            self.error.get_or_insert(RaySceneError::Mesh { geometry, error });
        }
        let items = first_vertex..self.primitives.vertices().len();
        self.meshes.push(Part { geometry, start, is_mesh: true, items, mask: u32::MAX });
        self
    }

    /// Add spheres: centres and radii. One with a radius that is not positive and finite is never hit.
    pub fn spheres(mut self, spheres: &[([f32; 3], f32)]) -> Self {
        let geometry = self.geometries();
        let start = self.primitives.spheres().len() as u32;
        let too_many = self.primitives.len() + spheres.len() > i32::MAX as usize;
        if too_many {
            self.error.get_or_insert(RaySceneError::Mesh { geometry, error: MeshError::TooMany });
        } else {
            for &(center, radius) in spheres {
                self.primitives.push_sphere(Sphere { center: center.into(), radius });
            }
        }
        let items = start as usize..self.primitives.spheres().len();
        self.spheres.push(Part { geometry, start, is_mesh: false, items, mask: u32::MAX });
        self
    }

    /// Choose the tree: [`TreeKind::Best`] (default) answers fastest, [`TreeKind::Fast`] is built fastest and can follow
    /// geometries that move, [`TreeKind::None`] asks every primitive.
    pub fn tree(mut self, kind: TreeKind) -> Self {
        self.options.kind = kind;
        self
    }

    /// Build the tree, by the threads of the current rayon pool.
    ///
    /// # Errors
    /// The first of the geometries that is wrong.
    pub fn build(self) -> Result<RayScene, RaySceneError> {
        if let Some(error) = self.error {
            return Err(error);
        }
        let mut parts = self.meshes;
        // Spheres are numbered after all triangles.
        let triangles = self.primitives.triangle_count() as u32;
        parts.extend(self.spheres.into_iter().map(|part| Part { start: triangles + part.start, ..part }));
        let tree = Tree::build(&self.primitives, &self.options);
        Ok(RayScene { primitives: self.primitives, tree, options: self.options, parts, level: simd::Level::best() })
    }

    fn geometries(&self) -> usize {
        self.meshes.len() + self.spheres.len()
    }
}
