//! Fuzz target `jpeg`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("jpeg"), |data: &[u8]| photinus_fuzz::run("jpeg", data));
