//! The unbounded plane, tested outside the tree.

use super::shape::{perpendicular_frame, point_at};
use super::{Crossings, ShapePoint, SurfacePoint};
use crate::math::Vec3d;
use crate::ray::Ray;

/// An unbounded plane: the points `p` with `normal · (p − point) = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Any point of the plane.
    pub point: Vec3d,
    /// Direction of the front side; need not be normalised.
    pub normal: Vec3d,
}

impl Plane {
    /// Where the infinite line `origin + t · direction` crosses the plane: never or once. A line within the plane or
    /// parallel to it does not.
    pub fn crossings(&self, origin: Vec3d, direction: Vec3d) -> Crossings {
        let mut crossings = Crossings::NONE;
        crossings.insert(self.crossing(origin, direction));
        crossings
    }

    /// The parameter of the crossing; infinite or NaN if there is none.
    pub(super) fn crossing(&self, origin: Vec3d, direction: Vec3d) -> f64 {
        self.normal.dot(self.point - origin) / self.normal.dot(direction)
    }

    /// The point of the plane nearest to `near`; `uv` are coordinates in the plane, in scene units from
    /// [`point`](Self::point).
    pub fn surface(&self, near: Vec3d) -> ShapePoint {
        let normal = self.normal.normalize();
        let offset = near - self.point;
        let uv = perpendicular_frame(normal).map(|axis| axis.dot(offset));
        ShapePoint { position: near - normal * normal.dot(offset), normal, uv }
    }

    /// The surface where `ray` crosses it at `t`.
    pub fn surface_point(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let near = point_at(ray, t);
        self.surface(near).rounded((near - self.point).abs().max_component())
    }

    /// True if the plane has no direction or a number in it is not finite: it is never hit.
    pub fn is_degenerate(&self) -> bool {
        let length = self.normal.length();
        !(self.point.is_finite() && self.normal.is_finite() && length > 0.0 && length.is_finite())
    }
}
