//! Sixteen lanes in an AVX-512 register.

use super::avx512::Avx512;
use super::avx512_x8::F32x8;
use super::x4::F32x4;
use crate::{F32Lanes, MaskLanes, U32Lanes};
use std::arch::x86_64::*;

register! {
    /// Sixteen floats.
    F32x16(__m512, Avx512)
}
register! {
    /// Sixteen integers.
    U32x16(__m512i, Avx512)
}
register! {
    /// Sixteen truth values, one bit each.
    Mask16(__mmask16, Avx512)
}

operators! {
    impl [] F32x16;
    Add add(a, b) = _mm512_add_ps(a, b);
    Sub sub(a, b) = _mm512_sub_ps(a, b);
    Mul mul(a, b) = _mm512_mul_ps(a, b);
    Div div(a, b) = _mm512_div_ps(a, b);
    Neg neg(a) = _mm512_xor_ps(a, _mm512_set1_ps(-0.0));
}

operators! {
    impl [] U32x16;
    Add add(a, b) = _mm512_add_epi32(a, b);
    Sub sub(a, b) = _mm512_sub_epi32(a, b);
    Mul mul(a, b) = _mm512_mullo_epi32(a, b);
    BitAnd bitand(a, b) = _mm512_and_si512(a, b);
    BitOr bitor(a, b) = _mm512_or_si512(a, b);
    BitXor bitxor(a, b) = _mm512_xor_si512(a, b);
    Not not(a) = _mm512_xor_si512(a, _mm512_set1_epi32(-1));
}

operators! {
    impl [] Mask16;
    BitAnd bitand(a, b) = _kand_mask16(a, b);
    BitOr bitor(a, b) = _kor_mask16(a, b);
    BitXor bitxor(a, b) = _kxor_mask16(a, b);
    Not not(a) = _knot_mask16(a);
}

impl F32Lanes for F32x16 {
    type Token = Avx512;
    type Mask = Mask16;
    type U32 = U32x16;
    type Array = [f32; 16];

    #[inline(always)]
    fn token(self) -> Self::Token {
        self.1
    }
    memory! {
        f32 16;
        splat(value) = _mm512_set1_ps(value);
        load(from) = _mm512_loadu_ps(from);
        store(to, a) = _mm512_storeu_ps(to, a);
    }
    gather_rows!(columns_x16);
    #[inline(always)]
    fn accumulate(addends: [Self; 4], mask: Mask16, index: U32x16, table: &mut [[i64; 4]]) {
        let [a, b, c, d] = addends;
        // SAFETY: the lanes exist, so the CPU has the token's features.
        let rows = unsafe { super::transpose::integers_16x4([a.0, b.0, c.0, d.0]) };
        let mut numbers = [0; 16];
        index.store(&mut numbers);
        let mut bits = mask.bits();
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize % 16;
            bits &= bits - 1;
            let sums = &mut table[numbers[lane] as usize];
            // SAFETY: as above; both are four integers. The sum of two numbers below 2⁶³ does not wrap round as one
            // without sign.
            unsafe {
                let old = _mm256_loadu_si256(sums.as_ptr().cast());
                let new = _mm256_add_epi64(old, _mm256_loadu_si256(rows[lane % 4][lane / 4].as_ptr().cast()));
                let new = _mm256_min_epu64(new, _mm256_set1_epi64x(i64::MAX));
                _mm256_storeu_si256(sums.as_mut_ptr().cast(), new);
            }
        }
    }
    hardware_gather!(f32, U32x16; |from, at| _mm512_i32gather_ps::<4>(at, from));
    methods! {
        min(a, b) -> Self = _mm512_min_ps(a, b);
        max(a, b) -> Self = _mm512_max_ps(a, b);
        abs(a) -> Self = _mm512_abs_ps(a);
        sqrt(a) -> Self = _mm512_sqrt_ps(a);
        fma(a, b, c) -> Self = _mm512_fmadd_ps(a, b, c);
        mul_add_fast(a, b, c) -> Self = _mm512_fmadd_ps(a, b, c);
        floor(a) -> Self = _mm512_roundscale_ps::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(a);
        recip_approx(a) -> Self = _mm512_rcp14_ps(a);
        rsqrt_approx(a) -> Self = _mm512_rsqrt14_ps(a);
        lt(a, b) -> Mask16 = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b);
        le(a, b) -> Mask16 = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b);
        eq(a, b) -> Mask16 = _mm512_cmp_ps_mask::<_CMP_EQ_OQ>(a, b);
        to_bits(a) -> U32x16 = _mm512_castps_si512(a);
        round_to_int(a) -> U32x16 = _mm512_cvtps_epi32(a);
    }
    conversions! {
        from_bits(a: U32x16) = _mm512_castsi512_ps(a);
        from_int(a: U32x16) = _mm512_cvtepi32_ps(a);
    }
    select!(|mask, set, unset| _mm512_mask_blend_ps(mask, unset, set));
    compress_store!(f32; |mask, lanes| _mm512_maskz_compress_ps(mask, lanes));

    #[inline(always)]
    fn reduce_add(self) -> f32 {
        (self.low() + self.high()).reduce_add()
    }
    #[inline(always)]
    fn reduce_min(self) -> f32 {
        self.low().min(self.high()).reduce_min()
    }
    #[inline(always)]
    fn reduce_max(self) -> f32 {
        self.low().max(self.high()).reduce_max()
    }
}

impl F32x16 {
    methods! {
        low(a) -> F32x8 = _mm512_castps512_ps256(a);
        high(a) -> F32x8 = _mm512_extractf32x8_ps::<1>(a);
    }
}

impl U32Lanes for U32x16 {
    type Token = Avx512;
    type Mask = Mask16;
    type F32 = F32x16;
    type Array = [u32; 16];

    memory! {
        u32 16;
        splat(value) = _mm512_set1_epi32(value as i32);
        load(from) = _mm512_loadu_epi32(from.cast());
        store(to, a) = _mm512_storeu_epi32(to.cast(), a);
    }
    hardware_gather!(u32, Self; |from, at| _mm512_i32gather_epi32::<4>(at, from.cast()));
    methods! {
        eq(a, b) -> Mask16 = _mm512_cmpeq_epi32_mask(a, b);
        lt(a, b) -> Mask16 = _mm512_cmplt_epu32_mask(a, b);
    }
    shifts! {
        shl<N>(a) = _mm512_slli_epi32::<N>(a);
        shr<N>(a) = _mm512_srli_epi32::<N>(a);
        sar<N>(a) = _mm512_srai_epi32::<N>(a);
    }
    select!(|mask, set, unset| _mm512_mask_blend_epi32(mask, unset, set));
    compress_store!(u32; |mask, lanes| _mm512_maskz_compress_epi32(mask, lanes));
}

impl MaskLanes for Mask16 {
    type Token = Avx512;
    const WIDTH: usize = 16;

    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self.0)
    }
    #[inline(always)]
    fn from_bits(token: Avx512, bits: u32) -> Self {
        Self(bits as u16, token)
    }
}
