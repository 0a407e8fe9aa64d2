//! What must hold of numbers in any scene file.

use crate::error::ErrorKind;
use crate::files::LoadOptions;

/// What is wrong with a view angle in degrees, if anything.
pub(crate) fn angle(angle: f64) -> Option<&'static str> {
    let possible = angle > 0.0 && angle < 180.0;
    (!possible).then_some("the view angle must lie between 0 and 180 degrees")
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
