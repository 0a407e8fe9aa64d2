//! The disc: a flat round plate, possibly with a hole.

use crate::math::Vec3d;

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
