//! Fuzzing of `.nff`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| whitted_fuzz::read(formats::Format::Nff, bytes));
