//! Fuzzing of tables of rays: the first byte chooses the format.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| whitted_fuzz::read_rays(bytes));
