//! Three numbers: a point, a direction or a colour; scalar or lanes by type parameter.

use simd::F32Lanes;
use std::ops::{Add, AddAssign, Div, Index, Mul, MulAssign, Neg, Sub};

/// Three components of one type: `f32`, `f64` or SIMD lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Vec3<T> {
    /// First component (red).
    pub x: T,
    /// Second component (green).
    pub y: T,
    /// Third component (blue).
    pub z: T,
}

/// Three `f32`.
pub type Vec3f = Vec3<f32>;
/// Three `f64`.
pub type Vec3d = Vec3<f64>;

impl<T> Vec3<T> {
    /// The vector `(x, y, z)`.
    #[inline(always)]
    pub const fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }
}

impl<T: Copy> Vec3<T> {
    /// All components `value`.
    #[inline(always)]
    pub fn splat(value: T) -> Self {
        Self::new(value, value, value)
    }

    /// The components in order.
    #[inline(always)]
    pub fn to_array(self) -> [T; 3] {
        [self.x, self.y, self.z]
    }

    /// `f` of each component.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Vec3<U> {
        Vec3::new(f(self.x), f(self.y), f(self.z))
    }

    /// `f` of each pair of components.
    #[inline(always)]
    pub fn zip<U: Copy, V>(self, other: Vec3<U>, mut f: impl FnMut(T, U) -> V) -> Vec3<V> {
        Vec3::new(f(self.x, other.x), f(self.y, other.y), f(self.z, other.z))
    }
}

impl<L: F32Lanes> Vec3<L> {
    /// `value` in all lanes.
    #[inline(always)]
    pub(crate) fn lanes(token: L::Token, value: Vec3f) -> Self {
        Self::new(L::splat(token, value.x), L::splat(token, value.y), L::splat(token, value.z))
    }

    /// The largest component by [`F32Lanes::max`].
    #[inline(always)]
    pub(crate) fn largest(self) -> L {
        self.x.max(self.y).max(self.z)
    }
}

impl<T: Copy + Mul<Output = T> + Add<Output = T>> Vec3<T> {
    /// `x·x' + y·y' + z·z'`, summed in this order.
    #[inline(always)]
    pub fn dot(self, other: Self) -> T {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// The dot product with itself.
    #[inline(always)]
    pub fn length_squared(self) -> T {
        self.dot(self)
    }
}

impl<T: Copy + Mul<Output = T> + Sub<Output = T>> Vec3<T> {
    /// The cross product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }
}

/// `set` in the lanes of `mask`, else `unset`.
#[inline(always)]
pub(crate) fn select<L: F32Lanes>(mask: L::Mask, set: Vec3<L>, unset: Vec3<L>) -> Vec3<L> {
    Vec3::new(L::select(mask, set.x, unset.x), L::select(mask, set.y, unset.y), L::select(mask, set.z, unset.z))
}

impl<T: Copy + Mul<Output = T>> Vec3<T> {
    /// Component-wise product.
    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl<T> From<[T; 3]> for Vec3<T> {
    #[inline(always)]
    fn from([x, y, z]: [T; 3]) -> Self {
        Self::new(x, y, z)
    }
}

impl<T: Add<Output = T>> Add for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<T: Sub<Output = T>> Sub for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<T: Neg<Output = T>> Neg for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<T: Copy + Mul<Output = T>> Mul<T> for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, scale: T) -> Self {
        Self::new(self.x * scale, self.y * scale, self.z * scale)
    }
}

impl<T: Copy + Div<Output = T>> Div<T> for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, divisor: T) -> Self {
        Self::new(self.x / divisor, self.y / divisor, self.z / divisor)
    }
}

impl<T: Copy + Add<Output = T>> AddAssign for Vec3<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Copy + Mul<Output = T>> MulAssign<T> for Vec3<T> {
    #[inline(always)]
    fn mul_assign(&mut self, scale: T) {
        *self = *self * scale;
    }
}

impl<T> Index<usize> for Vec3<T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, axis: usize) -> &T {
        match axis {
            0 => &self.x,
            1 => &self.y,
            _ => &self.z,
        }
    }
}

macro_rules! float_vec3 {
    ($float:ident) => {
        impl Vec3<$float> {
            /// The zero vector.
            pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);
            /// All ones.
            pub const ONE: Self = Self::new(1.0, 1.0, 1.0);

            /// Euclidean length.
            #[inline(always)]
            pub fn length(self) -> $float {
                self.length_squared().sqrt()
            }

            /// The vector divided by its length; not finite for a zero vector.
            #[inline(always)]
            pub fn normalize(self) -> Self {
                self / self.length()
            }

            /// Component-wise minimum; a NaN in `self` gives the other's component.
            #[inline(always)]
            pub fn min(self, other: Self) -> Self {
                self.zip(other, |a, b| if a < b { a } else { b })
            }

            /// Component-wise maximum; a NaN in `self` gives the other's component.
            #[inline(always)]
            pub fn max(self, other: Self) -> Self {
                self.zip(other, |a, b| if a > b { a } else { b })
            }

            /// Component-wise absolute value.
            #[inline(always)]
            pub fn abs(self) -> Self {
                self.map(<$float>::abs)
            }

            /// The largest component; NaN components are passed over unless all are NaN.
            #[inline(always)]
            pub fn max_component(self) -> $float {
                self.x.max(self.y).max(self.z)
            }

            /// The smallest component; NaN components are passed over unless all are NaN.
            #[inline(always)]
            pub fn min_component(self) -> $float {
                self.x.min(self.y).min(self.z)
            }

            /// True if no component is infinite or NaN.
            #[inline(always)]
            pub fn is_finite(self) -> bool {
                self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
            }
        }
    };
}

float_vec3!(f32);
float_vec3!(f64);

impl Vec3f {
    /// The same values in double precision.
    #[inline(always)]
    pub fn to_f64(self) -> Vec3d {
        self.map(f64::from)
    }
}

impl Vec3d {
    /// The unit vector along this one, whatever its length: neither overflows nor underflows on the way. Not finite for
    /// a zero vector and where a component is not finite.
    pub fn direction(self) -> Self {
        (self / self.abs().max_component()).normalize()
    }

    /// Rounded to single precision.
    #[inline(always)]
    pub fn to_f32(self) -> Vec3f {
        self.map(|a| a as f32)
    }
}
