//! The circular cylinder.

use crate::math::Vec3d;

/// A round tube from `base` to `apex`.
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
