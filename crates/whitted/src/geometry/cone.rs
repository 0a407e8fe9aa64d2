//! The circular cone and its frustum.

use crate::math::Vec3d;

/// A cone from `base` to `apex` whose radius changes linearly from `base_radius` to `apex_radius`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Middle of one end.
    pub base: Vec3d,
    /// Middle of the other end.
    pub apex: Vec3d,
    /// Radius at `base`, ≥ 0.
    pub base_radius: f64,
    /// Radius at `apex`, ≥ 0; not equal to `base_radius` in magnitude that would make it a cylinder of radius 0.
    pub apex_radius: f64,
    /// True if ends of positive radius are closed by discs.
    pub capped: bool,
}
