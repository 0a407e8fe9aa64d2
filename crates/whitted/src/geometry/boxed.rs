//! The axis-aligned box as a surface.

use super::shape::round_outward;
use super::{Crossings, ShapePoint};
use crate::math::{Aabb, Vec3d};

/// The six faces of an axis-aligned box. It may be flat along one axis: a rectangle, crossed twice at one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boxed {
    /// Lower corner.
    pub lo: Vec3d,
    /// Upper corner, no component below that of `lo`.
    pub hi: Vec3d,
}

impl Boxed {
    /// See [`Shape::crossings`](super::Shape::crossings): never or twice. A line within a face crosses the box where it
    /// enters and leaves the face.
    pub fn crossings(&self, origin: Vec3d, direction: Vec3d) -> Crossings {
        let (mut enter, mut exit) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (to_lo, to_hi, d) = (self.lo[axis] - origin[axis], self.hi[axis] - origin[axis], direction[axis]);
            // A line along a slab is in it always or never; dividing by zero would ask whether 0 · ∞ is inside.
            let (near, far) = match d == 0.0 {
                true if to_lo <= 0.0 && 0.0 <= to_hi => continue,
                true => return Crossings::NONE,
                false if d > 0.0 => (to_lo / d, to_hi / d),
                false => (to_hi / d, to_lo / d),
            };
            if near.is_nan() || far.is_nan() {
                return Crossings::NONE;
            }
            (enter, exit) = (enter.max(near), exit.min(far));
        }
        Crossings::interval(enter, exit)
    }

    /// See [`Shape::bounds`](super::Shape::bounds).
    pub fn bounds(&self) -> Aabb {
        round_outward(self.lo, self.hi)
    }

    /// True if `clip` lies wholly in the inside, where there is no surface.
    pub(super) fn surrounds(&self, clip: &Aabb) -> bool {
        let (lo, hi) = (clip.lo.to_f64(), clip.hi.to_f64());
        (0..3).all(|axis| self.lo[axis] < lo[axis] && hi[axis] < self.hi[axis])
    }

    /// See [`Shape::surface`](super::Shape::surface). `uv` are the coordinates along the two axes of the face that
    /// follow its normal's axis (x → y, z; y → z, x; z → x, y), each from 0 to 1.
    pub fn surface(&self, near: Vec3d) -> ShapePoint {
        let mut position = near.max(self.lo).min(self.hi).to_array();
        let (axis, upper) = self.nearest_face(near);
        position[axis] = if upper { self.hi[axis] } else { self.lo[axis] };
        let mut normal = [0.0; 3];
        normal[axis] = if upper { 1.0 } else { -1.0 };
        let size = self.hi - self.lo;
        let uv = [(axis + 1) % 3, (axis + 2) % 3].map(|i| match size[i] > 0.0 {
            true => (position[i] - self.lo[i]) / size[i],
            false => 0.0,
        });
        ShapePoint { position: position.into(), normal: normal.into(), uv }
    }

    /// Axis of the face whose plane is nearest to `near`, and whether it is the upper one; the first in case of a tie.
    fn nearest_face(&self, near: Vec3d) -> (usize, bool) {
        let mut nearest = (0, false);
        let mut least = f64::INFINITY;
        for (axis, upper) in [(0, false), (0, true), (1, false), (1, true), (2, false), (2, true)] {
            let face = if upper { self.hi[axis] } else { self.lo[axis] };
            let distance = (near[axis] - face).abs();
            if distance < least {
                (nearest, least) = ((axis, upper), distance);
            }
        }
        nearest
    }

    pub(super) fn has_area(&self) -> bool {
        let size = self.hi - self.lo;
        let flat = (0..3).filter(|&axis| size[axis] == 0.0).count();
        size.min_component() >= 0.0 && size.is_finite() && flat <= 1
    }
}
