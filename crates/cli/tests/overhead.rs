//! What the profile costs, in instructions: valgrind counts them, as wall time tells nothing of a few percent on a
//! machine that others use too. Valgrind knows no AVX-512, so that these are the AVX2 kernels.

#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use std::process::Command;

/// The most that counting and timing one query in 64 may add to a render's work.
const MOST: f64 = 0.03;

/// Instructions of a render of one pass, on one thread. Nothing in it depends on time: a picture is saved on the way only
/// between passes.
fn instructions(arguments: &[&str], more: &[&str], profile_every: u32) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null", env!("CARGO_BIN_EXE_photinus")]);
    command.args(["render", "two-spheres", "--threads", "1", "--passes", "1", "--quiet", "-o", "a.png"]);
    command.args(["--profile-every", &profile_every.to_string()]);
    let output = command.args(arguments).args(more).current_dir(folder.path()).output().unwrap_or_else(|error| {
        panic!("valgrind cannot be started ({error}): `apt-get install valgrind`, or `cargo xtask ci --install`")
    });
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    let count = said.lines().find_map(|line| line.split_once("Collected : "));
    count.and_then(|(_, count)| count.trim().parse().ok()).unwrap_or_else(|| panic!("no count in {said}"))
}

/// Share that the profile adds to what a render with the arguments `large` does beyond one with `small`: what it does
/// once does not count for it.
#[track_caller]
#[allow(clippy::print_stdout)] // The measurement itself, for whoever runs this with --nocapture.
fn assert_cheap(arguments: &[&str], small: &[&str], large: &[&str]) {
    let work = |every| instructions(arguments, large, every) - instructions(arguments, small, every);
    let (with, without) = (work(64), work(0));
    let overhead = with / without - 1.0;
    assert!(without > 1e7, "{arguments:?}: {without} instructions are no work");
    assert!(overhead < MOST, "{arguments:?}: the profile costs {:.2} %", 100.0 * overhead);
    // Batches are cut at windows, which may save some work, but never much.
    assert!(overhead > -MOST, "{arguments:?}: {:.2} %: these were not the same renders", 100.0 * overhead);
    println!("{arguments:?}: {:.2} %", 100.0 * overhead);
}

const FEW_SAMPLES: &[&str] = &["--size", "96x96", "--spp", "1"];
const MANY_SAMPLES: &[&str] = &["--size", "96x96", "--spp", "4"];

#[test]
fn photons() {
    // The look at the scene before the first pass takes no more than 50 000.
    let with_photons = |photons| ["--size", "16x16", "--photons", photons];
    assert_cheap(&["--mode", "direct"], &with_photons("50000"), &with_photons("120000"));
}

#[test]
fn progressive() {
    assert_cheap(&["--mode", "progressive", "--photons", "20000"], FEW_SAMPLES, MANY_SAMPLES);
}

#[test]
fn gather() {
    assert_cheap(&["--mode", "gather", "--photons", "20000"], FEW_SAMPLES, MANY_SAMPLES);
}

#[test]
fn direct_by_the_members_of_the_thesis() {
    let members = ["--accel", "kd-tree", "--intersect", "badouel-thesis", "--search", "kd-balanced"];
    let arguments = [&["--mode", "direct", "--photons", "5000", "--knn", "100"], &members[..]].concat();
    assert_cheap(&arguments, FEW_SAMPLES, MANY_SAMPLES);
}

#[test]
fn path() {
    assert_cheap(&["--mode", "path"], FEW_SAMPLES, MANY_SAMPLES);
}
