//! Colours of displays as linear light.

use whitted::math::{Vec3, Vec3f};

/// The linear colour of `#rrggbb`, which is sRGB; none for any other text.
pub(super) fn parse_hex(text: &str) -> Option<Vec3f> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    let byte = |at: usize| u8::from_str_radix(digits.get(at..at + 2)?, 16).ok();
    // `from_str_radix` would allow a sign.
    let all_digits = digits.bytes().all(|b| b.is_ascii_hexdigit());
    all_digits.then_some(Vec3::new(byte(0)?, byte(2)?, byte(4)?).map(linear))
}

/// The inverse of the sRGB transfer function (IEC 61966-2-1).
fn linear(byte: u8) -> f32 {
    let a = f32::from(byte) / 255.0;
    if a <= 0.040_45 { a / 12.92 } else { simd::math::pow((a + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_colours_become_linear() {
        assert_eq!(parse_hex("#000000"), Some(Vec3f::ZERO));
        assert_eq!(parse_hex("#FFffff"), Some(Vec3f::ONE));
        let Vec3 { x, y, z } = parse_hex("#80bc01").unwrap();
        // The standard's formula in double precision.
        for (found, stated) in [(x, 0.215_860_5), (y, 0.502_886_5), (z, 0.000_303_53)] {
            assert!((found - stated).abs() < 1e-6 * stated.max(0.1), "{found} {stated}");
        }
        for wrong in ["", "#", "#12345", "#1234567", "123456", "#+12345", "#12345g", "#ééé"] {
            assert_eq!(parse_hex(wrong), None, "{wrong}");
        }
    }
}
