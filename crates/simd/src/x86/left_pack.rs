//! Compaction eight elements at a time, by tables of shuffles.

use super::avx2_x8::F32x8;
use super::x4::Sse;
use crate::pair::Pair;
use std::arch::x86_64::*;

/// Elements per step.
const STEP: usize = 8;

/// For each set of eight lanes, the lanes of the set in order.
static LANES: [[u8; STEP]; 256] = lanes();

/// For each set of eight 16-bit lanes, the `pshufb` control that moves the lanes of the set to the front.
static BYTES: [[u8; 2 * STEP]; 256] = bytes();

const fn lanes() -> [[u8; STEP]; 256] {
    let mut table = [[0; STEP]; 256];
    let mut set = 0;
    while set < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < STEP {
            if set >> lane & 1 != 0 {
                table[set][count] = lane as u8;
                count += 1;
            }
            lane += 1;
        }
        set += 1;
    }
    table
}

const fn bytes() -> [[u8; 2 * STEP]; 256] {
    let (lanes, mut table) = (lanes(), [[0; 2 * STEP]; 256]);
    let mut i = 0;
    while i < 256 * 2 * STEP {
        let (set, byte) = (i / (2 * STEP), i % (2 * STEP));
        table[set][byte] = 2 * lanes[set][byte / 2] + byte as u8 % 2;
        i += 1;
    }
    table
}

/// [`Simd::append_matching`](crate::Simd::append_matching) with SSE registers.
#[inline(always)]
pub(super) fn append_matching<S: Sse>(_: S, masks: &[u16], ids: &[u16], bit: u16, out: &mut [u16]) -> usize {
    assert!(masks.len() == ids.len() && out.len() >= ids.len() + 32);
    let (mask_steps, mask_rest) = masks.as_chunks::<STEP>();
    let (id_steps, id_rest) = ids.as_chunks::<STEP>();
    let mut count = 0;
    for (masks, ids) in mask_steps.iter().zip(id_steps) {
        // SAFETY: the token exists, so the CPU has SSE4.2. Both chunks are 16 bytes. `count` is at most the number of
        // ids read so far, so 8 elements from there end before `ids.len()`, which `out` exceeds (asserted above).
        unsafe {
            let masks = _mm_loadu_si128(masks.as_ptr().cast());
            let ids = _mm_loadu_si128(ids.as_ptr().cast());
            let unset = _mm_cmpeq_epi16(_mm_and_si128(masks, _mm_set1_epi16(bit as i16)), _mm_setzero_si128());
            let set = !_mm_movemask_epi8(_mm_packs_epi16(unset, unset)) as u8;
            let control = _mm_loadu_si128(BYTES[usize::from(set)].as_ptr().cast());
            _mm_storeu_si128(out.as_mut_ptr().add(count).cast(), _mm_shuffle_epi8(ids, control));
            count += set.count_ones() as usize;
        }
    }
    for (&mask, &id) in mask_rest.iter().zip(id_rest) {
        out[count] = id;
        count += usize::from(mask & bit != 0);
    }
    count
}

/// [`Simd::compress_in_order`](crate::Simd::compress_in_order) with AVX2 registers.
#[inline(always)]
pub(super) fn compress_in_order(
    mask: u16,
    order: &[u8; 16],
    keys: Pair<F32x8>,
    values: &[u32; 16],
    out_keys: &mut [f32; 16],
    out_values: &mut [u32; 16],
) -> usize {
    let (order_halves, _) = order.as_chunks::<STEP>();
    let mut count = 0;
    for order in order_halves {
        // SAFETY: `keys` exist, so the CPU has AVX2. `order` is 8 bytes, `values` two registers. `count` is 0 or, in the
        // second step, at most 8, so that a register stored there ends within 16 elements.
        unsafe {
            let lane = _mm256_and_si256(load_lanes(order), _mm256_set1_epi32(15));
            let values = values.as_ptr().cast::<__m256i>();
            let (low, high) = (_mm256_loadu_si256(values), _mm256_loadu_si256(values.add(1)));
            let values = permute_pair(_mm256_castsi256_ps(low), _mm256_castsi256_ps(high), lane);
            let keys = permute_pair(keys.0.0, keys.1.0, lane);
            // Bit `lane` of the mask, moved to the sign.
            let distance = _mm256_xor_si256(lane, _mm256_set1_epi32(31));
            let set = _mm256_castsi256_ps(_mm256_sllv_epi32(_mm256_set1_epi32(i32::from(mask)), distance));
            let set = _mm256_movemask_ps(set) as u8;
            let front = load_lanes(&LANES[usize::from(set)]);
            _mm256_storeu_ps(out_keys.as_mut_ptr().add(count), _mm256_permutevar8x32_ps(keys, front));
            _mm256_storeu_ps(out_values.as_mut_ptr().add(count).cast(), _mm256_permutevar8x32_ps(values, front));
            count += set.count_ones() as usize;
        }
    }
    count
}

/// The lanes of `mask`, whose bits are all a lane's value, moved to the front.
///
/// # Safety
/// The CPU must have AVX2.
#[inline(always)]
pub(super) unsafe fn compress(mask: __m256, lanes: __m256) -> __m256 {
    // SAFETY: by this function's contract.
    unsafe { _mm256_permutevar8x32_ps(lanes, load_lanes(&LANES[_mm256_movemask_ps(mask) as usize])) }
}

/// Lane numbers as integers.
///
/// # Safety
/// The CPU must have AVX2.
#[inline(always)]
unsafe fn load_lanes(lanes: &[u8; STEP]) -> __m256i {
    // SAFETY: by this function's contract; eight bytes are read from eight.
    unsafe { _mm256_cvtepu8_epi32(_mm_loadl_epi64(lanes.as_ptr().cast())) }
}

/// Lane `lane[i]` of sixteen, for every `i`; lanes are below 16.
///
/// # Safety
/// The CPU must have AVX2.
#[inline(always)]
unsafe fn permute_pair(low: __m256, high: __m256, lane: __m256i) -> __m256 {
    // SAFETY: by this function's contract.
    unsafe {
        let from_high = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(lane));
        let (low, high) = (_mm256_permutevar8x32_ps(low, lane), _mm256_permutevar8x32_ps(high, lane));
        _mm256_blendv_ps(low, high, from_high)
    }
}
