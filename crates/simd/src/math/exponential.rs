//! Powers of 2 and e.

use super::{polynomial, round};
use crate::{F32Lanes, U32Lanes};
use std::f32::consts::{LN_2, LOG2_E};

/// `ln 2` in two parts, of which the first times an exponent is exact.
pub(super) const LN_2_PARTS: [f32; 2] = [0.693_145_75, 1.428_606_8e-6];

/// `2^x`; error at most 1.1 ulp, exact for integers. Overflows to infinity, underflows through subnormals to 0; NaN
/// for NaN.
#[inline(always)]
pub fn exp2<F: F32Lanes>(token: F::Token, x: F) -> F {
    let x = clamp(token, x, -151.0, 129.0);
    let (whole, exponent) = round(token, x);
    scale(token, exp2_fraction(token, x - whole), exponent)
}

/// `e^x`; error at most 1 ulp. Overflows to infinity, underflows through subnormals to 0; NaN for NaN.
#[inline(always)]
pub fn exp<F: F32Lanes>(token: F::Token, x: F) -> F {
    let x = clamp(token, x, -105.0, 90.0);
    let (whole, exponent) = round(token, x * F::splat(token, LOG2_E));
    let fraction = x - whole * F::splat(token, LN_2_PARTS[0]) - whole * F::splat(token, LN_2_PARTS[1]);
    let rest = polynomial(token, fraction, [0.499_999_88, 0.166_665_18, 0.041_669_656, 0.008_368_961, 0.001_374_480_4]);
    scale(token, F::splat(token, 1.0) + (fraction + fraction * fraction * rest), exponent)
}

/// `2^x` for `|x| <= 0.501`.
#[inline(always)]
pub(super) fn exp2_fraction<F: F32Lanes>(token: F::Token, x: F) -> F {
    let slope =
        polynomial(token, x, [LN_2, 0.240_226_45, 0.055_503_59, 0.009_618_837, 0.001_339_132_8, 0.000_152_398_63]);
    F::splat(token, 1.0) + x * slope
}

/// `x` within `low..=high`; NaN stays NaN.
#[inline(always)]
pub(super) fn clamp<F: F32Lanes>(token: F::Token, x: F, low: f32, high: f32) -> F {
    // `min` and `max` return their second operand for NaN.
    F::splat(token, high).min(F::splat(token, low).max(x))
}

/// `x · 2^exponent` for exponents within ±252. Two factors, because one alone may be out of range.
#[inline(always)]
pub(super) fn scale<F: F32Lanes>(token: F::Token, x: F, exponent: F::U32) -> F {
    let half = exponent.sar::<1>();
    x * power_of_2(token, half) * power_of_2(token, exponent - half)
}

/// `2^exponent` for exponents of normal numbers.
#[inline(always)]
pub(super) fn power_of_2<F: F32Lanes>(token: F::Token, exponent: F::U32) -> F {
    F::from_bits((exponent + F::U32::splat(token, 127)).shl::<23>())
}
