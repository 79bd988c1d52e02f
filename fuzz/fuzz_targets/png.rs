//! Fuzz target `png`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("png"), |data: &[u8]| photinus_fuzz::run("png", data));
