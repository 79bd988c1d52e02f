//! The program that traces with every engine in turn.

use crate::Failure;
use crate::bench::program;
use serde::Deserialize;
use std::path::Path;
use std::process::Command;

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

/// Runs it.
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
    program::rows(command.args(["--repeats", &task.repeats.to_string(), "--threads", &task.threads.to_string()]))
}
