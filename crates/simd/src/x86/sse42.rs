//! SSE4.2: four lanes a register, no fused multiply-add.

use super::left_pack;
use super::x4::{F32x4, Sse};
use crate::Simd;
use crate::pair::Pair;
use std::arch::x86_64::*;

token! {
    /// The token of SSE4.2.
    Sse42: "sse3" "ssse3" "sse4.1" "sse4.2" "popcnt"
}

impl Simd for Sse42 {
    type F32x4 = F32x4<Self>;
    type F32x8 = Pair<F32x4<Self>>;
    type F32x16 = Pair<Pair<F32x4<Self>>>;
    type F64x8 = crate::ArrayF64<Pair<F32x4<Self>>>;
    const NAME: &'static str = "sse4.2";

    #[inline(always)]
    fn yzx(self, v: F32x4<Self>) -> F32x4<Self> {
        v.yzx()
    }
    #[inline(always)]
    fn append_matching(self, masks: &[u16], ids: &[u16], bit: u16, out: &mut [u16]) -> usize {
        left_pack::append_matching(self, masks, ids, bit, out)
    }
}

impl Sse for Sse42 {
    #[inline(always)]
    fn fma(self, a: __m128, b: __m128, c: __m128) -> __m128 {
        // SAFETY: the token exists, so the CPU has its features.
        unsafe {
            let low = fma_f64_odd(_mm_cvtps_pd(a), _mm_cvtps_pd(b), _mm_cvtps_pd(c));
            let high = |x| _mm_cvtps_pd(_mm_movehl_ps(x, x));
            let high = fma_f64_odd(high(a), high(b), high(c));
            _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high))
        }
    }
    #[inline(always)]
    fn mul_add_fast(self, a: __m128, b: __m128, c: __m128) -> __m128 {
        // SAFETY: the token exists, so the CPU has its features.
        unsafe { _mm_add_ps(_mm_mul_ps(a, b), c) }
    }
}

/// `a * b + c` of converted `f32`, rounded to odd: two lanes of [`fma_f32`](crate::scalar::fma_f32), which has the
/// reasons. Rounding the result to `f32` gives the fused multiply-add.
///
/// # Safety
/// The CPU must have SSE4.1.
#[inline(always)]
unsafe fn fma_f64_odd(a: __m128d, b: __m128d, c: __m128d) -> __m128d {
    // SAFETY: by this function's contract.
    unsafe {
        let zero = _mm_setzero_pd();
        let one = _mm_set1_epi64x(1);
        let product = _mm_mul_pd(a, b);
        let sum = _mm_add_pd(product, c);
        let c_part = _mm_sub_pd(sum, product);
        let error = _mm_add_pd(_mm_sub_pd(product, _mm_sub_pd(sum, c_part)), _mm_sub_pd(c, c_part));

        let bits = _mm_castpd_si128(sum);
        let even = _mm_cmpeq_epi64(_mm_and_si128(bits, one), _mm_setzero_si128());
        // An infinite or NaN sum has a NaN error, which is not ordered.
        let inexact = _mm_and_pd(_mm_cmpneq_pd(error, zero), _mm_cmpord_pd(error, error));
        let change = _mm_and_si128(_mm_castpd_si128(inexact), even);
        // All ones where the signs of sum and error differ: minus one.
        let signs_differ = _mm_xor_pd(_mm_cmplt_pd(error, zero), _mm_cmplt_pd(sum, zero));
        let step = _mm_or_si128(_mm_castpd_si128(signs_differ), one);
        _mm_castsi128_pd(_mm_add_epi64(bits, _mm_and_si128(change, step)))
    }
}
