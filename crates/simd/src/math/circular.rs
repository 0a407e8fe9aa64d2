//! Sine, cosine, tangent.

use super::{polynomial, round};
use crate::{F32Lanes, U32Lanes};
use std::f32::consts::FRAC_2_PI;

/// Beyond this many radians an `f32` is too coarse to be an angle.
const LIMIT: f32 = 1e5;

/// π/2 in four parts of 8 bits, whose products with a quadrant number of 16 bits are exact, and a rest.
const HALF_PI: [f32; 5] = [1.570_312_5, 4.844_665_5e-4, -6.407_499_3e-7, 9.895_302e-10, 2.563_344e-12];

/// Sine of `x` radians; error at most 1.6 ulp for `|x| <= 10⁵`.
///
/// Greater finite angles count as zero. NaN for infinities and NaN. Exactly odd.
#[inline(always)]
pub fn sin<F: F32Lanes>(token: F::Token, x: F) -> F {
    sin_cos(token, x).0
}

/// Cosine of `x` radians; error and range as of [`sin`]. Exactly even.
#[inline(always)]
pub fn cos<F: F32Lanes>(token: F::Token, x: F) -> F {
    sin_cos(token, x).1
}

/// Tangent of `x` radians; error at most 3.5 ulp, range as of [`sin`].
#[inline(always)]
pub fn tan<F: F32Lanes>(token: F::Token, x: F) -> F {
    let (sin, cos) = sin_cos(token, x);
    sin / cos
}

/// [`sin`] and [`cos`] of the same angle, for the price of one.
#[inline(always)]
pub fn sin_cos<F: F32Lanes>(token: F::Token, x: F) -> (F, F) {
    let c = |value| F::splat(token, value);
    let (angle, quadrant) = reduce(token, x.abs());
    let square = angle * angle;
    let sin = polynomial(token, square, [-0.166_666_55, 0.008_332_191, -0.000_195_185_92]);
    let cos = polynomial(token, square, [0.041_666_646, -0.001_388_73, 2.443_024e-5]);
    let sin = angle + angle * (square * sin);
    let cos = c(1.0) - (c(0.5) * square - square * (square * cos));

    let bit = |value| F::U32::splat(token, value);
    let even = (quadrant & bit(1)).eq(bit(0));
    let sin_sign = (quadrant & bit(2)).shl::<30>() ^ (x.to_bits() & bit(1 << 31));
    let cos_sign = ((quadrant + bit(1)) & bit(2)).shl::<30>();
    (
        F::from_bits(F::select(even, sin, cos).to_bits() ^ sin_sign),
        F::from_bits(F::select(even, cos, sin).to_bits() ^ cos_sign),
    )
}

/// `x = angle + quadrant · π/2` with `|angle| <= π/4` (and a rounding), for `x >= 0`.
#[inline(always)]
fn reduce<F: F32Lanes>(token: F::Token, x: F) -> (F, F::U32) {
    let c = |value| F::splat(token, value);
    let beyond = x.gt(c(LIMIT)) & x.lt(c(f32::INFINITY));
    let x = F::select(beyond, c(0.0), x);
    let (whole, quadrant) = round(token, x * c(FRAC_2_PI));
    let part = |i: usize| whole * c(HALF_PI[i]);
    // The first two differences are exact, the others go with their rounding errors (Dekker 1971).
    let (angle, error_2) = difference(x - part(0) - part(1), part(2));
    let (angle, error_3) = difference(angle, part(3));
    (angle + (error_2 + error_3 - part(4)), quadrant)
}

/// `a - b` and its rounding error, where `|a| >= |b|` or the difference is exact.
#[inline(always)]
fn difference<F: F32Lanes>(a: F, b: F) -> (F, F) {
    let difference = a - b;
    (difference, (a - difference) - b)
}
