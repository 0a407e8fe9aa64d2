//! The operations on lists and tables that a token has: appending, compressing, transposing.

use crate::common::{ForLanes, SplitMix64, for_widths, levels};
use simd::{F32Lanes, Kernel, Level, MaskLanes, Simd, U32Lanes, dispatch};

struct Append<'a>(&'a [u16], &'a [u16], u16, &'a mut [u16]);

impl Kernel for Append<'_> {
    type Output = usize;
    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> usize {
        token.append_matching(self.0, self.1, self.2, self.3)
    }
}

#[test]
fn append_keeps_order_and_bounds() {
    let mut random = SplitMix64(5);
    for level in levels() {
        for length in (0..200).chain([4095, 4096]) {
            let density = random.next_u32() | random.next_u32();
            let masks: Vec<u16> = (0..length).map(|_| (random.next_u32() & density) as u16).collect();
            let ids: Vec<u16> = (0..length).map(|_| random.next_u32() as u16).collect();
            for bit in (0..16).map(|i| 1 << i) {
                let kept = |i: &usize| masks[*i] & bit != 0;
                let expected: Vec<u16> = (0..length).filter(kept).map(|i| ids[i]).collect();
                let mut out = vec![7; length + 40];
                let count = dispatch(level, Append(&masks, &ids, bit, &mut out[..length + 32]));
                assert_eq!(&out[..count], expected, "{level} {length} {bit}");
                assert_eq!(out[length + 32..], [7; 8], "{level} wrote beyond its output");
            }
        }
    }
}

#[test]
fn append_refuses_short_outputs() {
    for level in levels() {
        for (masks, ids, out) in [(40, 40, 71), (40, 39, 100), (0, 0, 31)] {
            let (masks, ids, mut out) = (vec![1; masks], vec![1; ids], vec![0; out]);
            let run = std::panic::AssertUnwindSafe(|| dispatch(level, Append(&masks, &ids, 1, &mut out)));
            assert!(std::panic::catch_unwind(run).is_err(), "{level}");
        }
    }
}

struct Compress<'a>(u16, &'a [u8; 16], &'a [f32; 16], &'a [u32; 16]);

impl Kernel for Compress<'_> {
    type Output = (usize, [f32; 16], [u32; 16]);
    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Self::Output {
        let (mut keys, mut values) = ([0.0; 16], [0; 16]);
        let lanes = S::F32x16::load(token, self.2);
        let count = token.compress_in_order(self.0, self.1, lanes, self.3, &mut keys, &mut values);
        (count, keys, values)
    }
}

fn check_compress(level: Level, mask: u16, random: &mut SplitMix64) {
    let mut order: [u8; 16] = std::array::from_fn(|i| i as u8);
    for i in (1..16).rev() {
        order.swap(i, random.next_u32() as usize % (i + 1));
    }
    let keys: [f32; 16] = std::array::from_fn(|_| random.next_f32());
    let values: [u32; 16] = std::array::from_fn(|_| random.next_u32());
    let kept: Vec<usize> = order.iter().map(|&i| usize::from(i)).filter(|i| mask >> i & 1 != 0).collect();
    // The upper four bits of an order are ignored.
    let order = order.map(|i| i | (random.next_u32() as u8) << 4);
    let (count, out_keys, out_values) = dispatch(level, Compress(mask, &order, &keys, &values));
    assert_eq!(count, kept.len(), "{level}");
    for (at, i) in kept.into_iter().enumerate() {
        assert_eq!((out_keys[at], out_values[at]), (keys[i], values[i]), "{level} {mask:#x} {order:?}");
    }
}

#[test]
fn compress_follows_the_order() {
    let mut random = SplitMix64(6);
    for level in levels() {
        for mask in 0..=u16::MAX {
            check_compress(level, mask, &mut random);
        }
    }
}

struct Shorts([u16; 16]);

impl Kernel for Shorts {
    type Output = [f32; 16];
    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> [f32; 16] {
        let mut out = [0.0; 16];
        token.shorts(&self.0).store(&mut out);
        out
    }
}

#[test]
fn shorts_become_floats() {
    for level in levels() {
        for first in (0..=65535).step_by(16) {
            let shorts: [u16; 16] = std::array::from_fn(|i| (first + i) as u16);
            assert_eq!(dispatch(level, Shorts(shorts)), shorts.map(f32::from), "{level}");
        }
    }
}

struct Transpose([[f32; 8]; 8]);

impl Kernel for Transpose {
    type Output = [[f32; 8]; 8];
    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Self::Output {
        let columns = token.transpose(self.0.map(|row| S::F32x8::load(token, &row)));
        columns.map(stored)
    }
}

struct ColumnsX8([[f32; 4]; 8]);

impl Kernel for ColumnsX8 {
    type Output = [[f32; 8]; 4];
    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Self::Output {
        let columns = token.columns_x8(self.0.map(|row| S::F32x4::load(token, &row)));
        columns.map(stored)
    }
}

struct ColumnsX16([[f32; 4]; 16]);

impl Kernel for ColumnsX16 {
    type Output = [[f32; 16]; 4];
    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Self::Output {
        let columns = token.columns_x16(self.0.map(|row| S::F32x4::load(token, &row)));
        columns.map(stored)
    }
}

fn stored<const N: usize, F: F32Lanes<Array = [f32; N]>>(lanes: F) -> [f32; N] {
    let mut out = [0.0; N];
    lanes.store(&mut out);
    out
}

#[test]
fn rows_become_columns() {
    let square: [[f32; 8]; 8] = std::array::from_fn(|i| std::array::from_fn(|j| (10 * i + j) as f32));
    let tall: [[f32; 4]; 8] = std::array::from_fn(|i| std::array::from_fn(|j| (10 * i + j) as f32));
    let taller: [[f32; 4]; 16] = std::array::from_fn(|i| std::array::from_fn(|j| (10 * i + j) as f32));
    for level in levels() {
        let columns = dispatch(level, Transpose(square));
        assert!((0..8).all(|i| (0..8).all(|j| columns[j][i] == square[i][j])), "{level}: {columns:?}");
        let columns = dispatch(level, ColumnsX8(tall));
        assert!((0..8).all(|i| (0..4).all(|j| columns[j][i] == tall[i][j])), "{level}: {columns:?}");
        let columns = dispatch(level, ColumnsX16(taller));
        assert!((0..16).all(|i| (0..4).all(|j| columns[j][i] == taller[i][j])), "{level}: {columns:?}");
    }
}

#[test]
fn transposing_keeps_bits() {
    let signalling = f32::from_bits(0x7f80_0001);
    for level in levels() {
        for bits in [1, 2, signalling.to_bits(), u32::MAX] {
            let columns = dispatch(level, Transpose([[f32::from_bits(bits); 8]; 8]));
            assert!(columns.as_flattened().iter().all(|lane| lane.to_bits() == bits), "{level} {bits:#x}");
        }
    }
}

struct CompressStore;

impl ForLanes for CompressStore {
    fn run<F: F32Lanes>(&self, token: F::Token) {
        let (values, numbers): ([f32; 16], [u32; 16]) =
            (std::array::from_fn(|i| i as f32), std::array::from_fn(|i| i as u32));
        let (values_in, numbers_in) = (F::load_slice(token, &values), F::U32::load_slice(token, &numbers));
        for bits in 0..1u32 << F::WIDTH {
            let mask = F::Mask::from_bits(token, bits);
            let (mut values_out, mut numbers_out) = ([-1.0; 17], [99; 17]);
            values_in.compress_store(mask, &mut values_out[..F::WIDTH]);
            numbers_in.compress_store(mask, &mut numbers_out[..F::WIDTH]);
            let kept: Vec<u32> = (0..F::WIDTH as u32).filter(|i| bits >> i & 1 != 0).collect();
            assert_eq!(numbers_out[..kept.len()], kept, "{bits:#x}");
            assert!(values_out.iter().zip(&kept).all(|(&value, &lane)| value == lane as f32), "{bits:#x}");
            assert_eq!((values_out[F::WIDTH], numbers_out[F::WIDTH]), (-1.0, 99), "{bits:#x}");
        }
    }
}

#[test]
fn compress_store_keeps_order_and_bounds() {
    for level in levels() {
        for_widths(level, &CompressStore);
    }
}
