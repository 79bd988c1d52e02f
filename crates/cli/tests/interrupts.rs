//! Ctrl-C writes the image so far; a killed program leaves the old file or the new one.

#![cfg(unix)]

mod common;

use common::photinus;
use rustix::process::{Pid, Signal, kill_process};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A render that would take hours.
const LONG: &[&str] = &["render", "--size", "64x64", "--photons", "3000", "--passes", "10000000", "-o", "a.png"];

fn start(folder: &Path, arguments: &[&str]) -> Child {
    photinus(folder).args(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

fn send(child: &Child, signal: Signal) {
    let pid = Pid::from_raw(i32::try_from(child.id()).unwrap()).unwrap();
    kill_process(pid, signal).unwrap();
}

/// Waits until the program says that it has finished `phase` for the first time; returns the reader, which must stay
/// open.
fn after(child: &mut Child, phase: &str) -> impl BufRead + use<> {
    let mut lines = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.starts_with(phase) {
        line.clear();
        assert!(lines.read_line(&mut line).unwrap() > 0, "the program ended before its {phase}");
    }
    lines
}

fn is_png(path: &Path) -> bool {
    let read = photinus::image::read_image(path);
    read.is_ok_and(|image| (image.width, image.height) == (64, 64))
}

#[test]
fn an_interrupt_writes_the_image_so_far() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = start(folder.path(), &[LONG, &["--stats", "a.json"]].concat());
    let mut rest = after(&mut child, "eye pass: ");
    let begun = Instant::now();
    send(&child, Signal::INT);
    let status = child.wait().unwrap();
    let took = begun.elapsed();
    assert_eq!(status.code(), Some(130));
    // The promise is one second on a machine of its own; tests share theirs.
    assert!(took < Duration::from_secs(3), "{took:?}");
    assert!(is_png(&folder.path().join("a.png")));
    let stats: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("a.json")).unwrap()).unwrap();
    assert_eq!(stats["stopped"], "interrupted");
    assert!(stats["passes"].as_u64().unwrap() >= 1);
    let mut said = String::new();
    std::io::Read::read_to_string(&mut rest, &mut said).unwrap();
    assert!(said.contains("interrupted: "), "{said}");
}

#[test]
fn an_interrupt_in_the_first_pass_keeps_what_it_has_done() {
    let folder = tempfile::tempdir().unwrap();
    // This eye pass alone would take hours.
    let endless = ["render", "--mode", "path", "--size", "64x64", "--spp", "2000000", "-o", "a.png"];
    let mut child = start(folder.path(), &endless);
    let _rest = after(&mut child, "memory: ");
    std::thread::sleep(Duration::from_millis(300));
    let begun = Instant::now();
    send(&child, Signal::INT);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let took = begun.elapsed();
    assert!(took < Duration::from_secs(3), "{took:?}");
    assert!(is_png(&folder.path().join("a.png")));
}

#[test]
fn a_second_interrupt_ends_the_program_at_once() {
    let folder = tempfile::tempdir().unwrap();
    // Two interrupts at once: no pass need end, and the picture is not wanted.
    let mut child = start(folder.path(), &[LONG, &["--spp", "2"]].concat());
    let _rest = after(&mut child, "eye pass: ");
    send(&child, Signal::INT);
    send(&child, Signal::INT);
    let begun = Instant::now();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(begun.elapsed() < Duration::from_secs(3));
}
