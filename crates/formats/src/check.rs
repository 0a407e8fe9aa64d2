//! What must hold of numbers in any scene file.

use whitted::math::Vec3d;
use whitted::scene::Camera;

use crate::error::ErrorKind;
use crate::files::LoadOptions;

/// What is wrong with a view angle in degrees, if anything.
pub(crate) fn angle(angle: f64) -> Option<&'static str> {
    let possible = angle > 0.0 && angle < 180.0;
    (!possible).then_some("the view angle must lie between 0 and 180 degrees")
}

/// What is wrong with a camera, if anything.
pub(crate) fn camera(camera: &Camera) -> Option<&'static str> {
    let view = camera.look_at - camera.eye;
    match () {
        () if angle(camera.vfov).is_some() => angle(camera.vfov),
        () if view == Vec3d::ZERO => Some("the eye is where it looks at"),
        () if camera.up == Vec3d::ZERO => Some("the up direction is zero"),
        () if are_parallel(view, camera.up) => Some("the up direction lies along the view"),
        () => None,
    }
}

/// True if two directions, neither of them 0, differ by less than single precision can tell.
fn are_parallel(a: Vec3d, b: Vec3d) -> bool {
    /// Sine of the angle below which the directions count as equal.
    const SMALLEST_SINE: f64 = 1e-7;
    let unit = |v: Vec3d| (v / v.abs().max_component()).normalize();
    let sine = unit(a).cross(unit(b)).length();
    sine.is_nan() || sine <= SMALLEST_SINE
}

/// The size of a picture, or who is to blame and what is wrong.
pub(crate) fn size(size: [u64; 2], options: &LoadOptions) -> Result<[u32; 2], (ErrorKind, String)> {
    let [width, height] = size;
    if width == 0 || height == 0 {
        return Err((ErrorKind::Input, format!("a picture of {width}×{height} pixels is impossible")));
    }
    let limit = options.max_pixels;
    match (u32::try_from(width), u32::try_from(height)) {
        (Ok(w), Ok(h)) if width.checked_mul(height).is_some_and(|pixels| pixels <= limit) => Ok([w, h]),
        _ => Err((ErrorKind::Limit, format!("a picture of {width}×{height} pixels exceeds the limit of {limit}"))),
    }
}
