//! Fuzz target `ply`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("ply"), |data: &[u8]| photinus_fuzz::run("ply", data));
