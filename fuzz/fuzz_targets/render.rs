//! Fuzz target `render`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("render"), |data: &[u8]| photinus_fuzz::run("render", data));
