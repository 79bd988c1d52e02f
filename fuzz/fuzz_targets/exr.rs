//! Fuzz target `exr`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("exr"), |data: &[u8]| photinus_fuzz::run("exr", data));
