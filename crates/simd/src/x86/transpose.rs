//! Rows to columns and back, in registers: what the other way, through memory, would lose is time: a wide load of what
//! narrow stores have just written has to wait for all of them.

use std::arch::x86_64::*;

/// The columns of eight rows of eight.
///
/// # Safety
/// The CPU must have AVX.
#[inline(always)]
pub(super) unsafe fn transpose_8x8(rows: [__m256; 8]) -> [__m256; 8] {
    let [a, b, c, d, e, f, g, h] = rows;
    // SAFETY: by this function's contract.
    unsafe {
        // Upper and lower halves of four columns at once.
        let low = transpose_4x4_halves([a, b, c, d]);
        let high = transpose_4x4_halves([e, f, g, h]);
        [
            _mm256_permute2f128_ps::<0x20>(low[0], high[0]),
            _mm256_permute2f128_ps::<0x20>(low[1], high[1]),
            _mm256_permute2f128_ps::<0x20>(low[2], high[2]),
            _mm256_permute2f128_ps::<0x20>(low[3], high[3]),
            _mm256_permute2f128_ps::<0x31>(low[0], high[0]),
            _mm256_permute2f128_ps::<0x31>(low[1], high[1]),
            _mm256_permute2f128_ps::<0x31>(low[2], high[2]),
            _mm256_permute2f128_ps::<0x31>(low[3], high[3]),
        ]
    }
}

/// The columns of eight rows of four.
///
/// # Safety
/// The CPU must have AVX.
#[inline(always)]
pub(super) unsafe fn transpose_8x4(rows: [__m128; 8]) -> [__m256; 4] {
    let [a, b, c, d, e, f, g, h] = rows;
    // SAFETY: by this function's contract.
    unsafe {
        transpose_4x4_halves([
            _mm256_set_m128(e, a),
            _mm256_set_m128(f, b),
            _mm256_set_m128(g, c),
            _mm256_set_m128(h, d),
        ])
    }
}

/// The columns of four rows of four, in each half of the registers for itself.
///
/// # Safety
/// The CPU must have AVX.
#[inline(always)]
unsafe fn transpose_4x4_halves([a, b, c, d]: [__m256; 4]) -> [__m256; 4] {
    // SAFETY: by this function's contract.
    unsafe {
        let (ab_low, ab_high) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
        let (cd_low, cd_high) = (_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
        [
            _mm256_shuffle_ps::<0b01_00_01_00>(ab_low, cd_low),
            _mm256_shuffle_ps::<0b11_10_11_10>(ab_low, cd_low),
            _mm256_shuffle_ps::<0b01_00_01_00>(ab_high, cd_high),
            _mm256_shuffle_ps::<0b11_10_11_10>(ab_high, cd_high),
        ]
    }
}

/// The columns of sixteen rows of four, given as those that go to the same place of each quarter: `rows[i][q]` is row
/// `4q + i`.
///
/// # Safety
/// The CPU must have AVX-512F.
#[inline(always)]
pub(super) unsafe fn transpose_16x4([a, b, c, d]: [[__m128; 4]; 4]) -> [__m512; 4] {
    // SAFETY: by this function's contract.
    unsafe { transpose_4x4_quarters([quarters(a), quarters(b), quarters(c), quarters(d)]) }
}

/// The columns of four rows of sixteen, rounded toward zero: column `4q + i` is `[i][q]` of the result.
///
/// # Safety
/// The CPU must have AVX-512F and DQ.
#[inline(always)]
pub(super) unsafe fn integers_16x4(rows: [__m512; 4]) -> [[[i64; 4]; 4]; 4] {
    let mut columns = [[[0; 4]; 4]; 4];
    // SAFETY: by this function's contract; every register is stored into half of an array of two registers' size.
    unsafe {
        let quarters = transpose_4x4_quarters(rows);
        for i in 0..4 {
            let (low, high) = (_mm512_castps512_ps256(quarters[i]), _mm512_extractf32x8_ps::<1>(quarters[i]));
            let (low_to, high_to) = columns[i].split_at_mut(2);
            _mm512_storeu_si512(low_to.as_mut_ptr().cast(), _mm512_cvttps_epi64(low));
            _mm512_storeu_si512(high_to.as_mut_ptr().cast(), _mm512_cvttps_epi64(high));
        }
    }
    columns
}

/// The columns of four rows of four, in each quarter of the registers for itself.
///
/// # Safety
/// The CPU must have AVX-512F.
#[inline(always)]
unsafe fn transpose_4x4_quarters([a, b, c, d]: [__m512; 4]) -> [__m512; 4] {
    // SAFETY: by this function's contract.
    unsafe {
        let (ab_low, ab_high) = (_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b));
        let (cd_low, cd_high) = (_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d));
        [
            _mm512_shuffle_ps::<0b01_00_01_00>(ab_low, cd_low),
            _mm512_shuffle_ps::<0b11_10_11_10>(ab_low, cd_low),
            _mm512_shuffle_ps::<0b01_00_01_00>(ab_high, cd_high),
            _mm512_shuffle_ps::<0b11_10_11_10>(ab_high, cd_high),
        ]
    }
}

/// Four quarters as one register.
///
/// # Safety
/// The CPU must have AVX-512F.
#[inline(always)]
unsafe fn quarters([a, b, c, d]: [__m128; 4]) -> __m512 {
    // SAFETY: by this function's contract.
    unsafe {
        let ab = _mm512_insertf32x4::<1>(_mm512_castps128_ps512(a), b);
        _mm512_insertf32x4::<3>(_mm512_insertf32x4::<2>(ab, c), d)
    }
}
