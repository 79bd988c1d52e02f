//! Renders that are killed or interrupted at random moments: every file is the old one or the new one, whole.

#![cfg(unix)]
// Whoever looks at a failure must know the seed.
#![allow(clippy::print_stderr)]

mod common;

use common::{photinus, run_in, success};
use rustix::process::{Pid, Signal, kill_process};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ExitStatus, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// Moments of each test; another seed tries others.
const MOMENTS: u32 = 20;
const SEED: u64 = 20_261_122;

/// Numbers in 0..1: the moments need to be arbitrary, not good (multiplier and increment of Knuth's MMIX).
struct Moments(u64);

impl Moments {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn start(folder: &Path, arguments: &[&str]) -> Child {
    photinus(folder).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

fn send(child: &Child, signal: Signal) {
    kill_process(Pid::from_raw(i32::try_from(child.id()).unwrap()).unwrap(), signal).unwrap();
}

/// Temporary files in the folder.
fn litter(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.to_string_lossy().ends_with(".tmp")).collect()
}

/// A render of a fraction of a second into `picture` and `a.json`.
fn short(picture: &str) -> Vec<&str> {
    let mut arguments = vec!["render", "--size", "64x64", "--photons", "1000", "--passes", "6", "--profile-every", "0"];
    arguments.extend(["--quiet", "--threads", "1", "--stats", "a.json", "-o", picture]);
    arguments
}

#[test]
fn a_kill_leaves_the_old_files_or_the_new_ones() {
    for picture in ["a.exr", "a.png"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(picture);
        let stats = folder.path().join("a.json");
        let begun = Instant::now();
        success(&run_in(folder.path(), &short(picture)));
        let whole = begun.elapsed();
        let new = std::fs::read(&path).unwrap();
        let old = b"the file that was there".to_vec();
        let mut moments = Moments(SEED);
        let (mut killed, mut most) = (0, 0);
        for moment in 0..MOMENTS / 2 {
            // Every other render has no old file.
            let was_there = moment % 2 == 0;
            for file in [&path, &stats] {
                if was_there { std::fs::write(file, &old).unwrap() } else { drop(std::fs::remove_file(file)) }
            }
            // Half of the moments anywhere, half around the end, where files are written.
            let at = if moment % 4 < 2 { moments.next() } else { 0.8 + 0.3 * moments.next() };
            let mut child = start(folder.path(), &short(picture));
            std::thread::sleep(whole.mul_f64(at));
            child.kill().ok();
            let status = child.wait().unwrap();
            killed += u32::from(status.signal().is_some());
            let what = format!("{picture}, seed {SEED}, moment {moment} at {at:.3} of {whole:?}: {status}");

            let found = std::fs::read(&path).ok();
            let untouched = was_there.then_some(&old);
            assert!(found.as_ref() == untouched || found.as_ref() == Some(&new), "{what}: half a picture");
            let found = std::fs::read(&stats).ok();
            if found.as_ref() != untouched {
                let json: serde_json::Value = serde_json::from_slice(&found.unwrap()).expect("a whole document");
                assert_eq!(json["passes"], 6, "{what}");
                assert_eq!(std::fs::read(&path).unwrap(), new, "{what}: statistics of a picture that is not there");
            }
            most = most.max(litter(folder.path()).len());
            assert!(litter(folder.path()).len() <= killed as usize, "{what}: more than one temporary file a kill");
        }
        eprintln!("{picture}: seed {SEED}, {killed} of {} killed, at most {most} temporary files", MOMENTS / 2);
        assert!(killed >= MOMENTS / 10, "seed {SEED}: nearly every render ended before its kill");

        // Once they are old the next render clears them away.
        std::fs::write(folder.path().join(".photinus-killed.tmp"), b"half").unwrap();
        for file in litter(folder.path()) {
            let file = std::fs::File::options().append(true).open(file).unwrap();
            file.set_modified(SystemTime::now() - Duration::from_secs(3600)).unwrap();
        }
        success(&run_in(folder.path(), &short(picture)));
        assert_eq!(litter(folder.path()), Vec::<PathBuf>::new());
        assert_eq!(std::fs::read(&path).unwrap(), new);
    }
}

/// What became of an interrupted render: exit code and files agree. Returns whether there was a picture.
fn check_interrupted(folder: &Path, picture: &str, status: ExitStatus, signal: Signal, what: &str) -> bool {
    let (path, stats) = (folder.join(picture), folder.join("a.json"));
    if status.signal() == Some(signal.as_raw()) || (status.code() == Some(130) && !stats.exists()) {
        // Before the program listened, or before there was anything to keep.
        assert!(!path.exists() && !stats.exists(), "{what}: files without statistics");
        return false;
    }
    assert_eq!(status.code(), Some(130), "{what}");
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(&stats).unwrap()).expect("a whole document");
    assert_eq!(json["stopped"], "interrupted", "{what}");
    assert_eq!(json["output"].is_string(), path.exists(), "{what}");
    if path.exists() {
        let image = photinus::image::read_image(&path).unwrap_or_else(|error| panic!("{what}: {error}"));
        assert_eq!((image.width, image.height), (64, 64), "{what}");
        assert!(image.pixels.iter().flatten().all(|x| x.is_finite()), "{what}");
    }
    path.exists()
}

#[test]
fn an_interrupt_keeps_the_picture_so_far() {
    let folder = tempfile::tempdir().unwrap();
    let begun = Instant::now();
    success(&run_in(folder.path(), &short("a.png")));
    let whole = begun.elapsed();
    let mut moments = Moments(SEED);
    let mut pictures = 0;
    for moment in 0..MOMENTS {
        let folder = tempfile::tempdir().unwrap();
        let picture = if moment % 2 == 0 { "a.exr" } else { "a.png" };
        let signal = if moment % 4 < 2 { Signal::INT } else { Signal::TERM };
        let mut endless = short(picture);
        let passes = endless.iter().position(|a| *a == "6").unwrap();
        endless[passes] = "100000000";
        // From the start to several passes.
        let at = whole.mul_f64(2.0 * moments.next());
        let mut child = start(folder.path(), &endless);
        std::thread::sleep(at);
        send(&child, signal);
        let begun = Instant::now();
        let status = child.wait().unwrap();
        let took = begun.elapsed();
        let what = format!("seed {SEED}, moment {moment}: {signal:?} after {at:?}: {status}");
        // The promise is one second on a machine of its own; tests share theirs.
        assert!(took < Duration::from_secs(3), "{what}, took {took:?}");
        pictures += u32::from(check_interrupted(folder.path(), picture, status, signal, &what));
        assert_eq!(litter(folder.path()), Vec::<PathBuf>::new(), "{what}");
    }
    eprintln!("seed {SEED}: {pictures} of {MOMENTS} interrupted renders had a picture");
    assert!(pictures >= MOMENTS / 4, "seed {SEED}: {pictures} pictures");
}

#[test]
fn a_second_interrupt_of_either_kind_ends_at_once() {
    let mut moments = Moments(SEED + 1);
    for (first, second) in [
        (Signal::INT, Signal::INT),
        (Signal::TERM, Signal::TERM),
        (Signal::INT, Signal::TERM),
        (Signal::TERM, Signal::INT),
    ] {
        let folder = tempfile::tempdir().unwrap();
        // Each picture takes long to write, so that the second interrupt comes before it is there.
        let slow = ["render", "--size", "3000x3000", "--passes", "100000000", "--quiet", "-o", "a.exr"];
        let mut child = start(folder.path(), &slow);
        let at = Duration::from_secs_f64(0.1 + 0.3 * moments.next());
        std::thread::sleep(at);
        send(&child, first);
        // Two pending interrupts have no order.
        std::thread::sleep(Duration::from_millis(20));
        if child.try_wait().unwrap().is_none() {
            send(&child, second);
        }
        let begun = Instant::now();
        let status = child.wait().unwrap();
        let took = begun.elapsed();
        assert_eq!(status.code(), Some(130), "{first:?} and {second:?} after {at:?}");
        assert!(took < Duration::from_secs(1), "{first:?} and {second:?} after {at:?}: {took:?}");
        if let Ok(image) = photinus::image::read_image(folder.path().join("a.exr")) {
            assert_eq!(image.width, 3000);
        }
    }
}
