//! The circular cone and its frustum.

use super::frustum::Frustum;
use super::{Crossings, ShapePoint};
use crate::math::{Aabb, Vec3d};

/// A cone from `base` to `apex` whose radius changes linearly from `base_radius` to `apex_radius`.
///
/// An open cone is a surface with two sides; a capped one is a solid. One without height, or flatter than 2⁻²⁴ of its
/// larger radius, is degenerate (a disc is a [`Disc`](super::Disc)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Middle of one end.
    pub base: Vec3d,
    /// Middle of the other end.
    pub apex: Vec3d,
    /// Radius at `base`, ≥ 0.
    pub base_radius: f64,
    /// Radius at `apex`, ≥ 0; one of the two radii is > 0.
    pub apex_radius: f64,
    /// True if ends of positive radius are closed by discs.
    pub capped: bool,
}

impl Cone {
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
        Frustum::new(self.base, self.apex, self.base_radius, self.apex_radius, self.capped)
    }
}
