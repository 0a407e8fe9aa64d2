//! Scenes that move: new places for the same triangles and spheres.

use super::RayScene;
use crate::tree::{RefitError, Tree};
use std::ops::Range;

/// Why a geometry could not be moved; then nothing has changed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MoveError {
    /// There is no such mesh, or no such spheres.
    #[error("there is no geometry {geometry} of {kind}")]
    Geometry {
        /// What was named.
        geometry: usize,
        /// What it should have been: vertices or spheres.
        kind: &'static str,
    },
    /// A geometry keeps its number of vertices or spheres.
    #[error("geometry {geometry} has {expected} {kind}, not {found}")]
    Count {
        /// The geometry.
        geometry: usize,
        /// What was counted: vertices or spheres.
        kind: &'static str,
        /// How many there are.
        expected: usize,
        /// How many were given.
        found: usize,
    },
}

impl RayScene {
    /// Give the vertices of a mesh new positions. Call [`refit`](Self::refit) or [`rebuild`](Self::rebuild) when all
    /// geometries are where they shall be: until then queries answer by a mixture of old and new.
    ///
    /// ```
    /// use whitted::query::RayScene;
    /// use whitted::ray::Ray;
    /// use whitted::tree::TreeKind;
    ///
    /// let mut corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let mut scene = RayScene::builder().mesh(&corners, &[[0, 1, 2]]).tree(TreeKind::Fast).build()?;
    /// for frame in 0..3 {
    ///     corners.iter_mut().for_each(|corner| corner[2] = frame as f32);
    ///     scene.set_positions(0, &corners)?;
    ///     scene.refit()?;
    ///     let hit = scene.closest_hit(&Ray::new([0.0, 0.0, 5.0], [0.0, 0.0, -1.0])).unwrap();
    ///     assert_eq!(hit.t, 5.0 - frame as f32);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If `geometry` is not a mesh of so many vertices.
    pub fn set_positions(&mut self, geometry: usize, positions: &[[f32; 3]]) -> Result<(), MoveError> {
        let kind = "vertices";
        let range = self.items(geometry, true, kind, positions.len())?;
        self.primitives.vertices_mut()[range].copy_from_slice(positions);
        Ok(())
    }

    /// Give the spheres of a geometry new centres and radii; as [`set_positions`](Self::set_positions).
    ///
    /// # Errors
    /// If `geometry` is not one of so many spheres.
    pub fn set_spheres(&mut self, geometry: usize, spheres: &[([f32; 3], f32)]) -> Result<(), MoveError> {
        let kind = "spheres";
        let range = self.items(geometry, false, kind, spheres.len())?;
        for (sphere, &(center, radius)) in self.primitives.spheres_mut()[range].iter_mut().zip(spheres) {
            (sphere.center, sphere.radius) = (center.into(), radius);
        }
        Ok(())
    }

    /// Fit the tree to where the geometries are now: many times faster than to build it anew, and as right. The farther
    /// primitives have moved apart that were neighbours, the slower are the answers; after large changes
    /// [`rebuild`](Self::rebuild) pays.
    ///
    /// # Errors
    /// If the tree was not built as [`TreeKind::Fast`](crate::tree::TreeKind::Fast), or lacks a primitive that was
    /// degenerate when it was built: then [`rebuild`](Self::rebuild).
    pub fn refit(&mut self) -> Result<(), RefitError> {
        self.tree.refit(&self.primitives)
    }

    /// Build the tree anew where the geometries are now, by the threads of the current rayon pool.
    pub fn rebuild(&mut self) {
        self.tree = Tree::build(&self.primitives, &self.options);
    }

    /// The vertices or spheres of a geometry, which must be `found` many.
    fn items(
        &self,
        geometry: usize,
        is_mesh: bool,
        kind: &'static str,
        found: usize,
    ) -> Result<Range<usize>, MoveError> {
        let part = self.parts.iter().find(|part| part.geometry == geometry && part.is_mesh == is_mesh);
        let items = part.ok_or(MoveError::Geometry { geometry, kind })?.items.clone();
        match items.len() == found {
            true => Ok(items),
            false => Err(MoveError::Count { geometry, kind, expected: items.len(), found }),
        }
    }
}
