//! Fuzz target `bmp`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("bmp"), |data: &[u8]| photinus_fuzz::run("bmp", data));
