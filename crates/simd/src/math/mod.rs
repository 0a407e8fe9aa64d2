//! Portable elementary functions: the same bits on every CPU, with any number of lanes.
//!
//! They are made of `+ - * /`, square roots, comparisons and bit operations, each of which rounds the same way
//! everywhere; none calls the platform's math library, whose results differ between systems. The functions here take
//! one number; those in [`lanes`] take a token and a vector and give the same bits in each lane.
//!
//! The greatest errors seen, in units in the last place (ulp) of the exact result, are at [each function](lanes) and
//! held by tests. Where a result is subnormal, read "ulp" as the spacing of subnormals. Polynomial coefficients are
//! near-minimax fits by weighted least squares at Chebyshev nodes, rounded one by one from the lowest degree up.

mod circular;
mod exponential;
mod inverse;
mod logarithm;

use crate::{F32Lanes, Scalar, ScalarF32, U32Lanes};

/// The functions for vectors of any width and instruction set.
pub mod lanes {
    pub use super::circular::{cos, sin, sin_cos, tan};
    pub use super::exponential::{exp, exp2};
    pub use super::inverse::{acos, asin, atan2};
    pub use super::logarithm::{ln, log2, pow, pow_of_fraction};
}

macro_rules! plain {
    ($($name:ident($($argument:ident),*))*) => {$(
        #[doc = concat!("[`lanes::", stringify!($name), "`] of one number.")]
        #[inline]
        pub fn $name($($argument: f32),*) -> f32 {
            lanes::$name(Scalar, $(ScalarF32([$argument])),*).0[0]
        }
    )*};
}

plain! {
    exp2(x) exp(x) log2(x) ln(x) pow(x, y) pow_of_fraction(x, y)
    sin(x) cos(x) tan(x)
    atan2(y, x) acos(x) asin(x)
}

/// [`lanes::sin_cos`] of one number.
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    let (sin, cos) = lanes::sin_cos(Scalar, ScalarF32([x]));
    (sin.0[0], cos.0[0])
}

/// `c[0] + c[1] x + c[2] x² + …` by Horner's rule.
#[inline(always)]
fn polynomial<F: F32Lanes, const N: usize>(token: F::Token, x: F, c: [f32; N]) -> F {
    let mut sum = F::splat(token, c[N - 1]);
    for i in (0..N - 1).rev() {
        sum = sum * x + F::splat(token, c[i]);
    }
    sum
}

/// The nearest integer of `|x| < 2²²`, ties to even, as a float and in two's complement; unspecified beyond.
#[inline(always)]
fn round<F: F32Lanes>(token: F::Token, x: F) -> (F, F::U32) {
    // Added to this, a number has its units in the last bit.
    let magic = F::splat(token, 12_582_912.0);
    let shifted = x + magic;
    (shifted - magic, shifted.to_bits() - magic.to_bits())
}

/// The upper 12 bits of each mantissa: products of two such numbers are exact.
#[inline(always)]
fn head<F: F32Lanes>(token: F::Token, x: F) -> F {
    F::from_bits(x.to_bits() & F::U32::splat(token, 0xffff_f000))
}
