//! Programs that fetch and unpack what a benchmark needs.

use crate::Failure;
use std::path::Path;
use std::process::Command;

/// Runs a program to its end; an error is the last line that it says.
pub fn run(command: &mut Command) -> Result<(), Failure> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|e| format!("`{name}` could not be started: {e}"))?;
    if output.status.success() {
        return Ok(());
    }
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let last = errors.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
    Err(format!("`{name}` failed: {}", last.trim()))
}

/// Unpacks a zip archive.
pub fn unpack(archive: &Path, folder: &Path) -> Result<(), Failure> {
    run(Command::new("python3").args(["-m", "zipfile", "-e"]).arg(archive).arg(folder))
}

/// Fetches a Debian package without installing it, and unpacks it into `folder`, which is made.
pub fn debian(package: &str, folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    run(Command::new("apt-get").args(["download", package]).current_dir(folder))?;
    let files = std::fs::read_dir(folder).map_err(|e| e.to_string())?.flatten().map(|entry| entry.path());
    let archive = files.into_iter().find(|path| path.extension().is_some_and(|extension| extension == "deb"));
    let archive = archive.ok_or("apt-get fetched no package")?;
    run(Command::new("dpkg-deb").arg("-x").arg(&archive).arg(folder))?;
    std::fs::remove_file(archive).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_say_why() {
        let why = run(Command::new("sh").args(["-c", "echo no room >&2; exit 1"])).err().unwrap();
        assert_eq!(why, "`sh` failed: no room");
        assert!(run(&mut Command::new("photinus-has-no-such-program")).is_err());
        assert!(run(&mut Command::new("true")).is_ok());
    }
}
