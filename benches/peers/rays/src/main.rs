//! Rays per second of several engines over the same meshes and the same rays, in turn; one JSON document on standard
//! output.
//!
//! `peers-rays --mesh NAME[=FILE] ... [--embree LIBRARY] [--only ENGINE,...] [--sets SET,...] [--repeats N] [--threads N] [--rays N]`

mod agree;
mod engines;
mod furnished;
mod measure;
mod meshes;
mod sets;

use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

/// What is asked for.
pub struct Arguments {
    /// Built-in names, `ply=FILE` for meshes in files.
    pub meshes: Vec<String>,
    /// Embree's shared library.
    pub embree: Option<PathBuf>,
    /// Engines; empty for all.
    pub only: Vec<String>,
    /// Sets; empty for all.
    pub sets: Vec<String>,
    /// Measurements of each.
    pub repeats: usize,
    /// Threads of traversal and build.
    pub threads: usize,
    /// Rays of a set, about.
    pub rays: usize,
}

/// A measurement, or why there is none.
#[derive(Serialize)]
pub struct Row {
    /// The mesh.
    pub mesh: String,
    /// Its triangles.
    pub triangles: usize,
    /// The rays; `build` for the build.
    pub set: String,
    /// Who.
    pub engine: String,
    /// Threads used.
    pub threads: usize,
    /// M rays/s, or seconds of a build.
    pub values: Vec<f64>,
    /// What else there is to say, above all why there are no values.
    pub note: String,
}

fn arguments() -> Option<Arguments> {
    let mut out = Arguments {
        meshes: Vec::new(),
        embree: None,
        only: Vec::new(),
        sets: Vec::new(),
        repeats: 5,
        threads: 1,
        rays: 1 << 18,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--mesh" => out.meshes.push(words.next()?),
            "--embree" => out.embree = Some(words.next()?.into()),
            "--only" => out.only = words.next()?.split(',').map(str::to_owned).collect(),
            "--sets" => out.sets = words.next()?.split(',').map(str::to_owned).collect(),
            "--repeats" => out.repeats = words.next()?.parse().ok().filter(|n| *n > 0)?,
            "--threads" => out.threads = words.next()?.parse().ok().filter(|n| *n > 0)?,
            "--rays" => out.rays = words.next()?.parse().ok().filter(|n| *n > 0)?,
            _ => return None,
        }
    }
    (!out.meshes.is_empty()).then_some(out)
}

fn main() -> ExitCode {
    let Some(arguments) = arguments() else {
        eprintln!(
            "usage: peers-rays --mesh NAME[=FILE] ... [--embree LIBRARY] [--only ENGINE,...] [--sets SET,...] [--repeats N] [--threads N] [--rays N]"
        );
        return ExitCode::from(2);
    };
    if let Err(error) = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global() {
        eprintln!("{error}");
        return ExitCode::FAILURE;
    }
    let mut rows = Vec::new();
    for mesh in &arguments.meshes {
        match meshes::load(mesh) {
            Ok(mesh) => measure::mesh(&mesh, &arguments, &mut rows),
            Err(why) => rows.push(Row {
                mesh: mesh.clone(),
                triangles: 0,
                set: "all".into(),
                engine: "all".into(),
                threads: arguments.threads,
                values: Vec::new(),
                note: why,
            }),
        }
    }
    println!("{}", serde_json::to_string_pretty(&rows).expect("plain data"));
    ExitCode::SUCCESS
}
