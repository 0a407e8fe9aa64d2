//! Perfect splits: the boxes of what two parallel planes leave of a primitive.
//!
//! In the tree's scale and in `f32`: an edge point is off by a few ulp, which the padding of the boxes covers.

use super::Bounds;
use crate::geometry::{Kind, Primitives};

/// A primitive in the form in which it is clipped.
#[derive(Clone, Copy)]
pub(crate) enum Solid {
    Triangle([[f32; 3]; 3]),
    Sphere {
        center: [f32; 3],
        radius: f32,
    },
    /// Known by its box alone.
    Boxed,
}

impl Solid {
    /// Primitive `id` in coordinates multiplied by `scale`.
    #[inline(always)]
    pub(crate) fn new(primitives: &Primitives, id: u32, scale: f32) -> Self {
        match primitives.kind(id) {
            Kind::Triangle(i) => Self::Triangle(primitives.triangle(i).vertices.map(|v| (v * scale).to_array())),
            Kind::Sphere(i) => {
                let sphere = primitives.spheres()[i];
                Self::Sphere { center: (sphere.center * scale).to_array(), radius: sphere.radius * scale }
            }
            Kind::Shape(_) | Kind::Plane(_) => Self::Boxed,
        }
    }

    /// The box of the part that lies in `bounds` and between two planes across `axis`; may be empty.
    #[inline(always)]
    pub(crate) fn slab(&self, bounds: &Bounds, axis: usize, lo: f32, hi: f32) -> Bounds {
        let mut cut = *bounds;
        cut.set_lo(axis, cut.lo(axis).max(lo));
        cut.set_hi(axis, cut.hi(axis).min(hi));
        match self {
            Self::Triangle(vertices) => cut.intersection(triangle_slab(vertices, axis, lo, hi)),
            Self::Sphere { center, radius } => cut.intersection(sphere_slab(*center, *radius, axis, lo, hi)),
            Self::Boxed => cut,
        }
    }
}

/// The box around the parts of the edges between the planes.
fn triangle_slab(vertices: &[[f32; 3]; 3], axis: usize, lo: f32, hi: f32) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    for corner in 0..3 {
        let (from, to) = (vertices[corner], vertices[(corner + 1) % 3]);
        let (start, end) = (from[axis], to[axis]);
        if start.max(end) < lo || start.min(end) > hi {
            continue;
        }
        bounds.include(if start < lo {
            across(from, to, axis, lo)
        } else if start > hi {
            across(from, to, axis, hi)
        } else {
            from
        });
        // An end within the planes is the start of the next edge.
        if end < lo {
            bounds.include(across(from, to, axis, lo));
        } else if end > hi {
            bounds.include(across(from, to, axis, hi));
        }
    }
    bounds
}

/// The point where an edge crosses a plane.
fn across(from: [f32; 3], to: [f32; 3], axis: usize, plane: f32) -> [f32; 3] {
    let share = (plane - from[axis]) / (to[axis] - from[axis]);
    let mut point = [0.0; 3];
    for a in 0..3 {
        point[a] = from[a] + (to[a] - from[a]) * share;
    }
    point[axis] = plane;
    point
}

/// As wide as the widest circle between the planes.
fn sphere_slab(center: [f32; 3], radius: f32, axis: usize, lo: f32, hi: f32) -> Bounds {
    let away = (lo - center[axis]).max(center[axis] - hi).max(0.0);
    let circle = (radius * radius - away * away).max(0.0).sqrt();
    let mut bounds = Bounds::EMPTY;
    bounds.include(center.map(|c| (c - circle).next_down()));
    bounds.include(center.map(|c| (c + circle).next_up()));
    bounds.set_lo(axis, f32::NEG_INFINITY);
    bounds.set_hi(axis, f32::INFINITY);
    bounds
}
