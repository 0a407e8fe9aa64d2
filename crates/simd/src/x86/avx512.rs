//! AVX-512 (F, BW, CD, DQ, VL, VBMI2): sixteen lanes a register, masks in registers of their own.

use super::avx512_x8::F32x8;
use super::avx512_x16::F32x16;
use super::x4::{F32x4, Sse};
use crate::Simd;
use std::arch::x86_64::*;

token! {
    /// The token of AVX-512 as Ice Lake (2019) and Zen 4 (2022) have it: F, BW, CD, DQ, VL and VBMI2.
    Avx512: "avx512f" "avx512bw" "avx512cd" "avx512dq" "avx512vl" "avx512vbmi2"
            "avx2" "fma" "bmi1" "bmi2" "lzcnt" "movbe" "f16c" "popcnt"
}

/// 16-bit elements per register.
const STEP: usize = 32;

impl Simd for Avx512 {
    type F32x4 = F32x4<Self>;
    type F32x8 = F32x8;
    type F32x16 = F32x16;
    type F64x8 = super::double::F64x8;
    const NAME: &'static str = "avx512";

    #[inline(always)]
    fn yzx(self, v: F32x4<Self>) -> F32x4<Self> {
        v.yzx()
    }
    #[inline(always)]
    fn shorts(self, from: &[u16; 16]) -> F32x16 {
        // SAFETY: the token exists; the array is as long as the register that is read.
        let lanes = unsafe { _mm512_cvtepi32_ps(_mm512_cvtepu16_epi32(_mm256_loadu_si256(from.as_ptr().cast()))) };
        F32x16::wrap(lanes, self)
    }
    transposes!();
    #[inline(always)]
    fn columns_x16(self, rows: [F32x4<Self>; 16]) -> [F32x16; 4] {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = rows;
        let rows = [[a.0, e.0, i.0, m.0], [b.0, f.0, j.0, n.0], [c.0, g.0, k.0, o.0], [d.0, h.0, l.0, p.0]];
        // SAFETY: the token exists, so the CPU has its features.
        let [x, y, z, w] = unsafe { super::transpose::transpose_16x4(rows) };
        [F32x16::wrap(x, self), F32x16::wrap(y, self), F32x16::wrap(z, self), F32x16::wrap(w, self)]
    }
    #[inline(always)]
    fn append_matching(self, masks: &[u16], ids: &[u16], bit: u16, out: &mut [u16]) -> usize {
        assert!(masks.len() == ids.len() && out.len() >= ids.len() + STEP);
        let (mask_steps, mask_rest) = masks.as_chunks::<STEP>();
        let (id_steps, id_rest) = ids.as_chunks::<STEP>();
        let mut count = 0;
        for (masks, ids) in mask_steps.iter().zip(id_steps) {
            // SAFETY: the token exists. Both chunks fill a register. `count` is at most the number of ids read so far,
            // so a register stored there ends before `ids.len() + STEP`, which `out` has (asserted above).
            unsafe {
                let masks = _mm512_loadu_epi16(masks.as_ptr().cast());
                let ids = _mm512_loadu_epi16(ids.as_ptr().cast());
                count += append_register(masks, ids, bit, out.as_mut_ptr().add(count));
            }
        }
        let rest = (1 << mask_rest.len()) - 1;
        // SAFETY: as above; only lanes that exist are read, and lanes not read match no bit.
        unsafe {
            let masks = _mm512_maskz_loadu_epi16(rest, mask_rest.as_ptr().cast());
            let ids = _mm512_maskz_loadu_epi16(rest, id_rest.as_ptr().cast());
            count + append_register(masks, ids, bit, out.as_mut_ptr().add(count))
        }
    }

    #[inline(always)]
    fn compress_in_order(
        self,
        mask: u16,
        order: &[u8; 16],
        keys: F32x16,
        values: &[u32; 16],
        out_keys: &mut [f32; 16],
        out_values: &mut [u32; 16],
    ) -> usize {
        // SAFETY: the token exists; every array is as long as the register that is read or written.
        unsafe {
            // A permutation by 32-bit lanes uses the low four bits of its index.
            let order = _mm512_cvtepu8_epi32(_mm_loadu_si128(order.as_ptr().cast()));
            let lane_bit = _mm512_sllv_epi32(_mm512_set1_epi32(1), _mm512_and_si512(order, _mm512_set1_epi32(15)));
            let set = _mm512_test_epi32_mask(_mm512_set1_epi32(i32::from(mask)), lane_bit);
            let keys = _mm512_permutexvar_ps(order, keys.0);
            let values = _mm512_permutexvar_epi32(order, _mm512_loadu_epi32(values.as_ptr().cast()));
            // Compress to registers and store whole ones: compressing to memory is slow on Zen 4.
            _mm512_storeu_ps(out_keys.as_mut_ptr(), _mm512_maskz_compress_ps(set, keys));
            _mm512_storeu_epi32(out_values.as_mut_ptr().cast(), _mm512_maskz_compress_epi32(set, values));
        }
        mask.count_ones() as usize
    }
}

/// Store the lanes of `ids` whose lane of `masks` has `bit`, without gaps; return how many.
///
/// # Safety
/// The CPU must have the features of [`Avx512`], and `to` must be good for writing `STEP` elements.
#[inline(always)]
unsafe fn append_register(masks: __m512i, ids: __m512i, bit: u16, to: *mut u16) -> usize {
    // SAFETY: by this function's contract.
    unsafe {
        let set = _mm512_test_epi16_mask(masks, _mm512_set1_epi16(bit as i16));
        _mm512_storeu_epi16(to.cast(), _mm512_maskz_compress_epi16(set, ids));
        set.count_ones() as usize
    }
}

sse_with_fma!(Avx512);
