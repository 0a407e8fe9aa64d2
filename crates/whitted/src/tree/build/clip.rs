//! Perfect splits: the boxes of what a plane leaves of a primitive on either side.
//!
//! All in the tree's scale and in `f64`; results are rounded to `f32`, which the padding of the boxes covers.

use super::spatial_split::halves;
use super::{Builder, Reference};
use crate::geometry::{Kind, Sphere, Triangle};
use crate::math::{Aabb, Vec3d};

impl Builder<'_> {
    /// The boxes of the parts of a reference below and above a plane, within the reference's box; may be empty.
    pub(super) fn clip(&self, reference: &Reference, axis: usize, position: f32) -> (Aabb, Aabb) {
        let (left, right) = halves(reference.bounds, axis, position);
        let (below, above) = match self.primitives.kind(reference.primitive) {
            Kind::Triangle(i) => clip_triangle(&self.primitives.triangle(i), self.scale, axis, position),
            Kind::Sphere(i) => clip_sphere(&self.primitives.spheres()[i], self.scale, axis, position),
            Kind::Shape(_) | Kind::Plane(_) => (reference.bounds, reference.bounds),
        };
        (left.intersection(below), right.intersection(above))
    }
}

/// Grows by points of either side.
struct Sides {
    below: Aabb,
    above: Aabb,
}

impl Sides {
    fn add(&mut self, point: Vec3d, is_below: bool, is_above: bool) {
        let point = point.to_f32();
        let point = Aabb::new(point, point);
        if is_below {
            self.below = self.below.union(point);
        }
        if is_above {
            self.above = self.above.union(point);
        }
    }
}

fn clip_triangle(triangle: &Triangle, scale: f32, axis: usize, position: f32) -> (Aabb, Aabb) {
    let mut sides = Sides { below: Aabb::EMPTY, above: Aabb::EMPTY };
    let position = f64::from(position);
    let vertices = triangle.vertices.map(|v| v.to_f64() * f64::from(scale));
    for corner in 0..3 {
        let (from, to) = (vertices[corner], vertices[(corner + 1) % 3]);
        let (start, end) = (from[axis] - position, to[axis] - position);
        sides.add(from, start <= 0.0, start >= 0.0);
        if (start < 0.0 && end > 0.0) || (start > 0.0 && end < 0.0) {
            sides.add(from + (to - from) * (start / (start - end)), true, true);
        }
    }
    (sides.below, sides.above)
}

fn clip_sphere(sphere: &Sphere, scale: f32, axis: usize, position: f32) -> (Aabb, Aabb) {
    let center = sphere.center * scale;
    let radius = sphere.radius * scale;
    let whole = Aabb::new(center, center).grown(radius);
    let offset = f64::from(position) - f64::from(center[axis]);
    let radius = f64::from(radius);
    // A side that holds the centre is as wide as the sphere; the other one as the circle in the plane.
    let circle = (radius * radius - offset * offset).max(0.0).sqrt() as f32;
    let narrow = Aabb::new(center, center).grown(circle);
    let narrow = |bounds: Aabb| {
        let pick = |wide: f32, narrow: f32, a: usize| if a == axis { wide } else { narrow };
        let corner = |w: crate::math::Vec3f, n: crate::math::Vec3f| [0, 1, 2].map(|a| pick(w[a], n[a], a)).into();
        Aabb::new(corner(bounds.lo, narrow.lo), corner(bounds.hi, narrow.hi))
    };
    if offset >= 0.0 { (whole, narrow(whole)) } else { (narrow(whole), whole) }
}
