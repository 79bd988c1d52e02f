//! Photon searches of several engines over the same photons of a scene at the same places of its picture, in turn; one JSON document
//! on standard output.
//!
//! `peers-photons --scene NAME[=FILE] ... --photons N,... [--nanoflann LIBRARY] [--python PYTHON DRIVER] [--work FOLDER]
//! [--only ENGINE,...] [--sets SET,...] [--repeats N] [--threads N,...] [--queries N]`

mod agree;
mod clock;
mod data;
mod engines;
mod measure;
mod sets;

use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

/// What is asked for.
pub struct Arguments {
    /// Built-in names, `NAME=FILE` for scenes in files.
    pub scenes: Vec<String>,
    /// Numbers of photons.
    pub photons: Vec<usize>,
    /// The shim around nanoflann.
    pub nanoflann: Option<PathBuf>,
    /// A Python with the packages, and the driver for it.
    pub python: Option<[PathBuf; 2]>,
    /// Folder for files that are handed over.
    pub work: PathBuf,
    /// Engines; empty for all.
    pub only: Vec<String>,
    /// Sets; empty for all.
    pub sets: Vec<String>,
    /// Measurements of each.
    pub repeats: usize,
    /// Numbers of threads, the least first.
    pub threads: Vec<usize>,
    /// Queries of a set, about.
    pub queries: usize,
}

/// A measurement, or why there is none.
#[derive(Serialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// Photons searched.
    pub photons: usize,
    /// The queries; `build` for the build.
    pub set: String,
    /// Who.
    pub engine: String,
    /// Threads used.
    pub threads: usize,
    /// Of the values.
    pub unit: &'static str,
    /// In turn.
    pub values: Vec<f64>,
    /// What is computed and how well it agrees; why there are no values.
    pub note: String,
}

fn arguments() -> Option<Arguments> {
    let mut out = Arguments {
        scenes: Vec::new(),
        photons: Vec::new(),
        nanoflann: None,
        python: None,
        work: std::env::temp_dir(),
        only: Vec::new(),
        sets: Vec::new(),
        repeats: 5,
        threads: vec![1],
        queries: 1 << 17,
    };
    let numbers = |words: String| -> Option<Vec<usize>> {
        words.split(',').map(|word| word.parse().ok().filter(|n| *n > 0)).collect()
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--scene" => out.scenes.push(words.next()?),
            "--photons" => out.photons = numbers(words.next()?)?,
            "--nanoflann" => out.nanoflann = Some(words.next()?.into()),
            "--python" => out.python = Some([words.next()?.into(), words.next()?.into()]),
            "--work" => out.work = words.next()?.into(),
            "--only" => out.only = words.next()?.split(',').map(str::to_owned).collect(),
            "--sets" => out.sets = words.next()?.split(',').map(str::to_owned).collect(),
            "--repeats" => out.repeats = words.next()?.parse().ok().filter(|n| *n > 0)?,
            "--threads" => out.threads = numbers(words.next()?)?,
            "--queries" => out.queries = words.next()?.parse().ok().filter(|n| *n > 0)?,
            _ => return None,
        }
    }
    (!out.scenes.is_empty() && !out.photons.is_empty()).then_some(out)
}

fn main() -> ExitCode {
    let Some(arguments) = arguments() else {
        eprintln!(
            "usage: peers-photons --scene NAME[=FILE] ... --photons N,... [--nanoflann LIBRARY] [--python PYTHON DRIVER] [--work FOLDER] [--only ENGINE,...] [--sets SET,...] [--repeats N] [--threads N,...] [--queries N]"
        );
        return ExitCode::from(2);
    };
    let pool =
        |threads: &usize| rayon::ThreadPoolBuilder::new().num_threads(*threads).build().map(|pool| (*threads, pool));
    let pools: Vec<_> = match arguments.threads.iter().map(pool).collect() {
        Ok(pools) => pools,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    let most = arguments.photons.iter().copied().max().unwrap_or(0);
    let mut rows = Vec::new();
    for scene in &arguments.scenes {
        eprintln!("{scene}: {most} photons");
        match data::load(scene, most, arguments.queries) {
            Ok(data) => {
                for count in &arguments.photons {
                    measure::photons(&data, *count, &arguments, &pools, &mut rows);
                }
            }
            Err(why) => rows.push(Row {
                scene: scene.clone(),
                photons: most,
                set: "all".into(),
                engine: "all".into(),
                threads: 1,
                unit: "ns_per_search",
                values: Vec::new(),
                note: why,
            }),
        }
    }
    println!("{}", serde_json::to_string_pretty(&rows).expect("plain data"));
    ExitCode::SUCCESS
}
