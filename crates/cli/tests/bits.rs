//! The same bits on any number of threads, on a second run, and with the passes that a clock allowed.

mod common;

use common::{json, run_in, success};
use std::path::Path;

const TINY: &[&str] = &["--size", "24x20", "--photons", "3000", "--passes", "3", "--quiet"];

fn render(folder: &Path, name: &str, more: &[&str]) -> Vec<u8> {
    success(&run_in(folder, &[&["render", "-o", name], TINY, more].concat()));
    std::fs::read(folder.join(name)).unwrap()
}

#[test]
fn threads_and_runs_do_not_show() {
    let folder = tempfile::tempdir().unwrap();
    for mode in ["progressive", "gather", "direct", "path"] {
        let with = |threads, name| render(folder.path(), name, &["--mode", mode, "--threads", threads]);
        let one = with("1", "a.exr");
        assert_eq!(one, with("2", "b.exr"), "{mode}: two threads");
        assert_eq!(one, with("7", "c.exr"), "{mode}: seven threads");
        assert_eq!(one, with("2", "d.exr"), "{mode}: a second run");
        assert_ne!(one, render(folder.path(), "e.exr", &["--mode", mode, "--seed", "1"]), "{mode}: another seed");
        let png = with("1", "a.png");
        assert_eq!(png, with("7", "b.png"), "{mode}: PNG");
    }
}

#[test]
fn members_of_a_family_give_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    let reference = render(folder.path(), "a.exr", &[]);
    for member in [["--accel", "brute-force"], ["--search", "brute-force"], ["--search", "kd-balanced"]] {
        let bytes = render(folder.path(), "b.exr", &member);
        if bytes != reference {
            let found = json(&run_in(folder.path(), &["compare", "b.exr", "a.exr", "--json"]));
            let relmse = found["relmse"].as_f64().unwrap();
            // Photons are summed in another order: the last bits of a pixel differ, nothing more.
            assert!(member[0] == "--search" && relmse < 1e-9, "{member:?}: relMSE {relmse}");
        }
    }
}

#[test]
fn the_passes_that_a_clock_allowed_can_be_repeated() {
    let folder = tempfile::tempdir().unwrap();
    let short = ["render", "--size", "24x20", "--photons", "3000", "--quiet", "--json", "-o"];
    let timed = json(&run_in(folder.path(), &[&short[..], &["a.exr", "--time", "0.5"]].concat()));
    assert_eq!(timed["stopped"], "time");
    let passes = timed["passes"].to_string();
    let counted = json(&run_in(folder.path(), &[&short[..], &["b.exr", "--passes", &passes]].concat()));
    assert_eq!(counted["stopped"], "passes");
    let read = |name| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("a.exr"), read("b.exr"), "{passes} passes");
}
