//! The pinhole camera.

use crate::math::Vec3d;

/// A pinhole camera in a right-handed world, y up by custom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The pinhole.
    pub eye: Vec3d,
    /// The point in the middle of the picture.
    pub look_at: Vec3d,
    /// The direction that is up in the picture; need not be perpendicular to the view.
    pub up: Vec3d,
    /// Vertical field of view in degrees, 0 to 180, both exclusive.
    pub vfov: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self { eye: Vec3d::new(0.0, 0.0, 5.0), look_at: Vec3d::ZERO, up: Vec3d::new(0.0, 1.0, 0.0), vfov: 40.0 }
    }
}
