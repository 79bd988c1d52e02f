//! Fuzz target `mtl`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("mtl"), |data: &[u8]| photinus_fuzz::run("mtl", data));
