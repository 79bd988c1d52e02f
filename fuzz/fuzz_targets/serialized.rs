//! Fuzz target `serialized`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("serialized"), |data: &[u8]| photinus_fuzz::run("serialized", data));
