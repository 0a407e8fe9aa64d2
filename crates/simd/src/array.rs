//! Arrays of lanes.

/// `[f(0), f(1), …]`, inlined into the caller. `N` must not be 0.
///
/// `std::array::from_fn` and `<[_; N]>::map` are functions of their own without the features of the instruction set,
/// so a kernel that calls them with lanes inside pays for calls and for vectors in memory; this never does.
#[inline(always)]
pub fn lanes_from_fn<T: Copy, const N: usize>(mut f: impl FnMut(usize) -> T) -> [T; N] {
    let mut array = [f(0); N];
    for (i, element) in array.iter_mut().enumerate().skip(1) {
        *element = f(i);
    }
    array
}
