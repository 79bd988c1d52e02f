//! Fuzz target `stl`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("stl"), |data: &[u8]| photinus_fuzz::run("stl", data));
