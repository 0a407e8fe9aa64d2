//! The vocabulary of kernels: what a token, a vector of lanes and a mask can do.

use crate::F64Lanes;
use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// A token: the proof that this CPU has an instruction set, and the names of its lane types.
///
/// Tokens are zero-sized; pass them by value. Data at rest has one shape for all instruction sets, so kernels ask for
/// the width that the data has (nodes of 16 children, leaf blocks of 8) and the token maps it to registers.
pub trait Simd: Copy + Send + Sync + Debug + 'static {
    /// Four floats.
    type F32x4: F32Lanes<Token = Self, Array = [f32; 4], U32: U32Lanes<Array = [u32; 4]>>;
    /// Eight floats.
    type F32x8: F32Lanes<Token = Self, Array = [f32; 8], U32: U32Lanes<Array = [u32; 8]>>;
    /// Sixteen floats.
    type F32x16: F32Lanes<Token = Self, Array = [f32; 16], U32: U32Lanes<Array = [u32; 16]>>;

    /// Eight doubles.
    type F64x8: F64Lanes<Narrow = Self::F32x8>;

    /// Short lower-case name as used by `--simd`: `scalar`, `sse4.2`, `avx2`, `avx512`.
    const NAME: &'static str;

    /// `(x, y, z, w)` to `(y, z, x, w)`, the turn that a cross product is made of.
    #[inline(always)]
    fn yzx(self, v: Self::F32x4) -> Self::F32x4 {
        let mut lanes = [0.0; 4];
        v.store(&mut lanes);
        let [x, y, z, w] = lanes;
        Self::F32x4::load(self, &[y, z, x, w])
    }

    /// Sixteen small integers as floats.
    #[inline(always)]
    fn shorts(self, from: &[u16; 16]) -> Self::F32x16 {
        let mut lanes = [0.0; 16];
        for (lane, &short) in lanes.iter_mut().zip(from) {
            *lane = f32::from(short);
        }
        Self::F32x16::load(self, &lanes)
    }

    /// The columns of eight rows: element `j` of row `i` becomes element `i` of column `j`. Bits are kept.
    #[inline(always)]
    fn transpose(self, rows: [Self::F32x8; 8]) -> [Self::F32x8; 8] {
        let (mut stored, mut columns) = ([[0.0; 8]; 8], [[0.0; 8]; 8]);
        for i in 0..8 {
            rows[i].store(&mut stored[i]);
        }
        for (i, row) in stored.iter().enumerate() {
            for (column, &element) in columns.iter_mut().zip(row) {
                column[i] = element;
            }
        }
        let mut out = rows;
        for i in 0..8 {
            out[i] = Self::F32x8::load(self, &columns[i]);
        }
        out
    }

    /// The columns of eight rows of four: eight records become lanes. Bits are kept.
    #[inline(always)]
    fn columns_x8(self, rows: [Self::F32x4; 8]) -> [Self::F32x8; 4] {
        let mut columns = [[0.0; 8]; 4];
        for i in 0..8 {
            let mut row = [0.0; 4];
            rows[i].store(&mut row);
            for (column, element) in columns.iter_mut().zip(row) {
                column[i] = element;
            }
        }
        let mut out = [Self::F32x8::splat(self, 0.0); 4];
        for i in 0..4 {
            out[i] = Self::F32x8::load(self, &columns[i]);
        }
        out
    }

    /// The columns of sixteen rows of four, see [`columns_x8`](Self::columns_x8).
    #[inline(always)]
    fn columns_x16(self, rows: [Self::F32x4; 16]) -> [Self::F32x16; 4] {
        let mut columns = [[0.0; 16]; 4];
        for i in 0..16 {
            let mut row = [0.0; 4];
            rows[i].store(&mut row);
            for (column, element) in columns.iter_mut().zip(row) {
                column[i] = element;
            }
        }
        let mut out = [Self::F32x16::splat(self, 0.0); 4];
        for i in 0..4 {
            out[i] = Self::F32x16::load(self, &columns[i]);
        }
        out
    }

    /// Append `ids[i]` to the front of `out` for every `i` with `masks[i] & bit != 0`, in order; return how many.
    ///
    /// The work of one child of a node in a stream walk. `masks` and `ids` have equal length.
    ///
    /// # Panics
    /// If the lengths differ, or `out` has fewer than `ids.len() + 32` elements. Elements of `out` beyond the returned
    /// count may be overwritten (whole registers are stored), which is what the 32 extra elements are for.
    #[inline(always)]
    fn append_matching(self, masks: &[u16], ids: &[u16], bit: u16, out: &mut [u16]) -> usize {
        assert!(masks.len() == ids.len() && out.len() >= ids.len() + 32);
        let mut count = 0;
        for (&mask, &id) in masks.iter().zip(ids) {
            out[count] = id;
            count += usize::from(mask & bit != 0);
        }
        count
    }

    /// Order the lanes of `mask` as `order` lists them and store their `keys` and `values` without gaps; return how
    /// many.
    ///
    /// `order` is a permutation of 0..16 (low four bits of each byte are used). Elements beyond the count may be
    /// overwritten.
    #[inline(always)]
    fn compress_in_order(
        self,
        mask: u16,
        order: &[u8; 16],
        keys: Self::F32x16,
        values: &[u32; 16],
        out_keys: &mut [f32; 16],
        out_values: &mut [u32; 16],
    ) -> usize {
        let mut stored = [0.0; 16];
        keys.store(&mut stored);
        let mut count = 0;
        for &lane in order {
            let lane = usize::from(lane & 15);
            // Store always, advance if set: the branch would be a coin toss. The last store is at 15 or before.
            out_keys[count & 15] = stored[lane];
            out_values[count & 15] = values[lane];
            count += usize::from(mask >> lane & 1 != 0);
        }
        count
    }
}

/// A vector of `f32`.
///
/// `+ - * /` and [`sqrt`](Self::sqrt) round to nearest even, like scalar `f32`; nothing is contracted.
pub trait F32Lanes:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Send
    + Sync
    + 'static
{
    /// The token that proves the instruction set.
    type Token: Simd;
    /// What a comparison yields.
    type Mask: MaskLanes<Token = Self::Token>;
    /// Integers of the same width.
    type U32: U32Lanes<Token = Self::Token, Mask = Self::Mask, F32 = Self>;
    /// The lanes in memory.
    type Array: Copy + Default + AsRef<[f32]> + AsMut<[f32]>;

    /// Number of lanes.
    const WIDTH: usize;

    /// The token that the lanes were made from.
    fn token(self) -> Self::Token;
    /// All lanes `value`.
    fn splat(token: Self::Token, value: f32) -> Self;
    /// The lanes of `from`, lane 0 first. No alignment needed.
    fn load(token: Self::Token, from: &Self::Array) -> Self;
    /// Write the lanes to `to`.
    fn store(self, to: &mut Self::Array);
    /// The first `WIDTH` elements of `from`. Panics if there are fewer.
    fn load_slice(token: Self::Token, from: &[f32]) -> Self;
    /// Write to the first `WIDTH` elements of `to`. Panics if there are fewer.
    fn store_slice(self, to: &mut [f32]);
    /// `table[index]` per lane. Panics if an index of any lane is out of range.
    fn gather(table: &[f32], index: Self::U32) -> Self;
    /// Three neighbours for each lane: `table[index][k]` in vector `k`. Panics if an index of any lane is out of range.
    #[inline(always)]
    fn gather_x3(table: &[[f32; 3]], index: Self::U32) -> [Self; 3] {
        gather_one_by_one(table, index)
    }
    /// Four neighbours for each lane, as [`gather_x3`](Self::gather_x3).
    #[inline(always)]
    fn gather_x4(table: &[[f32; 4]], index: Self::U32) -> [Self; 4] {
        gather_one_by_one(table, index)
    }

    /// Add to rows of a table, lane by lane where `mask` is set: `table[index][k] += addends[k]`, rounded toward zero.
    /// Sums that are too large stay at `i64::MAX`. Panics if an index of such a lane is out of range.
    ///
    /// Addends must be in 0 to 2⁶², and what is in the table not negative, else sums are unspecified.
    #[inline(always)]
    fn accumulate(addends: [Self; 4], mask: Self::Mask, index: Self::U32, table: &mut [[i64; 4]]) {
        let (mut numbers, mut rows) = (<Self::U32 as U32Lanes>::Array::default(), [Self::Array::default(); 4]);
        index.store(&mut numbers);
        for k in 0..4 {
            addends[k].store(&mut rows[k]);
        }
        let mut bits = mask.bits();
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize % Self::WIDTH;
            bits &= bits - 1;
            let sums = &mut table[numbers.as_ref()[lane] as usize];
            for k in 0..4 {
                sums[k] = sums[k].saturating_add(rows[k].as_ref()[lane] as i64);
            }
        }
    }

    /// `if self < other { self } else { other }` per lane: a NaN on either side gives `other`.
    fn min(self, other: Self) -> Self;
    /// `if self > other { self } else { other }` per lane: a NaN on either side gives `other`.
    fn max(self, other: Self) -> Self;
    /// Clear the sign bit.
    fn abs(self) -> Self;
    /// Correctly rounded square root; NaN below zero; `sqrt(-0) = -0`.
    fn sqrt(self) -> Self;
    /// `self * factor + addend` with exactly one rounding, on every instruction set (emulated where the hardware
    /// lacks it, which is slow).
    fn fma(self, factor: Self, addend: Self) -> Self;
    /// `self * factor + addend` with one rounding where that is fast, else two: only for conservative bounds.
    fn mul_add_fast(self, factor: Self, addend: Self) -> Self;
    /// Largest integral value not above; NaN, infinities and `|x| >= 2^23` are returned unchanged.
    fn floor(self) -> Self;
    /// Hardware estimate of `1 / self`, relative error at most 1.5·2⁻¹²; *differs between CPUs*.
    fn recip_approx(self) -> Self;
    /// Hardware estimate of `1 / sqrt(self)`, relative error at most 1.5·2⁻¹²; *differs between CPUs*.
    fn rsqrt_approx(self) -> Self;

    /// `self < other`; false for NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`; false for NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// `self == other`; false for NaN.
    fn eq(self, other: Self) -> Self::Mask;
    /// `self > other`; false for NaN.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// `self >= other`; false for NaN.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }
    /// `self` where the mask is set, else `other`.
    fn select(mask: Self::Mask, set: Self, unset: Self) -> Self;
    /// Store the lanes of `mask` at the front of `to`, in order and without gaps. The rest of the first `WIDTH` elements
    /// may be overwritten with anything. Panics if there are fewer.
    fn compress_store(self, mask: Self::Mask, to: &mut [f32]);

    /// The bits of the lanes.
    fn to_bits(self) -> Self::U32;
    /// Lanes from their bits.
    fn from_bits(bits: Self::U32) -> Self;
    /// Nearest integer, ties to even, as two's complement. Lanes must lie within ±2³⁰, else unspecified.
    fn round_to_int(self) -> Self::U32;
    /// Lanes of a two's complement integer, rounded to nearest even.
    fn from_int(value: Self::U32) -> Self;

    /// The sum of the lanes, by adding the upper half to the lower until one is left.
    fn reduce_add(self) -> f32;
    /// The smallest lane, by [`min`](Self::min) of the lower half with the upper until one is left (which settles
    /// the sign of a zero and what a NaN does).
    fn reduce_min(self) -> f32;
    /// The largest lane, by [`max`](Self::max) of the lower half with the upper until one is left.
    fn reduce_max(self) -> f32;
}

/// `table[index][k]` of each lane in vector `k`.
#[inline(always)]
fn gather_one_by_one<F: F32Lanes, const K: usize>(table: &[[f32; K]], index: F::U32) -> [F; K] {
    let mut numbers = <F::U32 as U32Lanes>::Array::default();
    index.store(&mut numbers);
    let mut columns = [F::Array::default(); K];
    for lane in 0..F::WIDTH {
        let row = table[numbers.as_ref()[lane] as usize];
        for k in 0..K {
            columns[k].as_mut()[lane] = row[k];
        }
    }
    let token = F::from_bits(index).token();
    let mut out = [F::splat(token, 0.0); K];
    for k in 0..K {
        out[k] = F::load(token, &columns[k]);
    }
    out
}

/// Numbers as floats of the same bits, which only move.
#[inline(always)]
fn as_floats(table: &[[u32; 3]]) -> &[[f32; 3]] {
    // SAFETY: the same size and alignment, and every pattern of bits is an f32.
    unsafe { std::slice::from_raw_parts(table.as_ptr().cast(), table.len()) }
}

/// A vector of `u32`; arithmetic wraps.
pub trait U32Lanes:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Not<Output = Self>
    + Send
    + Sync
    + 'static
{
    /// The token that proves the instruction set.
    type Token: Simd;
    /// What a comparison yields.
    type Mask: MaskLanes<Token = Self::Token>;
    /// Floats of the same width.
    type F32: F32Lanes<Token = Self::Token, U32 = Self>;
    /// The lanes in memory.
    type Array: Copy + Default + AsRef<[u32]> + AsMut<[u32]>;

    /// Number of lanes.
    const WIDTH: usize;

    /// All lanes `value`.
    fn splat(token: Self::Token, value: u32) -> Self;
    /// The lanes of `from`, lane 0 first. No alignment needed.
    fn load(token: Self::Token, from: &Self::Array) -> Self;
    /// Write the lanes to `to`.
    fn store(self, to: &mut Self::Array);
    /// The first `WIDTH` elements of `from`. Panics if there are fewer.
    fn load_slice(token: Self::Token, from: &[u32]) -> Self;
    /// Write to the first `WIDTH` elements of `to`. Panics if there are fewer.
    fn store_slice(self, to: &mut [u32]);
    /// `table[index]` per lane. Panics if an index of any lane is out of range.
    fn gather(table: &[u32], index: Self) -> Self;
    /// Three neighbours for each lane, see [`F32Lanes::gather_x3`].
    #[inline(always)]
    fn gather_x3(table: &[[u32; 3]], index: Self) -> [Self; 3] {
        let [a, b, c] = Self::F32::gather_x3(as_floats(table), index);
        [a.to_bits(), b.to_bits(), c.to_bits()]
    }

    /// Shift left by `N` bits (0 to 31).
    fn shl<const N: u32>(self) -> Self;
    /// Logical shift right by `N` bits (0 to 31).
    fn shr<const N: u32>(self) -> Self;
    /// Arithmetic (sign-filling) shift right by `N` bits (0 to 31).
    fn sar<const N: u32>(self) -> Self;

    /// `self == other`.
    fn eq(self, other: Self) -> Self::Mask;
    /// `self < other`, unsigned.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self` where the mask is set, else `other`.
    fn select(mask: Self::Mask, set: Self, unset: Self) -> Self;

    /// Store the lanes of `mask` at the front of `to`, in order and without gaps. The rest of the first `WIDTH` elements
    /// may be overwritten with anything. Panics if there are fewer.
    fn compress_store(self, mask: Self::Mask, to: &mut [u32]);
}

/// One truth value per lane.
pub trait MaskLanes:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
    /// The token that proves the instruction set.
    type Token: Simd;

    /// Number of lanes.
    const WIDTH: usize;

    /// Bit `i` is lane `i`; bits from `WIDTH` up are zero.
    fn bits(self) -> u32;
    /// Lane `i` is bit `i`; higher bits are ignored.
    fn from_bits(token: Self::Token, bits: u32) -> Self;
    /// True if any lane is set.
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
    /// True if every lane is set.
    #[inline(always)]
    fn all(self) -> bool {
        self.bits() == u32::MAX >> (32 - Self::WIDTH)
    }
}
