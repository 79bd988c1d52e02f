//! The fuzz targets without a fuzzer: their seeds, seeded damage to them, and every input that a fuzzer ever found.

#[path = "../../../fuzz/src/bodies/mod.rs"]
mod bodies;

use bodies::{TARGETS, Target};
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};

/// Damaged copies of each seed; the fuzzer itself tries millions.
const DAMAGED: u32 = 24;
const SEED: u64 = 0x7068_6f74;

fn fuzz_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz")
}

/// Runs one input; a panic names it.
fn run(target: &Target, data: &[u8], what: &str) {
    if catch_unwind(|| (target.run)(data)).is_err() {
        panic!("fuzz target {}: {what}: {:?}", target.name, String::from_utf8_lossy(data));
    }
}

/// `data` with a few bytes changed, cut out or doubled, or words of the format put in; a function of `key` alone
/// (multiplier and increment of Knuth's MMIX).
fn damaged(data: &[u8], words: &[&str], key: u64) -> Vec<u8> {
    let mut state = key;
    let mut below = |bound: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % bound.max(1)
    };
    let mut out = data.to_vec();
    for _ in 0..1 + below(4) {
        let at = below(out.len());
        let end = (at + 1 + below(16)).min(out.len());
        match below(7) {
            _ if out.is_empty() => out.push(below(256) as u8),
            0 => out[at] = below(256) as u8,
            1 => out[at] ^= 1 << below(8),
            2 => drop(out.drain(at..end)),
            3 => {
                let piece = out[at..end].to_vec();
                out.splice(at..at, piece);
            }
            4 => out.truncate(at),
            _ if words.is_empty() => out.push(out[at]),
            _ => drop(out.splice(at..at, words[below(words.len())].bytes())),
        }
    }
    out
}

#[test]
fn seeds_and_damaged_seeds_are_borne() {
    for target in TARGETS {
        let seeds = (target.seeds)();
        assert!(seeds.len() >= 2, "{}", target.name);
        for (s, seed) in seeds.iter().enumerate() {
            run(target, seed, &format!("seed {s}"));
            // Renders take a hundred times as long as readings.
            let rounds = if target.name == "render" { 2 } else { DAMAGED };
            for case in 0..rounds {
                let key = SEED ^ ((s as u64) << 32) ^ u64::from(case);
                run(target, &damaged(seed, target.words, key), &format!("seed {s}, damage {case} of key {SEED:#x}"));
            }
        }
        run(target, &[], "nothing");
    }
}

/// What a fuzzer found lies in `fuzz/found/TARGET/`, a file an input, and stays there for good.
#[test]
fn everything_ever_found_is_borne() {
    let mut found = 0;
    for folder in std::fs::read_dir(fuzz_folder().join("found")).expect("the folder of findings") {
        let folder = folder.unwrap().path();
        let name = folder.file_name().unwrap().to_str().unwrap();
        let target = TARGETS.iter().find(|t| t.name == name).unwrap_or_else(|| panic!("{name} is no fuzz target"));
        for file in std::fs::read_dir(&folder).unwrap() {
            let path = file.unwrap().path();
            run(target, &std::fs::read(&path).unwrap(), &path.display().to_string());
            found += 1;
        }
    }
    assert!(found > 0, "no finding was replayed");
}

/// Every target has its program, every program its target, and the page its row.
#[test]
fn targets_programs_and_page_agree() {
    let manifest = std::fs::read_to_string(fuzz_folder().join("Cargo.toml")).unwrap();
    let page = std::fs::read_to_string(fuzz_folder().join("../docs/robustness.md")).unwrap();
    for Target { name, .. } in TARGETS {
        let program = std::fs::read_to_string(fuzz_folder().join(format!("fuzz_targets/{name}.rs"))).unwrap();
        assert_eq!(program.matches(&format!("\"{name}\"")).count(), 2, "{name}");
        assert!(manifest.contains(&format!("name = \"{name}\"\npath = \"fuzz_targets/{name}.rs\"")), "{name}");
        assert!(page.contains(&format!("\n| `{name}` | ")), "docs/robustness.md has no row for {name}");
    }
    assert_eq!(std::fs::read_dir(fuzz_folder().join("fuzz_targets")).unwrap().count(), TARGETS.len());
}
