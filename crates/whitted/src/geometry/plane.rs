//! The unbounded plane, tested outside the tree.

use crate::math::Vec3d;

/// An unbounded plane: the points `p` with `normal · (p − point) = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Any point of the plane.
    pub point: Vec3d,
    /// Direction of the front side; need not be normalised.
    pub normal: Vec3d,
}
