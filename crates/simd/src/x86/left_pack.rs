//! Compaction of 16-bit lists eight at a time, by a table of byte shuffles.

use super::x4::Sse;
use std::arch::x86_64::*;

/// Elements per step.
const STEP: usize = 8;

/// For each set of eight lanes, the `pshufb` control that moves the set lanes to the front.
static LEFT_PACK: [[u8; 16]; 256] = left_pack();

const fn left_pack() -> [[u8; 16]; 256] {
    let mut table = [[0x80; 16]; 256];
    let mut set = 0;
    while set < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < STEP {
            if set >> lane & 1 != 0 {
                table[set][2 * count] = 2 * lane as u8;
                table[set][2 * count + 1] = 2 * lane as u8 + 1;
                count += 1;
            }
            lane += 1;
        }
        set += 1;
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
            let control = _mm_loadu_si128(LEFT_PACK[usize::from(set)].as_ptr().cast());
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
