//! Fuzz target `obj`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("obj"), |data: &[u8]| photinus_fuzz::run("obj", data));
