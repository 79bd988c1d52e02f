//! What the profile costs, in instructions: valgrind counts them, as wall time tells nothing of a few percent on a
//! machine that others use too. Valgrind knows no AVX-512, so that these are the AVX2 kernels.

#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use std::process::Command;

/// The most that counting and timing one query in 64 may add to a pass.
const MOST: f64 = 0.03;

/// Instructions of a whole render of so many passes, on one thread.
fn instructions(arguments: &[&str], passes: u32, profile_every: u32) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null", env!("CARGO_BIN_EXE_photinus")]);
    command.args(["render", "two-spheres", "--size", "96x96", "--threads", "1", "--quiet", "-o", "a.png"]);
    command.args(["--passes", &passes.to_string(), "--profile-every", &profile_every.to_string()]);
    let output = command.args(arguments).current_dir(folder.path()).output().unwrap_or_else(|error| {
        panic!("valgrind cannot be started ({error}): `apt-get install valgrind`, or `cargo xtask ci --install`")
    });
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    let count = said.lines().find_map(|line| line.split_once("Collected : "));
    count.and_then(|(_, count)| count.trim().parse().ok()).unwrap_or_else(|| panic!("no count in {said}"))
}

/// Share that the profile adds to a pass after the first: what a render does once does not count for it.
#[track_caller]
#[allow(clippy::print_stdout)] // The measurement itself, for whoever runs this with --nocapture.
fn assert_cheap(arguments: &[&str]) {
    let pass = |every| instructions(arguments, 2, every) - instructions(arguments, 1, every);
    let (with, without) = (pass(64), pass(0));
    let overhead = with / without - 1.0;
    assert!(without > 1e7, "{arguments:?}: {without} instructions are no pass");
    assert!(overhead < MOST, "{arguments:?}: the profile costs {:.2} %", 100.0 * overhead);
    // Batches are cut at windows, which may save some work, but never much.
    assert!(overhead > -MOST, "{arguments:?}: {:.2} %: these were not the same renders", 100.0 * overhead);
    println!("{arguments:?}: {:.2} %", 100.0 * overhead);
}

#[test]
fn progressive() {
    assert_cheap(&["--mode", "progressive", "--photons", "20000"]);
}

#[test]
fn gather() {
    assert_cheap(&["--mode", "gather", "--photons", "20000"]);
}

#[test]
fn direct_by_the_members_of_the_thesis() {
    let members = ["--accel", "kd-tree", "--intersect", "badouel", "--search", "kd-balanced"];
    assert_cheap(&[&["--mode", "direct", "--photons", "5000", "--knn", "100"], &members[..]].concat());
}

#[test]
fn path() {
    assert_cheap(&["--mode", "path"]);
}
