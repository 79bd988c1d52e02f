//! `cargo xtask ci` on a machine without a C linker: a path with stand-ins for the programs that it may call.

#![cfg(target_os = "linux")]

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

fn script(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    std::fs::write(&path, format!("#!/bin/sh\n{text}\n")).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
}

/// Runs the check where `cargo` answers and `cc` does not exist; apt notes what it was asked for and does nothing.
fn check(folder: &Path, arguments: &[&str]) -> Output {
    script(folder, "cargo", "exit 0");
    script(folder, "id", "echo 0");
    script(folder, "apt-get", &format!("echo \"$@\" >> '{}/asked'", folder.display()));
    std::os::unix::fs::symlink("/bin/sh", folder.join("sh")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    command.arg("ci").args(arguments).env("PATH", folder).env_remove("PHOTINUS_SCENES").output().unwrap()
}

const LINE: &str = "apt-get update && apt-get install -y --no-install-recommends gcc libc6-dev";

#[test]
fn without_consent_the_line_that_installs_it_is_named_and_nothing_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let output = check(folder.path(), &[]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains(&format!("a C linker is missing: {LINE}\n")), "{said}");
    assert!(said.contains("`cargo xtask ci --install`"), "{said}");
    assert!(!said.contains("rustfmt") && !said.contains("clippy"), "these are there: {said}");
    assert!(!folder.path().join("asked").exists());
}

#[test]
fn with_consent_apt_is_asked_and_an_install_that_does_not_help_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let output = check(folder.path(), &["--install"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains(&format!("a C linker is missing and `{LINE}` did not install it")), "{said}");
    let asked = std::fs::read_to_string(folder.path().join("asked")).unwrap();
    assert_eq!(asked, "update\ninstall -y --no-install-recommends gcc libc6-dev\n");
}
