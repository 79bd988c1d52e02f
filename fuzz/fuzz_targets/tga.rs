//! Fuzz target `tga`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("tga"), |data: &[u8]| photinus_fuzz::run("tga", data));
