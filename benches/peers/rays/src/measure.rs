//! Times all engines over one mesh in turn, set by set.

use crate::engines::{ENGINES, Engine};
use crate::meshes::Mesh;
use crate::sets::{self, Set};
use crate::{Arguments, Row, agree};
use photinus_accel::{BuildOptions, DEFAULT_STRUCTURE};
use photinus_geometry::{Hit, Ray};
use rayon::prelude::*;
use std::time::Instant;

/// Rays that a thread takes at a time where there are several.
const SHARE: usize = 16 * 1024;

/// All rows of a mesh.
pub fn mesh(mesh: &Mesh, arguments: &Arguments, rows: &mut Vec<Row>) {
    let structure = photinus_accel::build(DEFAULT_STRUCTURE, mesh.primitives.clone(), &BuildOptions::default())
        .expect("a mesh that was loaded");
    let sets = sets::all(mesh, &*structure, arguments.rays);
    let row = |set: &str, engine: &str, values: Vec<f64>, note: String| Row {
        mesh: mesh.name.clone(),
        triangles: mesh.primitives.triangle_count(),
        set: set.to_owned(),
        engine: engine.to_owned(),
        threads: arguments.threads,
        values,
        note,
    };
    let mut engines = Vec::new();
    for (name, build) in ENGINES {
        if !arguments.only.is_empty() && !arguments.only.iter().any(|only| only == name) {
            continue;
        }
        let mut seconds = Vec::new();
        for _ in 0..arguments.repeats.min(3) {
            let begun = Instant::now();
            match build(mesh, arguments) {
                Ok(engine) => {
                    seconds.push(begun.elapsed().as_secs_f64());
                    if seconds.len() == 1 {
                        engines.push((*name, engine));
                    }
                }
                Err(why) => {
                    rows.push(row("build", name, Vec::new(), why));
                    break;
                }
            }
        }
        if !seconds.is_empty() {
            rows.push(row("build", name, seconds, String::new()));
        }
    }
    for set in &sets {
        if !arguments.sets.is_empty() && !arguments.sets.iter().any(|name| name == set.name) {
            continue;
        }
        let mut results: Vec<(Vec<f64>, Result<String, String>)> = Vec::new();
        for (_, engine) in &engines {
            results.push((Vec::new(), check(&**engine, &*structure, set)));
        }
        for _ in 0..arguments.repeats {
            for ((_, engine), (values, agreed)) in engines.iter().zip(&mut results) {
                if agreed.is_ok() {
                    values.push(time(&**engine, set, arguments.threads));
                }
            }
        }
        for ((name, engine), (values, agreed)) in engines.iter().zip(results) {
            let work = engine.work(set).map_or_else(String::new, |work| format!("; {work}"));
            rows.push(row(set.name, name, values, agreed.unwrap_or_else(|why| why) + &work));
        }
    }
}

fn check(engine: &dyn Engine, structure: &dyn photinus_accel::Structure, set: &Set) -> Result<String, String> {
    if set.any {
        let (mut ours, mut theirs) = (vec![false; set.rays.len()], vec![false; set.rays.len()]);
        structure.any_hit(&set.rays, &mut ours);
        if !engine.any(&set.rays, &mut theirs) {
            return Err("its bindings have no any-hit query".into());
        }
        return agree::shadows(&ours, &theirs);
    }
    let (mut ours, mut theirs) = (vec![Hit::MISS; set.rays.len()], vec![Hit::MISS; set.rays.len()]);
    structure.closest_hit(&set.rays, &mut ours);
    engine.closest(&set.rays, &mut theirs);
    agree::hits(&ours, &theirs)
}

/// M rays/s: of a single thread by its own clock, which stands still while others have the processor, of several by the
/// wall's.
fn time(engine: &dyn Engine, set: &Set, threads: usize) -> f64 {
    let (mut hits, mut occluded) = (vec![Hit::MISS; set.rays.len()], vec![false; set.rays.len()]);
    let seconds = if threads == 1 {
        let begun = thread_seconds();
        if set.any {
            engine.any(&set.rays, &mut occluded);
        } else {
            engine.closest(&set.rays, &mut hits);
        }
        thread_seconds() - begun
    } else {
        let begun = Instant::now();
        if set.any {
            let parts = set.rays.par_chunks(SHARE).zip(occluded.par_chunks_mut(SHARE));
            parts.for_each(|(rays, occluded): (&[Ray], &mut [bool])| {
                engine.any(rays, occluded);
            });
        } else {
            let parts = set.rays.par_chunks(SHARE).zip(hits.par_chunks_mut(SHARE));
            parts.for_each(|(rays, hits): (&[Ray], &mut [Hit])| engine.closest(rays, hits));
        }
        begun.elapsed().as_secs_f64()
    };
    set.rays.len() as f64 / seconds / 1e6
}

fn thread_seconds() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9
}
