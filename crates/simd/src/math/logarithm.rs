//! Logarithms, and the general power, which is made of one.

use super::exponential::{LN_2_PARTS, clamp, exp2_fraction, power_of_2, scale};
use super::{head, polynomial, round};
use crate::{F32Lanes, U32Lanes};
use std::f32::consts::LOG2_E;

/// `2 / ln 2` in two parts, of which the first has 12 bits.
const TWO_OVER_LN_2: [f32; 2] = [2.885_742_2, -0.000_352_105_7];

/// `ln x = exponent · ln 2 + 2 (head + tail)`, where `head` has 12 bits and the whole has about 30.
struct Parts<F> {
    exponent: F,
    head: F,
    tail: F,
}

/// The unevaluated sum of two numbers, the second much the smaller.
struct Sum<F>(F, F);

/// Base 2 logarithm; error at most 0.6 ulp, exact for powers of two. `log2(±0)` is -∞; NaN below zero and for NaN.
#[inline(always)]
pub fn log2<F: F32Lanes>(token: F::Token, x: F) -> F {
    let Sum(high, low) = log2_sum(token, x);
    with_edges(token, x, high + low)
}

/// Natural logarithm; error at most 0.6 ulp. `ln(±0)` is -∞; NaN below zero and for NaN.
#[inline(always)]
pub fn ln<F: F32Lanes>(token: F::Token, x: F) -> F {
    let Parts { exponent, head, tail } = parts(token, x);
    let scaled = exponent * F::splat(token, LN_2_PARTS[0]);
    let (head, tail) = (head + head, tail + tail);
    let high = scaled + head;
    let low = (head - (high - scaled)) + (tail + exponent * F::splat(token, LN_2_PARTS[1]));
    with_edges(token, x, high + low)
}

/// `x^y` for `x >= 0`; error at most 1.5 ulp in results within 2^±16, 4 ulp in all.
///
/// `pow(x, ±0)` and `pow(1, y)` are 1 for every x and y, NaN too. A zero of either sign counts as +0:
/// `pow(0, y)` is 0 for `y > 0` and infinite for `y < 0`. Infinite operands give the limit. Otherwise NaN where an
/// operand is NaN or `x < 0`.
#[inline(always)]
pub fn pow<F: F32Lanes>(token: F::Token, x: F, y: F) -> F {
    let c = |value| F::splat(token, value);
    let Sum(high, low) = log2_sum(token, x);
    let log = high + low;
    let rest = (high - log) + low;
    let log = with_edges(token, x, log);

    // The product in two parts: the heads multiply exactly.
    let estimate = y * log;
    let (y_head, log_head) = (head(token, y), head(token, log));
    let product = y_head * log_head;
    let product_low = (y - y_head) * log_head + y * ((log - log_head) + rest);

    let (whole, exponent) = round(token, clamp(token, estimate, -151.0, 129.0));
    let power = scale(token, exp2_fraction(token, (product - whole) + product_low), exponent);
    let power = F::select(estimate.gt(c(129.0)), c(f32::INFINITY), power);
    let power = F::select(estimate.lt(c(-151.0)), c(0.0), power);
    F::select(x.eq(c(1.0)) | y.eq(c(0.0)), c(1.0), power)
}

/// `x^y` for `x` from 2⁻¹²⁶ to 1 and finite `y >= 0`, for shading: at half the cost of [`pow`].
///
/// The error is at most 2⁻¹⁷ of results above 2⁻³²; `x^0` and `1^y` are 1, and what is below 2⁻¹²⁶ is 0. Results lie from 0
/// to 1; for other operands they mean nothing.
#[inline(always)]
pub fn pow_of_fraction<F: F32Lanes>(token: F::Token, x: F, y: F) -> F {
    let c = |value| F::splat(token, value);
    let (m, exponent) = mantissa::<F>(token, x.to_bits());
    let above_one = m - c(1.0);
    let log = F::from_int(exponent) + above_one * polynomial(token, above_one, LOG2_SERIES);
    let product = (y * log).max(c(-127.0));
    let (whole, exponent) = round(token, product);
    // An exponent of −127 makes zero.
    exp2_fraction(token, product - whole) * power_of_2(token, exponent)
}

/// `log2(1 + x) / x` for `√½ <= 1 + x < √2`, with 22 bits.
const LOG2_SERIES: [f32; 8] =
    [LOG2_E, -0.721_352_9, 0.480_916_7, -0.360_225_17, 0.287_288_87, -0.249_271_82, 0.232_652_58, -0.142_759_74];

/// `log2 x` for positive finite `x`, with about 30 bits.
#[inline(always)]
fn log2_sum<F: F32Lanes>(token: F::Token, x: F) -> Sum<F> {
    let c = |value| F::splat(token, value);
    let Parts { exponent, head, tail } = parts(token, x);
    let scaled = head * c(TWO_OVER_LN_2[0]);
    let rest = head * c(TWO_OVER_LN_2[1]) + tail * c(TWO_OVER_LN_2[0] + TWO_OVER_LN_2[1]);
    // Exact, as the exponent is 0 or the greater (Dekker 1971).
    let high = exponent + scaled;
    Sum(high, (scaled - (high - exponent)) + rest)
}

/// Take a positive finite `x = m · 2^exponent` apart, where `√½ <= m < √2` and `ln m = 2 artanh((m - 1) / (m + 1))`.
#[inline(always)]
fn parts<F: F32Lanes>(token: F::Token, x: F) -> Parts<F> {
    let c = |value| F::splat(token, value);
    let one = c(1.0);
    let tiny = x.lt(c(f32::MIN_POSITIVE));
    let (m, exponent) = mantissa::<F>(token, F::select(tiny, x * c(16_777_216.0), x).to_bits());
    let exponent = F::from_int(exponent) + F::select(tiny, c(-24.0), c(0.0));

    // The quotient to 12 bits, then what it lacks, from the exact remainder of the division by m + 1 in two parts.
    let numerator = m - one;
    let denominator = m + one;
    let reciprocal = one / denominator;
    let quotient = numerator * reciprocal;
    let q_head = head(token, quotient);
    let d_head = head(token, denominator);
    let d_tail = m - (d_head - one);
    let remainder = (numerator - q_head * d_head) - q_head * d_tail;

    let q_tail = remainder * reciprocal;
    let quotient = q_head + q_tail;
    let square = quotient * quotient;
    let series = polynomial(token, square, [0.333_333_3, 0.200_004_89, 0.142_491_12, 0.121_458_66]);
    Parts { exponent, head: q_head, tail: q_tail + quotient * (square * series) }
}

/// The `m` and the exponent of the number with these bits, `m · 2^exponent`, where `√½ <= m < √2`; of normal numbers.
#[inline(always)]
fn mantissa<F: F32Lanes>(token: F::Token, bits: F::U32) -> (F, F::U32) {
    let exponent = (bits - F::U32::splat(token, std::f32::consts::FRAC_1_SQRT_2.to_bits())).sar::<23>();
    (F::from_bits(bits - exponent.shl::<23>()), exponent)
}

/// The logarithm of any `x`, given that of the positive finite ones.
#[inline(always)]
fn with_edges<F: F32Lanes>(token: F::Token, x: F, log: F) -> F {
    let c = |value| F::splat(token, value);
    let log = F::select(x.lt(c(f32::INFINITY)), log, x);
    let not_positive = F::select(x.eq(c(0.0)), c(f32::NEG_INFINITY), c(f32::NAN));
    F::select(x.gt(c(0.0)), log, not_positive)
}
