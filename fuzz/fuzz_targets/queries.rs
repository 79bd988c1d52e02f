//! Fuzz target `queries`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("queries"), |data: &[u8]| photinus_fuzz::run("queries", data));
