//! Lanes, masks, run-time dispatch and portable math for the Whitted ray tracer.
//!
//! # What this crate knows
//! How to do the same arithmetic on 1, 4, 8 or 16 numbers at once on every CPU: a zero-sized *token* per
//! instruction set ([`Scalar`], [`Sse42`], [`Avx2`], [`Avx512`]) that exists only where the CPU has it, lane types that
//! can only be made from a token, and [`dispatch`], which holds the one `#[target_feature]` function per instruction
//! set. A kernel is written once, as [`Kernel::run`], without `unsafe`, `cfg` or the name of an instruction set.
//!
//! # Invariants
//! * **Exact by name.** Every operation gives the same bits on every instruction set, except those whose name says
//!   otherwise: `*_approx` (hardware estimates) and [`F32Lanes::mul_add_fast`] (one or two roundings).
//! * **One NaN rule.** Comparisons are false when an operand is NaN; `a.min(b)` is `if a < b { a } else { b }` and
//!   `a.max(b)` is `if a > b { a } else { b }`, so a NaN in either operand (and equal zeros) yields `b`.
//! * All functions that kernels call are `#[inline(always)]`: a lane operation that is not inlined into the
//!   dispatched function is slow, never wrong.
//! * This crate knows nothing about rays.

#![cfg_attr(not(test), deny(clippy::disallowed_methods, clippy::print_stdout, clippy::print_stderr))]

mod array;
mod dispatch;
mod double;
mod lanes;
mod level;
pub mod math;
mod memory;
mod octet;
#[cfg(target_arch = "x86_64")]
mod pair;
mod scalar;
mod vec4;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use array::lanes_from_fn;
pub use dispatch::{Kernel, dispatch};
pub use double::{ArrayF64, F64Lanes};
pub use lanes::{F32Lanes, MaskLanes, Simd, U32Lanes};
pub use level::Level;
pub use memory::{advise_huge_pages, prefetch};
pub use octet::Octet;
pub use scalar::{Scalar, ScalarF32, ScalarMask, ScalarU32};
pub use vec4::Vec4;
#[cfg(target_arch = "x86_64")]
pub use x86::{Avx2, Avx512, Sse42};
