//! The instruction sets of x86-64.
//!
//! One argument makes every intrinsic here sound. A token is made only by `detect`, after the CPU has shown each
//! feature in the token's list; a vector or mask is made only from its token or from another vector of it; therefore
//! whoever holds a value of these types runs on a CPU that has its features. "The token's features" in the SAFETY
//! comments below means this.

#[macro_use]
mod macros;
mod avx2;
mod avx2_x8;
mod avx512;
mod avx512_x16;
mod avx512_x8;
mod double;
mod left_pack;
mod sse42;
mod transpose;
mod x4;

pub use avx2::Avx2;
pub use avx512::Avx512;
pub use sse42::Sse42;

/// `table[index]` per lane. Panics if an index is out of range: the way out of the gathers by hardware.
#[cold]
#[inline(never)]
fn gather_safely<T: Copy, const N: usize>(table: &[T], index: [u32; N]) -> [T; N] {
    index.map(|i| table[i as usize])
}
