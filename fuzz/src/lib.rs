//! What the fuzz targets share: their bodies, a limit on memory, and seeds written for the fuzzer.

pub mod bodies;

use std::alloc::System;
use std::path::PathBuf;

/// More than any file of a few kilobytes may make the program ask for: an image may declare 256 MiB of samples.
const MAX_BYTES: usize = 2 << 30;

#[global_allocator]
static ALLOCATOR: cap::Cap<System> = cap::Cap::new(System, MAX_BYTES);

/// Called once before the fuzzing of the target `name`. Where the variable `PHOTINUS_FUZZ_SEEDS` names a folder, the
/// seeds and the dictionary are written there instead, as `seeds/NUMBER` and `words`.
pub fn prepare(name: &str) {
    // The fuzzer takes every panic for a finding; those of decoders are errors like others.
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !photinus::image::is_decoding() {
            hook(panic);
        }
    }));
    let Some(folder) = std::env::var_os("PHOTINUS_FUZZ_SEEDS").map(PathBuf::from) else { return };
    let target = target(name);
    std::fs::create_dir_all(folder.join("seeds")).expect("the folder for seeds can be made");
    for (i, seed) in (target.seeds)().iter().enumerate() {
        std::fs::write(folder.join(format!("seeds/{i:03}")), seed).expect("a seed can be written");
    }
    let words: String = target.words.iter().map(|word| format!("{}\n", quoted(word))).collect();
    std::fs::write(folder.join("words"), words).expect("the dictionary can be written");
    std::process::exit(0);
}

/// One input of the target `name`.
pub fn run(name: &str, data: &[u8]) {
    (target(name).run)(data);
}

fn target(name: &str) -> &'static bodies::Target {
    bodies::TARGETS.iter().find(|t| t.name == name).expect("a target of the list")
}

/// A word as libFuzzer's dictionaries have it.
fn quoted(word: &str) -> String {
    let escape = |byte: u8| match byte {
        b'"' | b'\\' => format!("\\{}", char::from(byte)),
        b' '..=b'~' => char::from(byte).to_string(),
        other => format!("\\x{other:02X}"),
    };
    format!("\"{}\"", word.bytes().map(escape).collect::<String>())
}
