//! Running the built program and looking at what it says.

// Each test program uses its own part of this.
#![allow(dead_code)]

use std::path::Path;
use std::process::{Command, Output, Stdio};

/// The program with a folder to work in, without a terminal.
pub fn photinus(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_photinus"));
    command.current_dir(folder).stdin(Stdio::null());
    command
}

/// Runs the program in a folder of its own.
pub fn run(arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    run_in(folder.path(), arguments)
}

/// Runs the program in `folder`.
pub fn run_in(folder: &Path, arguments: &[&str]) -> Output {
    photinus(folder).args(arguments).output().unwrap()
}

/// Standard output as text.
pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// Standard error as text.
pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Asserts success and returns standard output.
#[track_caller]
pub fn success(output: &Output) -> String {
    assert!(output.status.success(), "{:?}\n{}", output.status, stderr(output));
    stdout(output)
}

/// Asserts the exit code, one line on standard error that begins with `photinus: `, and nothing on standard output.
#[track_caller]
pub fn refused(output: &Output, code: i32) -> String {
    let said = stderr(output);
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert_eq!(stdout(output), "", "nothing belongs on standard output");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.starts_with("photinus: "), "{said}");
    said.trim_end().to_owned()
}

/// Asserts success and one JSON document on standard output, and returns it.
#[track_caller]
pub fn json(output: &Output) -> serde_json::Value {
    serde_json::from_str(&success(output)).expect("one JSON document")
}

/// A render that takes a blink.
pub const SMALL: &[&str] = &["--size", "24x20", "--photons", "3000", "--passes", "3", "--quiet"];
