//! The disc: a flat round plate, possibly with a hole.

use super::shape::{disc_reach, perpendicular_frame, round_outward};
use super::{Crossings, Plane, ShapePoint};
use crate::math::{Aabb, Vec3d};

/// The points of a plane whose distance from `center` lies between `inner_radius` and `radius`, both inclusive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// The middle.
    pub center: Vec3d,
    /// Direction of the front side; need not be normalised.
    pub normal: Vec3d,
    /// Outer radius, > 0.
    pub radius: f64,
    /// Radius of the hole; 0 for none.
    pub inner_radius: f64,
}

impl Disc {
    /// See [`Shape::crossings`](super::Shape::crossings): never or once.
    pub fn crossings(&self, origin: Vec3d, direction: Vec3d) -> Crossings {
        let mut crossings = Crossings::NONE;
        let t = self.plane().crossing(origin, direction);
        let distance_squared = (origin - self.center + direction * t).length_squared();
        let square = |a: f64| a * a;
        if square(self.inner_radius) <= distance_squared && distance_squared <= square(self.radius) {
            crossings.insert(t);
        }
        crossings
    }

    /// See [`Shape::bounds`](super::Shape::bounds).
    pub fn bounds(&self) -> Aabb {
        let reach = disc_reach(self.normal.normalize()) * self.radius;
        round_outward(self.center - reach, self.center + reach)
    }

    /// See [`Shape::surface`](super::Shape::surface). `uv` spans the square around the disc, each from 0 to 1.
    pub fn surface(&self, near: Vec3d) -> ShapePoint {
        let point = self.plane().surface(near);
        let offset = point.position - self.center;
        let uv = perpendicular_frame(point.normal).map(|axis| 0.5 + 0.5 * axis.dot(offset) / self.radius);
        ShapePoint { uv, ..point }
    }

    pub(super) fn has_area(&self) -> bool {
        let hole = 0.0 <= self.inner_radius && self.inner_radius < self.radius;
        hole && self.radius > 0.0 && !self.plane().is_degenerate()
    }

    fn plane(&self) -> Plane {
        Plane { point: self.center, normal: self.normal }
    }
}
