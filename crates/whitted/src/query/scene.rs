//! The scene: what it holds, and whose a primitive is.

use super::{RaySceneBuilder, RaySceneError};
use crate::geometry::{Primitives, SurfacePoint};
use crate::math::Aabb;
use crate::ray::{Hit, Ray, Rays, Row};
use crate::tree::policy::{self, Choice, RaySort};
use crate::tree::{BuildOptions, Query, Tree, WalkKind};
use simd::Level;
use std::ops::Range;

/// Triangles and spheres that can be asked what rays hit: see the [module](super).
///
/// Primitives are numbered: first all triangles, then all spheres, each in the order in which they were added. A scene of
/// one mesh thus reports its triangles by their own numbers; [`locate`](Self::locate) splits a number into geometry and
/// number within it.
///
/// It can be shared by any number of threads (`Send + Sync`); only what moves it or changes masks needs it alone.
#[derive(Clone, Debug)]
pub struct RayScene {
    pub(super) primitives: Primitives,
    pub(super) tree: Tree,
    pub(super) options: BuildOptions,
    /// The geometries, by the numbers of their primitives.
    pub(super) parts: Vec<Part>,
    pub(super) level: Level,
}

/// A geometry: a range of primitives.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Its number in the order of adding.
    pub geometry: usize,
    /// Number of its first primitive.
    pub start: u32,
    /// True for triangles, false for spheres.
    pub is_mesh: bool,
    /// Its vertices or spheres among those of the scene.
    pub items: Range<usize>,
    /// A ray must have one of these bits to see it.
    pub mask: u32,
}

impl RayScene {
    /// Collect geometries for a scene.
    pub fn builder() -> RaySceneBuilder {
        RaySceneBuilder::new()
    }

    /// A scene of one mesh: positions of vertices, and for each triangle the numbers of its vertices.
    ///
    /// # Errors
    /// If a triangle names a vertex that is not there; the error says which.
    pub fn from_mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Self, RaySceneError> {
        Self::builder().mesh(positions, triangles).build()
    }

    /// Number of primitives, degenerate ones included.
    pub fn len(&self) -> usize {
        self.primitives.len()
    }

    /// True if there are no primitives.
    pub fn is_empty(&self) -> bool {
        self.primitives.is_empty()
    }

    /// Primitives that can never be hit: a triangle with equal or non-finite vertices, a sphere without a positive,
    /// finite radius. As it was when the tree was built.
    pub fn dropped(&self) -> usize {
        self.tree.report().dropped
    }

    /// The box around everything that can be hit; empty if that is nothing.
    pub fn bounds(&self) -> Aabb {
        self.primitives.bounds()
    }

    /// Bytes that the scene occupies: a copy of the vertices, indices and spheres, and the tree. Each thread that asks
    /// keeps about 1 MiB for itself beside.
    pub fn memory_bytes(&self) -> usize {
        self.primitives.bytes() + self.tree.report().bytes
    }

    /// The geometry of a primitive, and its number among the primitives of that geometry.
    ///
    /// # Panics
    /// If there is no such primitive.
    pub fn locate(&self, primitive: u32) -> (usize, u32) {
        assert!((primitive as usize) < self.len(), "primitive {primitive} of {}", self.len());
        let part = self.part_of(primitive);
        (part.geometry, primitive - part.start)
    }

    /// Let only rays see a geometry whose masks share a bit with `mask`; until then it is seen by all with any bit.
    ///
    /// ```
    /// use whitted::query::RayScene;
    /// use whitted::ray::Ray;
    ///
    /// let glass = [([0.0, 0.0, 0.0], 2.0)];
    /// let stone = [([0.0, 0.0, 0.0], 1.0)];
    /// let mut scene = RayScene::builder().spheres(&glass).spheres(&stone).build()?;
    /// scene.set_mask(0, 0b01);
    /// scene.set_mask(1, 0b10);
    /// let ray = Ray::new([0.0, 0.0, 5.0], [0.0, 0.0, -1.0]);
    /// assert_eq!(scene.closest_hit(&ray).unwrap().t, 3.0);
    /// assert_eq!(scene.closest_hit(ray.with_mask(0b10)).unwrap().t, 4.0);
    /// assert!(scene.closest_hit(ray.with_mask(0b100)).is_none());
    /// # Ok::<(), whitted::query::RaySceneError>(())
    /// ```
    ///
    /// # Panics
    /// If there is no such geometry.
    pub fn set_mask(&mut self, geometry: usize, mask: u32) {
        self.part_mut(geometry).mask = mask;
    }

    /// The geometric unit normal where `ray` has `hit`: out of a sphere, by the right-hand rule of a triangle's vertices
    /// in their order. It may point along the ray: then the surface is hit from behind.
    ///
    /// # Panics
    /// If `hit` is a miss, or not from this scene.
    pub fn normal(&self, ray: &Ray, hit: &Hit) -> [f32; 3] {
        self.surface_point(ray, hit).n_g.to_array()
    }

    /// The surface where `ray` has `hit`: its place more exactly than `ray.at(hit.t)` can tell, its normal, and a bound
    /// on its error.
    ///
    /// # Panics
    /// If `hit` is a miss, or not from this scene.
    pub fn surface_point(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        self.primitives.surface_point(ray, hit)
    }

    /// How rays of a sort are walked, and why.
    pub fn choice(&self, rays: &RaySort) -> Choice {
        policy::choose(WalkKind::Auto, &self.tree, &self.primitives, rays)
    }

    #[inline]
    pub(super) fn query(&self, walk: WalkKind) -> Query<'_> {
        Query { tree: &self.tree, primitives: &self.primitives, level: self.level, walk }
    }

    /// Whether every one of `rays` sees everything.
    pub(super) fn all_seen(&self, rays: &Rays<'_>) -> bool {
        rays.mask == Row::All(u32::MAX) && self.all_seen_by_all()
    }

    /// Whether a ray with every bit in its mask sees everything.
    #[inline]
    pub(super) fn all_seen_by_all(&self) -> bool {
        self.parts.iter().all(|part| part.mask != 0)
    }

    /// Whether a ray with `mask` sees a primitive.
    pub(super) fn sees(&self, mask: u32, primitive: u32) -> bool {
        self.part_of(primitive).mask & mask != 0
    }

    fn part_of(&self, primitive: u32) -> &Part {
        // Empty geometries begin where the next one does: the last of them has the primitive.
        &self.parts[self.parts.partition_point(|part| part.start <= primitive) - 1]
    }

    pub(super) fn part_mut(&mut self, geometry: usize) -> &mut Part {
        let count = self.parts.len();
        let part = self.parts.iter_mut().find(|part| part.geometry == geometry);
        part.unwrap_or_else(|| panic!("geometry {geometry} of {count}"))
    }
}
