//! The circular cylinder.

use super::frustum::Frustum;
use super::{Crossings, ShapePoint};
use crate::math::{Aabb, Vec3d};

/// A round tube from `base` to `apex`.
///
/// An open tube is a surface with two sides; a capped one is a solid. One without height, or flatter than 2⁻²⁴ of its
/// radius, is degenerate (a disc is a [`Disc`](super::Disc)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Middle of one end.
    pub base: Vec3d,
    /// Middle of the other end.
    pub apex: Vec3d,
    /// Radius, > 0.
    pub radius: f64,
    /// True if both ends are closed by discs.
    pub capped: bool,
}

impl Cylinder {
    /// See [`Shape::crossings`](super::Shape::crossings): at most twice. A line within the side does not cross it.
    pub fn crossings(&self, origin: Vec3d, direction: Vec3d) -> Crossings {
        self.frustum().crossings(origin, direction)
    }

    /// See [`Shape::bounds`](super::Shape::bounds).
    pub fn bounds(&self) -> Aabb {
        self.frustum().bounds()
    }

    /// See [`Shape::surface`](super::Shape::surface). `uv` of the side: angle about the axis and height; of an end: the
    /// square around it; each from 0 to 1.
    pub fn surface(&self, near: Vec3d) -> ShapePoint {
        self.frustum().surface(near)
    }

    pub(super) fn has_area(&self) -> bool {
        self.frustum().has_area()
    }

    fn frustum(&self) -> Frustum {
        Frustum::new(self.base, self.apex, self.radius, self.radius, self.capped)
    }
}
