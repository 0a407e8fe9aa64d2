//! Every instruction set of this CPU against plain Rust.
//!
//! Set `WHITTED_REQUIRE_ISA` (for example to `avx512`) where a missing instruction set must fail, not pass unseen.

mod common;
mod double;
mod fma;
mod lanes;
mod lists;
mod math;
mod vec4;
