//! Twice as many lanes from two vectors: how an instruction set gets the widths that it has no register for.

use crate::{F32Lanes, MaskLanes, U32Lanes};
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// Two vectors as one; `.0` holds the lower lanes. Floats, integers or masks, as `V` is.
#[derive(Clone, Copy, Debug)]
pub struct Pair<V>(pub(crate) V, pub(crate) V);

/// An array type and the one of twice its length.
pub trait Double {
    /// Twice as many elements.
    type Twice;
}

macro_rules! double {
    ($($element:ident $half:literal $whole:literal),*) => {$(
        impl Double for [$element; $half] {
            type Twice = [$element; $whole];
        }
    )*};
}
double!(f32 4 8, f32 8 16, u32 4 8, u32 8 16);

macro_rules! operators {
    ($($trait:ident $name:ident($($other:ident)?);)*) => {$(
        impl<V: $trait<Output = V>> $trait for Pair<V> {
            type Output = Self;
            #[inline(always)]
            fn $name(self $(, $other: Self)?) -> Self {
                Self($trait::$name(self.0 $(, $other.0)?), $trait::$name(self.1 $(, $other.1)?))
            }
        }
    )*};
}
operators! {
    Add add(other);
    Sub sub(other);
    Mul mul(other);
    Div div(other);
    Neg neg();
    BitAnd bitand(other);
    BitOr bitor(other);
    BitXor bitxor(other);
    Not not();
}

/// Methods that act on each half.
macro_rules! halves {
    ($($name:ident($($other:ident: $type:ty),*) -> $out:ty;)*) => {$(
        #[inline(always)]
        fn $name(self $(, $other: $type)*) -> $out {
            Pair(self.0.$name($($other.0),*), self.1.$name($($other.1),*))
        }
    )*};
}

/// Methods that floats and integers share.
macro_rules! vector {
    ($element:ident) => {
        const WIDTH: usize = 2 * V::WIDTH;

        #[inline(always)]
        fn splat(token: V::Token, value: $element) -> Self {
            Self(V::splat(token, value), V::splat(token, value))
        }
        #[inline(always)]
        fn load(token: V::Token, from: &Self::Array) -> Self {
            Self::load_slice(token, from.as_ref())
        }
        #[inline(always)]
        fn store(self, to: &mut Self::Array) {
            self.store_slice(to.as_mut());
        }
        #[inline(always)]
        fn load_slice(token: V::Token, from: &[$element]) -> Self {
            let (low, high) = from.split_at(V::WIDTH);
            Self(V::load_slice(token, low), V::load_slice(token, high))
        }
        #[inline(always)]
        fn store_slice(self, to: &mut [$element]) {
            let (low, high) = to.split_at_mut(V::WIDTH);
            self.0.store_slice(low);
            self.1.store_slice(high);
        }
        #[inline(always)]
        fn select(mask: Self::Mask, set: Self, unset: Self) -> Self {
            Self(V::select(mask.0, set.0, unset.0), V::select(mask.1, set.1, unset.1))
        }
        #[inline(always)]
        fn compress_store(self, mask: Self::Mask, to: &mut [$element]) {
            // The upper half begins where the lower one ends, at its width or before.
            let (low, to) = (mask.0.bits().count_ones() as usize, &mut to[..Self::WIDTH]);
            self.0.compress_store(mask.0, to);
            self.1.compress_store(mask.1, &mut to[low..]);
        }
    };
}

impl<V: F32Lanes> F32Lanes for Pair<V>
where
    V::Array: Double<Twice: Copy + Default + AsRef<[f32]> + AsMut<[f32]>>,
    <V::U32 as U32Lanes>::Array: Double<Twice: Copy + Default + AsRef<[u32]> + AsMut<[u32]>>,
{
    type Token = V::Token;
    type Mask = Pair<V::Mask>;
    type U32 = Pair<V::U32>;
    type Array = <V::Array as Double>::Twice;

    #[inline(always)]
    fn token(self) -> Self::Token {
        self.0.token()
    }
    vector!(f32);
    halves! {
        min(other: Self) -> Self;
        max(other: Self) -> Self;
        abs() -> Self;
        sqrt() -> Self;
        fma(factor: Self, addend: Self) -> Self;
        mul_add_fast(factor: Self, addend: Self) -> Self;
        floor() -> Self;
        recip_approx() -> Self;
        rsqrt_approx() -> Self;
        lt(other: Self) -> Self::Mask;
        le(other: Self) -> Self::Mask;
        eq(other: Self) -> Self::Mask;
        to_bits() -> Self::U32;
        round_to_int() -> Self::U32;
    }
    #[inline(always)]
    fn gather(table: &[f32], index: Self::U32) -> Self {
        Self(V::gather(table, index.0), V::gather(table, index.1))
    }
    #[inline(always)]
    fn gather_x3(table: &[[f32; 3]], index: Self::U32) -> [Self; 3] {
        let [a, b, c] = V::gather_x3(table, index.0);
        let [d, e, f] = V::gather_x3(table, index.1);
        [Self(a, d), Self(b, e), Self(c, f)]
    }
    #[inline(always)]
    fn gather_x4(table: &[[f32; 4]], index: Self::U32) -> [Self; 4] {
        let [a, b, c, d] = V::gather_x4(table, index.0);
        let [e, f, g, h] = V::gather_x4(table, index.1);
        [Self(a, e), Self(b, f), Self(c, g), Self(d, h)]
    }
    #[inline(always)]
    fn from_bits(bits: Self::U32) -> Self {
        Self(V::from_bits(bits.0), V::from_bits(bits.1))
    }
    #[inline(always)]
    fn from_int(value: Self::U32) -> Self {
        Self(V::from_int(value.0), V::from_int(value.1))
    }
    #[inline(always)]
    fn reduce_add(self) -> f32 {
        (self.0 + self.1).reduce_add()
    }
    #[inline(always)]
    fn reduce_min(self) -> f32 {
        self.0.min(self.1).reduce_min()
    }
    #[inline(always)]
    fn reduce_max(self) -> f32 {
        self.0.max(self.1).reduce_max()
    }
}

impl<V: U32Lanes> U32Lanes for Pair<V>
where
    V::Array: Double<Twice: Copy + Default + AsRef<[u32]> + AsMut<[u32]>>,
    <V::F32 as F32Lanes>::Array: Double<Twice: Copy + Default + AsRef<[f32]> + AsMut<[f32]>>,
    V::F32: F32Lanes<Mask = V::Mask>,
{
    type Token = V::Token;
    type Mask = Pair<V::Mask>;
    type F32 = Pair<V::F32>;
    type Array = <V::Array as Double>::Twice;

    vector!(u32);
    halves! {
        eq(other: Self) -> Self::Mask;
        lt(other: Self) -> Self::Mask;
    }
    #[inline(always)]
    fn gather(table: &[u32], index: Self) -> Self {
        Self(V::gather(table, index.0), V::gather(table, index.1))
    }
    #[inline(always)]
    fn shl<const N: u32>(self) -> Self {
        Self(self.0.shl::<N>(), self.1.shl::<N>())
    }
    #[inline(always)]
    fn shr<const N: u32>(self) -> Self {
        Self(self.0.shr::<N>(), self.1.shr::<N>())
    }
    #[inline(always)]
    fn sar<const N: u32>(self) -> Self {
        Self(self.0.sar::<N>(), self.1.sar::<N>())
    }
}

impl<M: MaskLanes> MaskLanes for Pair<M> {
    type Token = M::Token;
    const WIDTH: usize = 2 * M::WIDTH;

    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.bits() | self.1.bits() << M::WIDTH
    }
    #[inline(always)]
    fn from_bits(token: M::Token, bits: u32) -> Self {
        Self(M::from_bits(token, bits), M::from_bits(token, bits >> M::WIDTH))
    }
    #[inline(always)]
    fn any(self) -> bool {
        (self.0 | self.1).any()
    }
    #[inline(always)]
    fn all(self) -> bool {
        (self.0 & self.1).all()
    }
}
