//! Fuzzing of `.ply`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| whitted_fuzz::read(formats::Format::Ply, bytes));
