//! Angles from ratios.

use super::polynomial;
use crate::{F32Lanes, U32Lanes};

/// π/4 in two parts, of which the first, with 21 bits, times 0 to 4 is exact.
const QUARTER_PI: [f32; 2] = [f32::from_bits(0x3f49_0fd8), 1.569_582_4e-7];

/// tan(π/8): above it, the arctangent is found relative to π/4.
const TAN_PI_8: f32 = 0.414_213_57;

/// The angle of the point (x, y) in radians, within ±π; error at most 2 ulp.
///
/// Takes the quadrant from the signs, also of zeros: `atan2(±0, x)` is ±0 for positive x and +0, ±π for negative x and
/// -0. Infinities count as equally far. NaN if an operand is NaN.
#[inline(always)]
pub fn atan2<F: F32Lanes>(token: F::Token, y: F, x: F) -> F {
    let c = |value| F::splat(token, value);
    let bit = |value| F::U32::splat(token, value);
    let (x_size, y_size) = comparable(token, x.abs(), y.abs());
    let (low, high) = (x_size.min(y_size), x_size.max(y_size));

    // Arctangent of low / high, as that of a smaller quotient, relative to `quarters` · π/4.
    let steep = low.gt(high * c(TAN_PI_8));
    let numerator = F::select(steep, low - high, low);
    let denominator = F::select(steep, low + high, high);
    let quotient = numerator / F::select(denominator.eq(c(0.0)), c(1.0), denominator);
    let square = quotient * quotient;
    let series = polynomial(token, square, [-0.333_333_13, 0.199_983_9, -0.142_422_4, 0.105_854_91, -0.060_593_93]);
    let angle = quotient + quotient * (square * series);
    let quarters = F::select(steep, c(1.0), c(0.0));

    // Mirror at the diagonal, then at the y axis, then at the x axis.
    let upright = y_size.gt(x_size);
    let angle = F::select(upright, -angle, angle);
    let quarters = F::select(upright, c(2.0) - quarters, quarters);
    let right = x.to_bits().shr::<31>().eq(bit(0));
    let angle = F::select(right, angle, -angle);
    let quarters = F::select(right, quarters, c(4.0) - quarters);
    let angle = quarters * c(QUARTER_PI[0]) + (quarters * c(QUARTER_PI[1]) + angle);
    let signed = F::from_bits(angle.to_bits() ^ (y.to_bits() & bit(1 << 31)));
    F::select(x.eq(x) & y.eq(y), signed, c(f32::NAN))
}

/// The angle in 0..=π whose cosine is `x`; error at most 2.7 ulp. NaN for `|x| > 1` and NaN.
#[inline(always)]
pub fn acos<F: F32Lanes>(token: F::Token, x: F) -> F {
    atan2(token, opposite(token, x), x)
}

/// The angle within ±π/2 whose sine is `x`; error at most 2.7 ulp. NaN for `|x| > 1` and NaN.
#[inline(always)]
pub fn asin<F: F32Lanes>(token: F::Token, x: F) -> F {
    atan2(token, x, opposite(token, x))
}

/// `√(1 - x²)` without cancellation.
#[inline(always)]
fn opposite<F: F32Lanes>(token: F::Token, x: F) -> F {
    let one = F::splat(token, 1.0);
    ((one - x) * (one + x)).sqrt()
}

/// Non-negative `x` and `y` by a common factor such that neither their sum overflows nor their products with a
/// constant are coarse; infinities become 1 and 0.
#[inline(always)]
fn comparable<F: F32Lanes>(token: F::Token, x: F, y: F) -> (F, F) {
    let c = |value| F::splat(token, value);
    let high = x.max(y);
    let factor = F::select(high.gt(c(1e30)), c(0.25), F::select(high.lt(c(1e-30)), c(1_073_741_824.0), c(1.0)));
    let infinite = high.eq(c(f32::INFINITY));
    let x_at_infinity = F::select(x.eq(high), c(1.0), c(0.0));
    let y_at_infinity = F::select(y.eq(high), c(1.0), c(0.0));
    (F::select(infinite, x_at_infinity, x * factor), F::select(infinite, y_at_infinity, y * factor))
}
