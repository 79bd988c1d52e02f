//! The program that traces with every engine in one process, built apart from everything else.

use crate::{Failure, tools};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Its sources.
const FOLDER: &str = "benches/peers/rays";

/// What it is asked.
pub struct Task<'a> {
    /// Words of `--mesh`.
    pub meshes: &'a [&'a str],
    /// Embree's library.
    pub embree: Option<&'a Path>,
    /// Engines beside ours; empty for all.
    pub only: &'a [String],
    /// Measurements of each.
    pub repeats: usize,
    /// Threads.
    pub threads: usize,
}

/// A row that it prints.
#[derive(Deserialize)]
pub struct Measured {
    /// The mesh.
    pub mesh: String,
    /// Its triangles.
    pub triangles: usize,
    /// The rays, or `build`.
    pub set: String,
    /// Who.
    pub engine: String,
    /// Threads used.
    pub threads: u32,
    /// M rays/s, or seconds of a build.
    pub values: Vec<f64>,
    /// How many rays differ from ours; why there are no values.
    pub note: String,
}

/// Builds the program. Others' code is compiled for this machine, as their users would; ours chooses its instructions
/// while it runs either way. The lock pins the others; what our crates come to need is added to it.
pub fn build(root: &Path, folder: &Path) -> Result<PathBuf, Failure> {
    let target = folder.join("build");
    let output = Command::new(tools::cargo())
        .args(["build", "--release", "--quiet", "--manifest-path"])
        .arg(root.join(FOLDER).join("Cargo.toml"))
        .arg("--target-dir")
        .arg(&target)
        .env("RUSTFLAGS", "-C target-cpu=native")
        .output()
        .map_err(|e| format!("cargo could not be started: {e}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().to_owned());
    }
    Ok(target.join("release").join(format!("peers-rays{}", std::env::consts::EXE_SUFFIX)))
}

/// Runs it; what it says of its progress goes to standard error.
pub fn run(program: &Path, task: &Task) -> Result<Vec<Measured>, Failure> {
    let mut command = Command::new(program);
    for mesh in task.meshes {
        command.args(["--mesh", mesh]);
    }
    if let Some(library) = task.embree {
        command.arg("--embree").arg(library);
    }
    if !task.only.is_empty() {
        command.args(["--only", &format!("photinus,{}", task.only.join(","))]);
    }
    command.args(["--repeats", &task.repeats.to_string(), "--threads", &task.threads.to_string()]);
    let output = command.stdin(Stdio::null()).stderr(Stdio::inherit()).output();
    let output = output.map_err(|e| format!("{}: {e}", program.display()))?;
    if !output.status.success() {
        return Err(format!("{} failed: {}", program.display(), output.status));
    }
    serde_json::from_slice(&output.stdout).map_err(|e| format!("{} printed no table: {e}", program.display()))
}
