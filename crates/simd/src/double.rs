//! Eight doubles: for results that are computed once in double precision.

use crate::{F32Lanes, MaskLanes};
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A vector of eight `f64`; `+ - * /` and `sqrt` round to nearest even, nothing is contracted.
pub trait F64Lanes:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// The same number of `f32`.
    type Narrow: F32Lanes<Array = [f32; 8]>;

    /// All lanes `value`.
    fn splat(token: <Self::Narrow as F32Lanes>::Token, value: f64) -> Self;
    /// The same values, exactly.
    fn widen(from: Self::Narrow) -> Self;
    /// The values rounded to nearest even.
    fn narrow(self) -> Self::Narrow;
    /// Write the lanes to `to`.
    fn store(self, to: &mut [f64; 8]);
    /// `self < other`; false for NaN.
    fn lt(self, other: Self) -> <Self::Narrow as F32Lanes>::Mask;
    /// `if self < other { self } else { other }` per lane: a NaN on either side gives `other`.
    fn min(self, other: Self) -> Self;
    /// `if self > other { self } else { other }` per lane: a NaN on either side gives `other`.
    fn max(self, other: Self) -> Self;
    /// Correctly rounded square root; NaN below zero.
    fn sqrt(self) -> Self;
}

/// Eight doubles in plain Rust, beside any narrow type.
#[derive(Clone, Copy, Debug)]
pub struct ArrayF64<N: F32Lanes> {
    lanes: [f64; 8],
    token: N::Token,
}

macro_rules! lanewise {
    ($($trait:ident $name:ident |$a:ident, $b:ident| $body:expr;)*) => {$(
        impl<N: F32Lanes> $trait for ArrayF64<N> {
            type Output = Self;
            #[inline(always)]
            fn $name(mut self, other: Self) -> Self {
                for i in 0..8 {
                    let ($a, $b) = (self.lanes[i], other.lanes[i]);
                    self.lanes[i] = $body;
                }
                self
            }
        }
    )*};
}
lanewise! {
    Add add |a, b| a + b;
    Sub sub |a, b| a - b;
    Mul mul |a, b| a * b;
    Div div |a, b| a / b;
}

impl<N: F32Lanes> Neg for ArrayF64<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for lane in &mut self.lanes {
            *lane = -*lane;
        }
        self
    }
}

impl<N: F32Lanes<Array = [f32; 8]>> F64Lanes for ArrayF64<N> {
    type Narrow = N;

    #[inline(always)]
    fn splat(token: N::Token, value: f64) -> Self {
        Self { lanes: [value; 8], token }
    }
    #[inline(always)]
    fn widen(from: N) -> Self {
        let mut narrow = [0.0; 8];
        from.store(&mut narrow);
        let mut lanes = [0.0; 8];
        for (lane, narrow) in lanes.iter_mut().zip(narrow) {
            *lane = f64::from(narrow);
        }
        Self { lanes, token: from.token() }
    }
    #[inline(always)]
    fn narrow(self) -> N {
        let mut narrow = [0.0; 8];
        for (narrow, lane) in narrow.iter_mut().zip(self.lanes) {
            *narrow = lane as f32;
        }
        N::load(self.token, &narrow)
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 8]) {
        *to = self.lanes;
    }
    #[inline(always)]
    fn lt(self, other: Self) -> N::Mask {
        let mut bits = 0;
        for i in 0..8 {
            bits |= u32::from(self.lanes[i] < other.lanes[i]) << i;
        }
        N::Mask::from_bits(self.token, bits)
    }
    #[inline(always)]
    fn min(mut self, other: Self) -> Self {
        for i in 0..8 {
            self.lanes[i] = if self.lanes[i] < other.lanes[i] { self.lanes[i] } else { other.lanes[i] };
        }
        self
    }
    #[inline(always)]
    fn max(mut self, other: Self) -> Self {
        for i in 0..8 {
            self.lanes[i] = if self.lanes[i] > other.lanes[i] { self.lanes[i] } else { other.lanes[i] };
        }
        self
    }
    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for lane in &mut self.lanes {
            *lane = lane.sqrt();
        }
        self
    }
}
