//! The axis-aligned box as a surface.

use crate::math::Vec3d;

/// The six faces of an axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boxed {
    /// Lower corner.
    pub lo: Vec3d,
    /// Upper corner, no component below that of `lo`.
    pub hi: Vec3d,
}
