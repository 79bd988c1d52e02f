//! A benchmark's own program, which measures with every engine, built apart from everything else.

use crate::{Failure, tools};
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Builds the program `peers-NAME` of `benches/peers/NAME` below `folder`. Others' code is compiled for this machine, as
/// their users would; ours chooses its instructions while it runs either way. The lock pins the others; what our crates
/// come to need is added to it.
pub fn build(root: &Path, folder: &Path, name: &str) -> Result<PathBuf, Failure> {
    let target = folder.join("build");
    let output = Command::new(tools::cargo())
        .args(["build", "--release", "--quiet", "--manifest-path"])
        .arg(root.join("benches/peers").join(name).join("Cargo.toml"))
        .arg("--target-dir")
        .arg(&target)
        .env("RUSTFLAGS", "-C target-cpu=native")
        .output()
        .map_err(|e| format!("cargo could not be started: {e}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().to_owned());
    }
    Ok(target.join("release").join(format!("peers-{name}{}", std::env::consts::EXE_SUFFIX)))
}

/// Runs it and reads the rows that it prints; what it says of its progress goes to standard error.
pub fn rows<T: DeserializeOwned>(command: &mut Command) -> Result<Vec<T>, Failure> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.stdin(Stdio::null()).stderr(Stdio::inherit()).output();
    let output = output.map_err(|e| format!("{name}: {e}"))?;
    if !output.status.success() {
        return Err(format!("{name} failed: {}", output.status));
    }
    serde_json::from_slice(&output.stdout).map_err(|e| format!("{name} printed no table: {e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_and_failures_said() {
        let say = |script: &str| rows::<u32>(Command::new("sh").args(["-c", script]));
        assert_eq!(say("echo '[1, 2]'"), Ok(vec![1, 2]));
        assert!(say("echo '[1, 2'").is_err_and(|why| why.starts_with("sh printed no table")));
        assert!(say("exit 3").is_err_and(|why| why.starts_with("sh failed")));
    }
}
