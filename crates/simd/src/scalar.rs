//! Lanes in plain Rust: every target, and the oracle of every other instruction set.

use crate::{F32Lanes, MaskLanes, Simd, U32Lanes};
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// The token of plain Rust.
#[derive(Clone, Copy, Debug)]
pub struct Scalar;

impl Simd for Scalar {
    type F32x4 = ScalarF32<4>;
    type F32x8 = ScalarF32<8>;
    type F32x16 = ScalarF32<16>;
    type F64x8 = crate::ArrayF64<ScalarF32<8>>;
    const NAME: &'static str = "scalar";
}

/// `N` floats in plain Rust.
#[derive(Clone, Copy, Debug)]
pub struct ScalarF32<const N: usize>(pub(crate) [f32; N]);

/// `N` integers in plain Rust.
#[derive(Clone, Copy, Debug)]
pub struct ScalarU32<const N: usize>(pub(crate) [u32; N]);

/// `N` truth values in plain Rust.
#[derive(Clone, Copy, Debug)]
pub struct ScalarMask<const N: usize>(pub(crate) [bool; N]);

macro_rules! lanewise {
    ($type:ident, $trait:ident, $name:ident, |$a:ident, $b:ident| $body:expr) => {
        impl<const N: usize> $trait for $type<N> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| {
                    let ($a, $b) = (self.0[i], other.0[i]);
                    $body
                }))
            }
        }
    };
}

lanewise!(ScalarF32, Add, add, |a, b| a + b);
lanewise!(ScalarF32, Sub, sub, |a, b| a - b);
lanewise!(ScalarF32, Mul, mul, |a, b| a * b);
lanewise!(ScalarF32, Div, div, |a, b| a / b);
lanewise!(ScalarU32, Add, add, |a, b| a.wrapping_add(b));
lanewise!(ScalarU32, Sub, sub, |a, b| a.wrapping_sub(b));
lanewise!(ScalarU32, Mul, mul, |a, b| a.wrapping_mul(b));
lanewise!(ScalarU32, BitAnd, bitand, |a, b| a & b);
lanewise!(ScalarU32, BitOr, bitor, |a, b| a | b);
lanewise!(ScalarU32, BitXor, bitxor, |a, b| a ^ b);
lanewise!(ScalarMask, BitAnd, bitand, |a, b| a & b);
lanewise!(ScalarMask, BitOr, bitor, |a, b| a | b);
lanewise!(ScalarMask, BitXor, bitxor, |a, b| a ^ b);

impl<const N: usize> Neg for ScalarF32<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|a| -a))
    }
}

impl<const N: usize> Not for ScalarU32<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|a| !a))
    }
}

impl<const N: usize> Not for ScalarMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|a| !a))
    }
}

/// `a * b + c` with one rounding, from `f64` arithmetic alone.
///
/// The product of two `f32` is exact in `f64`. The sum is made round-to-odd by its TwoSum error (Knuth), and rounding
/// such a value to `f32` equals rounding the exact sum (Boldo, Melquiond 2008: two extra bits suffice, `f64` has 29).
#[inline(always)]
pub(crate) fn fma_f32(a: f32, b: f32, c: f32) -> f32 {
    let product = f64::from(a) * f64::from(b);
    let c = f64::from(c);
    let sum = product + c;
    let c_part = sum - product;
    let error = (product - (sum - c_part)) + (c - c_part);
    let bits = sum.to_bits();
    // A NaN error (infinite operands) compares unequal to zero nowhere it matters: the sum is then inf or NaN.
    let inexact = error != 0.0 && sum.is_finite() && bits & 1 == 0;
    // Move towards the exact value if it lies below |sum|, so that truncation plus a set last bit is round-to-odd.
    let toward_zero = (error < 0.0) == (sum > 0.0);
    let odd = if toward_zero { bits.wrapping_sub(1) } else { bits | 1 };
    f64::from_bits(if inexact { odd } else { bits }) as f32
}

#[inline(always)]
fn zip<A: Copy, B: Copy, C, const N: usize>(a: [A; N], b: [B; N], f: impl Fn(A, B) -> C) -> [C; N] {
    std::array::from_fn(|i| f(a[i], b[i]))
}

/// Fold the upper half of the lanes into the lower half until one is left. `N` is a power of two.
#[inline(always)]
fn fold_halves<const N: usize>(mut lanes: [f32; N], f: impl Fn(f32, f32) -> f32) -> f32 {
    const { assert!(N.is_power_of_two()) };
    let mut half = N / 2;
    while half > 0 {
        for i in 0..half {
            lanes[i] = f(lanes[i], lanes[i + half]);
        }
        half /= 2;
    }
    lanes[0]
}

impl<const N: usize> F32Lanes for ScalarF32<N>
where
    [f32; N]: Default,
    [u32; N]: Default,
{
    type Token = Scalar;
    type Mask = ScalarMask<N>;
    type U32 = ScalarU32<N>;
    type Array = [f32; N];
    const WIDTH: usize = N;

    #[inline(always)]
    fn token(self) -> Self::Token {
        Scalar
    }
    #[inline(always)]
    fn splat(_: Scalar, value: f32) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn load(_: Scalar, from: &[f32; N]) -> Self {
        Self(*from)
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; N]) {
        *to = self.0;
    }
    #[inline(always)]
    fn load_slice(_: Scalar, from: &[f32]) -> Self {
        Self(*from.first_chunk().expect("slice shorter than the lanes"))
    }
    #[inline(always)]
    fn store_slice(self, to: &mut [f32]) {
        *to.first_chunk_mut().expect("slice shorter than the lanes") = self.0;
    }
    #[inline(always)]
    fn gather(table: &[f32], index: ScalarU32<N>) -> Self {
        Self(index.0.map(|i| table[i as usize]))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(zip(self.0, other.0, |a, b| if a < b { a } else { b }))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(zip(self.0, other.0, |a, b| if a > b { a } else { b }))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f32::sqrt))
    }
    #[inline(always)]
    fn fma(self, factor: Self, addend: Self) -> Self {
        Self(std::array::from_fn(|i| fma_f32(self.0[i], factor.0[i], addend.0[i])))
    }
    #[inline(always)]
    fn mul_add_fast(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    #[inline(always)]
    fn floor(self) -> Self {
        Self(self.0.map(f32::floor))
    }
    #[inline(always)]
    fn recip_approx(self) -> Self {
        Self(self.0.map(|a| 1.0 / a))
    }
    #[inline(always)]
    fn rsqrt_approx(self) -> Self {
        Self(self.0.map(|a| 1.0 / a.sqrt()))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> ScalarMask<N> {
        ScalarMask(zip(self.0, other.0, |a, b| a < b))
    }
    #[inline(always)]
    fn le(self, other: Self) -> ScalarMask<N> {
        ScalarMask(zip(self.0, other.0, |a, b| a <= b))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> ScalarMask<N> {
        ScalarMask(zip(self.0, other.0, |a, b| a == b))
    }
    #[inline(always)]
    fn select(mask: ScalarMask<N>, set: Self, unset: Self) -> Self {
        Self(std::array::from_fn(|i| if mask.0[i] { set.0[i] } else { unset.0[i] }))
    }
    #[inline(always)]
    fn compress_store(self, mask: ScalarMask<N>, to: &mut [f32]) {
        compress(&self.0, &mask.0, to);
    }
    #[inline(always)]
    fn to_bits(self) -> ScalarU32<N> {
        ScalarU32(self.0.map(f32::to_bits))
    }
    #[inline(always)]
    fn from_bits(bits: ScalarU32<N>) -> Self {
        Self(bits.0.map(f32::from_bits))
    }
    #[inline(always)]
    fn round_to_int(self) -> ScalarU32<N> {
        ScalarU32(self.0.map(|a| a.round_ties_even() as i32 as u32))
    }
    #[inline(always)]
    fn from_int(value: ScalarU32<N>) -> Self {
        Self(value.0.map(|a| a as i32 as f32))
    }
    #[inline(always)]
    fn reduce_add(self) -> f32 {
        fold_halves(self.0, |a, b| a + b)
    }
    #[inline(always)]
    fn reduce_min(self) -> f32 {
        fold_halves(self.0, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn reduce_max(self) -> f32 {
        fold_halves(self.0, |a, b| if a > b { a } else { b })
    }
}

impl<const N: usize> U32Lanes for ScalarU32<N>
where
    [f32; N]: Default,
    [u32; N]: Default,
{
    type Token = Scalar;
    type Mask = ScalarMask<N>;
    type F32 = ScalarF32<N>;
    type Array = [u32; N];
    const WIDTH: usize = N;

    #[inline(always)]
    fn splat(_: Scalar, value: u32) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn load(_: Scalar, from: &[u32; N]) -> Self {
        Self(*from)
    }
    #[inline(always)]
    fn store(self, to: &mut [u32; N]) {
        *to = self.0;
    }
    #[inline(always)]
    fn load_slice(_: Scalar, from: &[u32]) -> Self {
        Self(*from.first_chunk().expect("slice shorter than the lanes"))
    }
    #[inline(always)]
    fn store_slice(self, to: &mut [u32]) {
        *to.first_chunk_mut().expect("slice shorter than the lanes") = self.0;
    }
    #[inline(always)]
    fn gather(table: &[u32], index: Self) -> Self {
        Self(index.0.map(|i| table[i as usize]))
    }
    #[inline(always)]
    fn shl<const K: u32>(self) -> Self {
        Self(self.0.map(|a| a << K))
    }
    #[inline(always)]
    fn shr<const K: u32>(self) -> Self {
        Self(self.0.map(|a| a >> K))
    }
    #[inline(always)]
    fn sar<const K: u32>(self) -> Self {
        Self(self.0.map(|a| (a as i32 >> K) as u32))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> ScalarMask<N> {
        ScalarMask(zip(self.0, other.0, |a, b| a == b))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> ScalarMask<N> {
        ScalarMask(zip(self.0, other.0, |a, b| a < b))
    }
    #[inline(always)]
    fn select(mask: ScalarMask<N>, set: Self, unset: Self) -> Self {
        Self(std::array::from_fn(|i| if mask.0[i] { set.0[i] } else { unset.0[i] }))
    }
    #[inline(always)]
    fn compress_store(self, mask: ScalarMask<N>, to: &mut [u32]) {
        compress(&self.0, &mask.0, to);
    }
}

/// The elements of `mask`, without gaps.
#[inline(always)]
fn compress<T: Copy, const N: usize>(lanes: &[T; N], mask: &[bool; N], to: &mut [T]) {
    let to = &mut to[..N];
    let mut count = 0;
    for i in 0..N {
        // Store always, advance if set: the branch would be a coin toss. The last store is at N − 1 or before.
        to[count] = lanes[i];
        count += usize::from(mask[i]);
    }
}

impl<const N: usize> MaskLanes for ScalarMask<N> {
    type Token = Scalar;
    const WIDTH: usize = N;

    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.iter().enumerate().fold(0, |bits, (i, &set)| bits | u32::from(set) << i)
    }
    #[inline(always)]
    fn from_bits(_: Scalar, bits: u32) -> Self {
        Self(std::array::from_fn(|i| bits >> i & 1 != 0))
    }
}
