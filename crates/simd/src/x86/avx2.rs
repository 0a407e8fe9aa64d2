//! AVX2 with FMA: eight lanes a register.

use super::avx2_x8::F32x8;
use super::left_pack;
use super::x4::{F32x4, Sse};
use crate::Simd;
use crate::pair::Pair;
use std::arch::x86_64::*;

token! {
    /// The token of AVX2 with FMA and the bit manipulation that came with them (x86-64-v3).
    Avx2: "avx2" "fma" "bmi1" "bmi2" "lzcnt" "movbe" "f16c" "popcnt"
}

impl Simd for Avx2 {
    type F32x4 = F32x4<Self>;
    type F32x8 = F32x8;
    type F32x16 = Pair<F32x8>;
    type F64x8 = super::double::F64x4x2;
    const NAME: &'static str = "avx2";

    #[inline(always)]
    fn yzx(self, v: F32x4<Self>) -> F32x4<Self> {
        v.yzx()
    }
    #[inline(always)]
    fn shorts(self, from: &[u16; 16]) -> Pair<F32x8> {
        // SAFETY: the token exists; the array is as long as the register that is read.
        let (low, high) = unsafe {
            let low = _mm_loadu_si128(from.as_ptr().cast());
            let high = _mm_loadu_si128(from.as_ptr().add(8).cast());
            (_mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(low)), _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(high)))
        };
        Pair(F32x8::wrap(low, self), F32x8::wrap(high, self))
    }
    transposes!();
    #[inline(always)]
    fn columns_x16(self, rows: [F32x4<Self>; 16]) -> [Pair<F32x8>; 4] {
        let (low, high) = rows.split_at(8);
        let [a, b, c, d] = self.columns_x8(*low.first_chunk().expect("half of the rows"));
        let [e, f, g, h] = self.columns_x8(*high.first_chunk().expect("half of the rows"));
        [Pair(a, e), Pair(b, f), Pair(c, g), Pair(d, h)]
    }
    #[inline(always)]
    fn append_matching(self, masks: &[u16], ids: &[u16], bit: u16, out: &mut [u16]) -> usize {
        left_pack::append_matching(self, masks, ids, bit, out)
    }
    #[inline(always)]
    fn compress_in_order(
        self,
        mask: u16,
        order: &[u8; 16],
        keys: Pair<F32x8>,
        values: &[u32; 16],
        out_keys: &mut [f32; 16],
        out_values: &mut [u32; 16],
    ) -> usize {
        left_pack::compress_in_order(mask, order, keys, values, out_keys, out_values)
    }
}

sse_with_fma!(Avx2);
