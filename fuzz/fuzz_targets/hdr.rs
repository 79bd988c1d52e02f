//! Fuzz target `hdr`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("hdr"), |data: &[u8]| photinus_fuzz::run("hdr", data));
