//! Angles in double precision, built from + − × ÷ and square root: the same bits on every CPU.

use std::f64::consts::{FRAC_PI_2, PI};

/// Sine and cosine of an angle in degrees; NaN for angles that are not finite.
///
/// The angle is reduced in degrees, where that is exact, so multiples of 90° give exact results. The error is below
/// 2⁻⁵² elsewhere.
pub fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    // Both steps are exact: a remainder, then the difference of two multiples of the smaller number's last bit.
    let within_turn = degrees % 360.0;
    let quarters = (within_turn / 90.0).round_ties_even();
    let (sin, cos) = sin_cos_small((within_turn - 90.0 * quarters) * (PI / 180.0));
    match (quarters as i64).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Sine and cosine of `|x| ≤ π/4` by their Taylor series, whose first dropped terms are below 2⁻⁵⁶.
fn sin_cos_small(x: f64) -> (f64, f64) {
    let (mut sin, mut cos) = (0.0, 0.0);
    // Horner's rule from the innermost bracket outwards: 1 − x²/(n(n+1)) · (…).
    for n in (1..=8).rev() {
        let n = f64::from(2 * n);
        sin = (1.0 - sin) * (x * x / (n * (n + 1.0)));
        cos = (1.0 - cos) * (x * x / (n * (n - 1.0)));
    }
    (x - x * sin, 1.0 - cos)
}

/// The angle of the point (`x`, `y`) from the +x axis, in (−π, π], with an error below 2⁻⁵⁰; 0 for the origin, NaN if a
/// coordinate is NaN or both are infinite.
pub fn atan2(y: f64, x: f64) -> f64 {
    let (near, far) = if y.abs() < x.abs() { (y.abs(), x.abs()) } else { (x.abs(), y.abs()) };
    if far == 0.0 {
        return 0.0;
    }
    let first_octant = atan_unit(near / far);
    let first_quadrant = if y.abs() < x.abs() { first_octant } else { FRAC_PI_2 - first_octant };
    let upper = if x < 0.0 { PI - first_quadrant } else { first_quadrant };
    if y < 0.0 { -upper } else { upper }
}

/// The arc tangent of `0 ≤ x ≤ 1`.
fn atan_unit(x: f64) -> f64 {
    /// tan(π/4 / 2³) = 0.0985: nine terms of the series reach 2⁻⁵⁶ there.
    const HALVINGS: i32 = 3;
    const TERMS: i32 = 9;
    let x = (0..HALVINGS).fold(x, |x, _| x / (1.0 + (1.0 + x * x).sqrt()));
    let series = (0..TERMS).rev().fold(0.0, |sum, n| 1.0 / f64::from(2 * n + 1) - x * x * sum);
    f64::from(1 << HALVINGS) * x * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_of_a_right_angle_are_exact() {
        for (degrees, sin, cos) in [(0.0, 0.0, 1.0), (90.0, 1.0, 0.0), (180.0, 0.0, -1.0), (270.0, -1.0, 0.0)] {
            for turns in [-720.0, -360.0, 0.0, 360.0, 3.6e9] {
                assert_eq!(sin_cos_degrees(degrees + turns), (sin, cos), "{degrees} + {turns}");
            }
        }
    }

    #[test]
    fn agrees_with_the_platform() {
        // Beyond one turn the reference itself, whose argument is rounded, is the less exact one.
        for step in -1300..1300 {
            let degrees = f64::from(step) * 0.27;
            let (sin, cos) = sin_cos_degrees(degrees);
            let (expected_sin, expected_cos) = degrees.to_radians().sin_cos();
            assert!((sin - expected_sin).abs() < 2e-15 && (cos - expected_cos).abs() < 2e-15, "{degrees}");
            assert!((sin * sin + cos * cos - 1.0).abs() < 1e-15, "{degrees}");
            let angle = atan2(sin * 3.0, cos * 3.0);
            assert!((angle - (sin * 3.0).atan2(cos * 3.0)).abs() < 2e-15, "{degrees}: {angle}");
        }
    }

    #[test]
    fn odd_angles() {
        assert!(sin_cos_degrees(f64::INFINITY).0.is_nan());
        assert!(sin_cos_degrees(f64::NAN).1.is_nan());
        assert_eq!(atan2(0.0, 0.0), 0.0);
        assert_eq!(atan2(0.0, -1.0), PI);
        assert_eq!(atan2(1.0, 0.0), FRAC_PI_2);
        assert!(atan2(f64::NAN, 1.0).is_nan());
    }
}
