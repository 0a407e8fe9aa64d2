//! Eight lanes in an AVX register.

use super::avx2::Avx2;
use super::left_pack;
use super::x4::F32x4;
use crate::{F32Lanes, MaskLanes, U32Lanes};
use std::arch::x86_64::*;

register! {
    /// Eight floats.
    F32x8(__m256, Avx2)
}
register! {
    /// Eight integers.
    U32x8(__m256i, Avx2)
}
register! {
    /// Eight truth values; every bit of a lane is the lane's value.
    Mask8(__m256, Avx2)
}

operators! {
    impl [] F32x8;
    Add add(a, b) = _mm256_add_ps(a, b);
    Sub sub(a, b) = _mm256_sub_ps(a, b);
    Mul mul(a, b) = _mm256_mul_ps(a, b);
    Div div(a, b) = _mm256_div_ps(a, b);
    Neg neg(a) = _mm256_xor_ps(a, _mm256_set1_ps(-0.0));
}

operators! {
    impl [] U32x8;
    Add add(a, b) = _mm256_add_epi32(a, b);
    Sub sub(a, b) = _mm256_sub_epi32(a, b);
    Mul mul(a, b) = _mm256_mullo_epi32(a, b);
    BitAnd bitand(a, b) = _mm256_and_si256(a, b);
    BitOr bitor(a, b) = _mm256_or_si256(a, b);
    BitXor bitxor(a, b) = _mm256_xor_si256(a, b);
    Not not(a) = _mm256_xor_si256(a, _mm256_set1_epi32(-1));
}

operators! {
    impl [] Mask8;
    BitAnd bitand(a, b) = _mm256_and_ps(a, b);
    BitOr bitor(a, b) = _mm256_or_ps(a, b);
    BitXor bitxor(a, b) = _mm256_xor_ps(a, b);
    Not not(a) = _mm256_xor_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(-1)));
}

impl F32Lanes for F32x8 {
    type Token = Avx2;
    type Mask = Mask8;
    type U32 = U32x8;
    type Array = [f32; 8];

    #[inline(always)]
    fn token(self) -> Self::Token {
        self.1
    }
    memory! {
        f32 8;
        splat(value) = _mm256_set1_ps(value);
        load(from) = _mm256_loadu_ps(from);
        store(to, a) = _mm256_storeu_ps(to, a);
    }
    gather_rows!(columns_x8);
    hardware_gather!(f32, U32x8; |from, at| _mm256_i32gather_ps::<4>(from, at));
    methods! {
        min(a, b) -> Self = _mm256_min_ps(a, b);
        max(a, b) -> Self = _mm256_max_ps(a, b);
        abs(a) -> Self = _mm256_andnot_ps(_mm256_set1_ps(-0.0), a);
        sqrt(a) -> Self = _mm256_sqrt_ps(a);
        fma(a, b, c) -> Self = _mm256_fmadd_ps(a, b, c);
        mul_add_fast(a, b, c) -> Self = _mm256_fmadd_ps(a, b, c);
        floor(a) -> Self = _mm256_floor_ps(a);
        recip_approx(a) -> Self = _mm256_rcp_ps(a);
        rsqrt_approx(a) -> Self = _mm256_rsqrt_ps(a);
        lt(a, b) -> Mask8 = _mm256_cmp_ps::<_CMP_LT_OQ>(a, b);
        le(a, b) -> Mask8 = _mm256_cmp_ps::<_CMP_LE_OQ>(a, b);
        eq(a, b) -> Mask8 = _mm256_cmp_ps::<_CMP_EQ_OQ>(a, b);
        to_bits(a) -> U32x8 = _mm256_castps_si256(a);
        round_to_int(a) -> U32x8 = _mm256_cvtps_epi32(a);
    }
    conversions! {
        from_bits(a: U32x8) = _mm256_castsi256_ps(a);
        from_int(a: U32x8) = _mm256_cvtepi32_ps(a);
    }
    select!(|mask, set, unset| _mm256_blendv_ps(unset, set, mask));
    compress_store!(f32; |mask, lanes| left_pack::compress(mask, lanes));

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

impl F32x8 {
    methods! {
        low(a) -> F32x4<Avx2> = _mm256_castps256_ps128(a);
        high(a) -> F32x4<Avx2> = _mm256_extractf128_ps::<1>(a);
    }
}

impl U32Lanes for U32x8 {
    type Token = Avx2;
    type Mask = Mask8;
    type F32 = F32x8;
    type Array = [u32; 8];

    memory! {
        u32 8;
        splat(value) = _mm256_set1_epi32(value as i32);
        load(from) = _mm256_loadu_si256(from.cast());
        store(to, a) = _mm256_storeu_si256(to.cast(), a);
    }
    hardware_gather!(u32, Self; |from, at| _mm256_i32gather_epi32::<4>(from.cast(), at));
    methods! {
        eq(a, b) -> Mask8 = _mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b));
        lt(a, b) -> Mask8 = {
            // Only signed integers compare: flip the sign bits.
            let sign = _mm256_set1_epi32(i32::MIN);
            _mm256_castsi256_ps(_mm256_cmpgt_epi32(_mm256_xor_si256(b, sign), _mm256_xor_si256(a, sign)))
        };
    }
    shifts! {
        shl<N>(a) = _mm256_sll_epi32(a, _mm_cvtsi32_si128(N as i32));
        shr<N>(a) = _mm256_srl_epi32(a, _mm_cvtsi32_si128(N as i32));
        sar<N>(a) = _mm256_sra_epi32(a, _mm_cvtsi32_si128(N as i32));
    }
    select!(|mask, set, unset| _mm256_blendv_epi8(unset, set, _mm256_castps_si256(mask)));
    compress_store!(u32; |mask, lanes| _mm256_castps_si256(left_pack::compress(mask, _mm256_castsi256_ps(lanes))));
}

impl MaskLanes for Mask8 {
    type Token = Avx2;
    const WIDTH: usize = 8;

    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: `self` exists, so the CPU has the token's features.
        unsafe { _mm256_movemask_ps(self.0) as u32 }
    }
    #[inline(always)]
    fn from_bits(token: Avx2, bits: u32) -> Self {
        // SAFETY: the token exists, so the CPU has its features.
        let mask = unsafe {
            let lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(bits as i32), lane), lane))
        };
        Self(mask, token)
    }
}
