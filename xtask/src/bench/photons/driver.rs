//! The program that searches with every engine in turn.

use crate::Failure;
use crate::bench::program;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What it is asked.
pub struct Task<'a> {
    /// Words of `--scene`.
    pub scenes: &'a [&'a str],
    /// Numbers of photons.
    pub photons: &'a [usize],
    /// The shim around nanoflann.
    pub nanoflann: Option<&'a Path>,
    /// A Python, and the driver for it.
    pub python: Option<&'a [PathBuf; 2]>,
    /// Folder for files that are handed over.
    pub work: &'a Path,
    /// Engines beside ours; empty for all.
    pub only: &'a [String],
    /// Measurements of each.
    pub repeats: usize,
    /// Numbers of threads.
    pub threads: &'a [usize],
    /// Queries of a set, about.
    pub queries: usize,
}

/// A row that it prints.
#[derive(Deserialize)]
pub struct Measured {
    /// The scene.
    pub scene: String,
    /// Photons searched.
    pub photons: usize,
    /// The queries, or `build`, or `brute`.
    pub set: String,
    /// Who.
    pub engine: String,
    /// Threads used.
    pub threads: u32,
    /// Of the values.
    pub unit: String,
    /// In turn.
    pub values: Vec<f64>,
    /// What is computed, how well it agrees; why there are no values.
    pub note: String,
}

/// Runs it.
pub fn run(program: &Path, task: &Task) -> Result<Vec<Measured>, Failure> {
    let mut command = Command::new(program);
    for scene in task.scenes {
        command.args(["--scene", scene]);
    }
    if let Some(library) = task.nanoflann {
        command.arg("--nanoflann").arg(library);
    }
    if let Some(words) = task.python {
        command.arg("--python").args(words);
    }
    if !task.only.is_empty() {
        command.args(["--only", &format!("photinus,{}", task.only.join(","))]);
    }
    let list = |numbers: &[usize]| numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(",");
    command.args(["--photons", &list(task.photons), "--threads", &list(task.threads)]);
    command.args(["--repeats", &task.repeats.to_string(), "--queries", &task.queries.to_string()]);
    program::rows(command.arg("--work").arg(task.work))
}
