//! The one place where a kernel meets an instruction set.

use crate::{Level, Simd};

/// An algorithm written once, for any instruction set.
///
/// `run`, and everything that it calls per ray, must be `#[inline(always)]`: a function that is not inlined is compiled
/// without the instruction set and takes its lanes through memory. Closures cannot
/// be `#[inline(always)]`: one that holds more than a few lane operations, or that goes to a function of another crate
/// such as `<[_; N]>::map`, may stay outlined (an arctangent with such a closure took 14 times as long). Write functions
/// for the former, and [`lanes_from_fn`](crate::lanes_from_fn) for the latter. `examples/kernel.rs` shows the form.
pub trait Kernel {
    /// What the kernel returns.
    type Output;

    /// Do the work with the instruction set of `token`.
    fn run<S: Simd>(self, token: S) -> Self::Output;
}

/// Run `kernel` with the instruction set of `level`.
///
/// Costs 3 to 4 ns: dispatch once per batch, never per ray.
#[inline]
pub fn dispatch<K: Kernel>(level: Level, kernel: K) -> K::Output {
    match level {
        Level::Scalar(token) => kernel.run(token),
        #[cfg(target_arch = "x86_64")]
        Level::Sse42(token) => token.enter(kernel),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(token) => token.enter(kernel),
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(token) => token.enter(kernel),
    }
}
