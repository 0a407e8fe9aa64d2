//! The four-wide vector of the paper: one point or direction in one register.

use crate::{F32Lanes, Simd};
use std::ops::{Add, Mul, Sub};

/// `(x, y, z, w)`, aligned for its register.
///
/// With [`Scalar`](crate::Scalar) it is the plain twin that the register version is measured against (the paper's
/// Tables 3 and 4). The renderer's production walks give each lane another ray or box instead.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub struct Vec4<S: Simd>(S::F32x4, S);

const _: () = assert!(size_of::<Vec4<crate::Scalar>>() == 16);

impl<S: Simd> Vec4<S> {
    /// The vector of four components.
    #[inline(always)]
    pub fn new(token: S, components: [f32; 4]) -> Self {
        Self(S::F32x4::load(token, &components), token)
    }

    /// `(x, y, z, w)`.
    #[inline(always)]
    pub fn components(self) -> [f32; 4] {
        let mut components = [0.0; 4];
        self.0.store(&mut components);
        components
    }

    /// `(x·x' + y·y') + z·z'`: bit by bit the dot product of plain arithmetic; `w` does not count.
    #[inline(always)]
    pub fn dot(self, other: Self) -> f32 {
        let products = self.0 * other.0;
        let turned = self.1.yzx(products);
        Self(products + turned + self.1.yzx(turned), self.1).components()[0]
    }

    /// The cross product of the first three components; `w` is 0 if that of both operands is finite.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        let token = self.1;
        // As (z, x, y), which a last turn puts right: three shuffles instead of four.
        let turned_back = self.0 * token.yzx(other.0) - token.yzx(self.0) * other.0;
        Self(token.yzx(turned_back), token)
    }

    /// Unit vector by square root and division; NaN for the zero vector.
    #[inline(always)]
    pub fn normalize(self) -> Self {
        Self(self.0 / self.length_squared().sqrt(), self.1)
    }

    /// Unit vector by the hardware's estimate of `1/√x` and one Newton step: length off by 2⁻²⁰ at most, *different
    /// bits on different CPUs*; NaN for the zero vector.
    #[inline(always)]
    pub fn normalize_approx(self) -> Self {
        Self(self.0 * Self(self.length_squared(), self.1).rsqrt_refined(), self.1)
    }

    /// Unit vector by the hardware's estimate of `1/√x` alone: length off by 1.5·2⁻¹² at most, *different bits on
    /// different CPUs*; NaN for the zero vector.
    #[inline(always)]
    pub fn normalize_rsqrt(self) -> Self {
        Self(self.0 * self.length_squared().rsqrt_approx(), self.1)
    }

    /// The square root of each component by the hardware's estimate of `1/√x` and one Newton step: off by 2⁻²⁰ at most,
    /// *different bits on different CPUs*; NaN for zero and below.
    #[inline(always)]
    pub fn sqrt_approx(self) -> Self {
        Self(self.0 * self.rsqrt_refined(), self.1)
    }

    /// The estimate of `1/√x` after one Newton step, which doubles its twelve bits.
    #[inline(always)]
    fn rsqrt_refined(self) -> S::F32x4 {
        let estimate = self.0.rsqrt_approx();
        let c = |value| S::F32x4::splat(self.1, value);
        estimate * (c(1.5) - c(0.5) * self.0 * estimate * estimate)
    }

    #[inline(always)]
    fn length_squared(self) -> S::F32x4 {
        S::F32x4::splat(self.1, self.dot(self))
    }
}

impl<S: Simd> Mul<f32> for Vec4<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, scale: f32) -> Self {
        Self(self.0 * S::F32x4::splat(self.1, scale), self.1)
    }
}

macro_rules! componentwise {
    ($($trait:ident $name:ident)*) => {$(
        impl<S: Simd> $trait for Vec4<S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self($trait::$name(self.0, other.0), self.1)
            }
        }
    )*};
}
componentwise! { Add add Sub sub Mul mul }
