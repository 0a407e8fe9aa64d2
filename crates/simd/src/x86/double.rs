//! Eight doubles in one AVX-512 register or two AVX registers.

use super::avx2::Avx2;
use super::avx512::Avx512;
use super::{avx2_x8, avx512_x8};
use crate::double::F64Lanes;
use std::arch::x86_64::*;

register! {
    /// Eight doubles.
    F64x8(__m512d, Avx512)
}

operators! {
    impl [] F64x8;
    Add add(a, b) = _mm512_add_pd(a, b);
    Sub sub(a, b) = _mm512_sub_pd(a, b);
    Mul mul(a, b) = _mm512_mul_pd(a, b);
    Div div(a, b) = _mm512_div_pd(a, b);
    Neg neg(a) = _mm512_xor_pd(a, _mm512_set1_pd(-0.0));
}

impl F64Lanes for F64x8 {
    type Narrow = avx512_x8::F32x8;

    #[inline(always)]
    fn splat(token: Avx512, value: f64) -> Self {
        // SAFETY: `token` exists, so the CPU has its features.
        Self::wrap(unsafe { _mm512_set1_pd(value) }, token)
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 8]) {
        // SAFETY: `self` exists; the pointer is good for writing the whole array, and no alignment is needed.
        unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self.0) }
    }
    conversions! {
        widen(from: avx512_x8::F32x8) = _mm512_cvtps_pd(from);
    }
    methods! {
        narrow(a) -> avx512_x8::F32x8 = _mm512_cvtpd_ps(a);
        lt(a, b) -> avx512_x8::Mask8 = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b);
        min(a, b) -> Self = _mm512_min_pd(a, b);
        max(a, b) -> Self = _mm512_max_pd(a, b);
        sqrt(a) -> Self = _mm512_sqrt_pd(a);
    }
}

/// Two registers of four doubles, the lower lanes first.
type Halves = (__m256d, __m256d);

register! {
    /// Eight doubles.
    F64x4x2(Halves, Avx2)
}

operators! {
    impl [] F64x4x2;
    Add add(a, b) = (_mm256_add_pd(a.0, b.0), _mm256_add_pd(a.1, b.1));
    Sub sub(a, b) = (_mm256_sub_pd(a.0, b.0), _mm256_sub_pd(a.1, b.1));
    Mul mul(a, b) = (_mm256_mul_pd(a.0, b.0), _mm256_mul_pd(a.1, b.1));
    Div div(a, b) = (_mm256_div_pd(a.0, b.0), _mm256_div_pd(a.1, b.1));
    Neg neg(a) = (_mm256_xor_pd(a.0, _mm256_set1_pd(-0.0)), _mm256_xor_pd(a.1, _mm256_set1_pd(-0.0)));
}

impl F64Lanes for F64x4x2 {
    type Narrow = avx2_x8::F32x8;

    #[inline(always)]
    fn splat(token: Avx2, value: f64) -> Self {
        // SAFETY: `token` exists, so the CPU has its features.
        Self::wrap(unsafe { (_mm256_set1_pd(value), _mm256_set1_pd(value)) }, token)
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 8]) {
        let to = to.as_mut_ptr();
        // SAFETY: `self` exists; each half fits its half of the array, and no alignment is needed.
        unsafe {
            _mm256_storeu_pd(to, self.0.0);
            _mm256_storeu_pd(to.add(4), self.0.1);
        }
    }
    conversions! {
        widen(from: avx2_x8::F32x8) =
            (_mm256_cvtps_pd(_mm256_castps256_ps128(from)), _mm256_cvtps_pd(_mm256_extractf128_ps::<1>(from)));
    }
    methods! {
        narrow(a) -> avx2_x8::F32x8 = _mm256_set_m128(_mm256_cvtpd_ps(a.1), _mm256_cvtpd_ps(a.0));
        lt(a, b) -> avx2_x8::Mask8 =
            narrow_mask(_mm256_cmp_pd::<_CMP_LT_OQ>(a.0, b.0), _mm256_cmp_pd::<_CMP_LT_OQ>(a.1, b.1));
        min(a, b) -> Self = (_mm256_min_pd(a.0, b.0), _mm256_min_pd(a.1, b.1));
        max(a, b) -> Self = (_mm256_max_pd(a.0, b.0), _mm256_max_pd(a.1, b.1));
        sqrt(a) -> Self = (_mm256_sqrt_pd(a.0), _mm256_sqrt_pd(a.1));
    }
}

/// Truth values of two times four doubles as those of eight floats.
///
/// # Safety
/// The CPU must have AVX2.
#[inline(always)]
unsafe fn narrow_mask(low: __m256d, high: __m256d) -> __m256 {
    // SAFETY: by this function's contract.
    unsafe {
        // Every half of a double's mask is its value: take the lower ones, then put the quarters in order.
        let mixed = _mm256_shuffle_ps::<0b10_00_10_00>(_mm256_castpd_ps(low), _mm256_castpd_ps(high));
        _mm256_castpd_ps(_mm256_permute4x64_pd::<0b11_01_10_00>(_mm256_castps_pd(mixed)))
    }
}
