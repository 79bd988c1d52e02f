//! Fuzz target `spectrum`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("spectrum"), |data: &[u8]| photinus_fuzz::run("spectrum", data));
