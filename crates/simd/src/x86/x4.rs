//! Four lanes in an SSE register, for every token that implies SSE4.2.

use crate::{F32Lanes, MaskLanes, Simd, U32Lanes};
use std::arch::x86_64::*;

/// A token of SSE4.2 or more. Sealed: only the tokens of this module's siblings implement it.
pub trait Sse: Simd<F32x4 = F32x4<Self>> {
    /// `a * b + c` with one rounding.
    fn fma(self, a: __m128, b: __m128, c: __m128) -> __m128;
    /// `a * b + c`, however it is fastest.
    fn mul_add_fast(self, a: __m128, b: __m128, c: __m128) -> __m128;
    /// Three floats and 0.
    #[inline(always)]
    fn load_three(self, &[x, y, z]: &[f32; 3]) -> __m128 {
        F32x4::load(self, &[x, y, z, 0.0]).0
    }
}

register! {
    /// Four floats.
    F32x4<S>(__m128, S)
}
register! {
    /// Four integers.
    U32x4<S>(__m128i, S)
}
register! {
    /// Four truth values; every bit of a lane is the lane's value.
    Mask4<S>(__m128, S)
}

operators! {
    impl [S: Sse] F32x4<S>;
    Add add(a, b) = _mm_add_ps(a, b);
    Sub sub(a, b) = _mm_sub_ps(a, b);
    Mul mul(a, b) = _mm_mul_ps(a, b);
    Div div(a, b) = _mm_div_ps(a, b);
    Neg neg(a) = _mm_xor_ps(a, _mm_set1_ps(-0.0));
}

operators! {
    impl [S: Sse] U32x4<S>;
    Add add(a, b) = _mm_add_epi32(a, b);
    Sub sub(a, b) = _mm_sub_epi32(a, b);
    Mul mul(a, b) = _mm_mullo_epi32(a, b);
    BitAnd bitand(a, b) = _mm_and_si128(a, b);
    BitOr bitor(a, b) = _mm_or_si128(a, b);
    BitXor bitxor(a, b) = _mm_xor_si128(a, b);
    Not not(a) = _mm_xor_si128(a, _mm_set1_epi32(-1));
}

operators! {
    impl [S: Sse] Mask4<S>;
    BitAnd bitand(a, b) = _mm_and_ps(a, b);
    BitOr bitor(a, b) = _mm_or_ps(a, b);
    BitXor bitxor(a, b) = _mm_xor_ps(a, b);
    Not not(a) = _mm_xor_ps(a, _mm_castsi128_ps(_mm_set1_epi32(-1)));
}

impl<S: Sse> F32x4<S> {
    /// Three floats and 0.
    #[inline(always)]
    pub(super) fn load_three(token: S, from: &[f32; 3]) -> Self {
        Self(token.load_three(from), token)
    }
}

impl<S: Sse> F32Lanes for F32x4<S> {
    type Token = S;
    type Mask = Mask4<S>;
    type U32 = U32x4<S>;
    type Array = [f32; 4];

    #[inline(always)]
    fn token(self) -> Self::Token {
        self.1
    }
    memory! {
        f32 4;
        splat(value) = _mm_set1_ps(value);
        load(from) = _mm_loadu_ps(from);
        store(to, a) = _mm_storeu_ps(to, a);
    }
    methods! {
        min(a, b) -> Self = _mm_min_ps(a, b);
        max(a, b) -> Self = _mm_max_ps(a, b);
        abs(a) -> Self = _mm_andnot_ps(_mm_set1_ps(-0.0), a);
        sqrt(a) -> Self = _mm_sqrt_ps(a);
        floor(a) -> Self = _mm_floor_ps(a);
        recip_approx(a) -> Self = _mm_rcp_ps(a);
        rsqrt_approx(a) -> Self = _mm_rsqrt_ps(a);
        lt(a, b) -> Mask4<S> = _mm_cmplt_ps(a, b);
        le(a, b) -> Mask4<S> = _mm_cmple_ps(a, b);
        eq(a, b) -> Mask4<S> = _mm_cmpeq_ps(a, b);
        to_bits(a) -> U32x4<S> = _mm_castps_si128(a);
        round_to_int(a) -> U32x4<S> = _mm_cvtps_epi32(a);
    }
    conversions! {
        from_bits(a: U32x4<S>) = _mm_castsi128_ps(a);
        from_int(a: U32x4<S>) = _mm_cvtepi32_ps(a);
    }
    select!(|mask, set, unset| _mm_blendv_ps(unset, set, mask));

    #[inline(always)]
    fn compress_store(self, mask: Mask4<S>, to: &mut [f32]) {
        self.compressed(mask).store_slice(to);
    }
    #[inline(always)]
    fn gather(table: &[f32], index: U32x4<S>) -> Self {
        let mut lanes = [0; 4];
        index.store(&mut lanes);
        Self::load(index.1, &lanes.map(|i| table[i as usize]))
    }
    #[inline(always)]
    fn fma(self, factor: Self, addend: Self) -> Self {
        Self(self.1.fma(self.0, factor.0, addend.0), self.1)
    }
    #[inline(always)]
    fn mul_add_fast(self, factor: Self, addend: Self) -> Self {
        Self(self.1.mul_add_fast(self.0, factor.0, addend.0), self.1)
    }
    #[inline(always)]
    fn reduce_add(self) -> f32 {
        let halves = self + self.swap_halves();
        (halves + halves.swap_neighbours()).first()
    }
    #[inline(always)]
    fn reduce_min(self) -> f32 {
        let halves = self.min(self.swap_halves());
        halves.min(halves.swap_neighbours()).first()
    }
    #[inline(always)]
    fn reduce_max(self) -> f32 {
        let halves = self.max(self.swap_halves());
        halves.max(halves.swap_neighbours()).first()
    }
}

/// For each set of four lanes, the `pshufb` control that moves the lanes of the set to the front.
static FRONT: [[u8; 16]; 16] = front();

const fn front() -> [[u8; 16]; 16] {
    let mut table = [[0; 16]; 16];
    let mut set = 0;
    while set < 16 {
        let (mut byte, mut count) = (0, 0);
        while byte < 16 {
            if set >> (byte / 4) & 1 != 0 {
                table[set][count] = byte as u8;
                count += 1;
            }
            byte += 1;
        }
        set += 1;
    }
    table
}

impl<S: Sse> F32x4<S> {
    /// The lanes of `mask` moved to the front.
    #[inline(always)]
    fn compressed(self, mask: Mask4<S>) -> Self {
        let control = FRONT[mask.bits() as usize & 15].as_ptr();
        // SAFETY: `self` exists, so the CPU has the token's features; a row of the table fills a register.
        let lanes =
            unsafe { _mm_castsi128_ps(_mm_shuffle_epi8(_mm_castps_si128(self.0), _mm_loadu_si128(control.cast()))) };
        Self(lanes, self.1)
    }
    /// See [`Simd::yzx`].
    #[inline(always)]
    pub(super) fn yzx(self) -> Self {
        // SAFETY: `self` exists, so the CPU has the token's features.
        Self(unsafe { _mm_shuffle_ps::<0b_11_00_10_01>(self.0, self.0) }, self.1)
    }
    methods! {
        swap_halves(a) -> Self = _mm_movehl_ps(a, a);
        swap_neighbours(a) -> Self = _mm_shuffle_ps::<0b_10_11_00_01>(a, a);
    }
    #[inline(always)]
    fn first(self) -> f32 {
        // SAFETY: `self` exists, so the CPU has the token's features.
        unsafe { _mm_cvtss_f32(self.0) }
    }
}

impl<S: Sse> U32Lanes for U32x4<S> {
    type Token = S;
    type Mask = Mask4<S>;
    type F32 = F32x4<S>;
    type Array = [u32; 4];

    memory! {
        u32 4;
        splat(value) = _mm_set1_epi32(value as i32);
        load(from) = _mm_loadu_si128(from.cast());
        store(to, a) = _mm_storeu_si128(to.cast(), a);
    }
    methods! {
        eq(a, b) -> Mask4<S> = _mm_castsi128_ps(_mm_cmpeq_epi32(a, b));
        lt(a, b) -> Mask4<S> = {
            // Only signed integers compare: flip the sign bits.
            let sign = _mm_set1_epi32(i32::MIN);
            _mm_castsi128_ps(_mm_cmplt_epi32(_mm_xor_si128(a, sign), _mm_xor_si128(b, sign)))
        };
    }
    shifts! {
        shl<N>(a) = _mm_sll_epi32(a, _mm_cvtsi32_si128(N as i32));
        shr<N>(a) = _mm_srl_epi32(a, _mm_cvtsi32_si128(N as i32));
        sar<N>(a) = _mm_sra_epi32(a, _mm_cvtsi32_si128(N as i32));
    }
    select!(|mask, set, unset| _mm_blendv_epi8(unset, set, _mm_castps_si128(mask)));

    #[inline(always)]
    fn compress_store(self, mask: Mask4<S>, to: &mut [u32]) {
        F32x4::from_bits(self).compressed(mask).to_bits().store_slice(to);
    }

    #[inline(always)]
    fn gather(table: &[u32], index: Self) -> Self {
        let mut lanes = [0; 4];
        index.store(&mut lanes);
        Self::load(index.1, &lanes.map(|i| table[i as usize]))
    }
}

impl<S: Sse> MaskLanes for Mask4<S> {
    type Token = S;
    const WIDTH: usize = 4;

    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: `self` exists, so the CPU has the token's features.
        unsafe { _mm_movemask_ps(self.0) as u32 }
    }
    #[inline(always)]
    fn from_bits(token: S, bits: u32) -> Self {
        // SAFETY: the token exists, so the CPU has its features.
        let mask = unsafe {
            let lane = _mm_setr_epi32(1, 2, 4, 8);
            _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(bits as i32), lane), lane))
        };
        Self(mask, token)
    }
}
