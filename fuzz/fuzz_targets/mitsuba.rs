//! Fuzz target `mitsuba`: see `bodies::TARGETS`.
#![no_main]

libfuzzer_sys::fuzz_target!(init: photinus_fuzz::prepare("mitsuba"), |data: &[u8]| photinus_fuzz::run("mitsuba", data));
