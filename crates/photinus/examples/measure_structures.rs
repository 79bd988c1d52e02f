//! Every acceleration structure over built-in scenes, as rows of a table: what it is, and how fast rays pass.
//! `cargo run --release -p photinus --example measure_structures -- [--rounds N] [--only NAME,...] [SCENE ...]`.
//!
//! Rays are those of the camera (of every second pixel across and down), those that leave its hits in random directions,
//! and those that leave the hits of four such bounces. Times are processor time of one thread,
//! the least of all rounds.

#![expect(clippy::print_stdout, reason = "an example talks to its reader")]

use photinus::geometry::{Hit, Primitives, Ray, Vec3};
use photinus::{BuildOptions, Clip, GridCells, LoadOptions, TreeOptions};
use photinus_accel::{BuildError, RayCounters, STRUCTURES, Structure};
use photinus_num::{Sampler, StreamKind};
use photinus_profile::thread_nanoseconds;
use photinus_render::CameraModel;
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

/// Bounces before the deep rays.
const BOUNCES: u32 = 4;
/// Rays handed over at a time.
const BATCH: usize = 512;
/// Rays of structures that test every primitive.
const FEW_RAYS: usize = 500;

/// A structure with its options.
struct Variant {
    label: String,
    options: TreeOptions,
}

/// The list with default options, and what else the pages of the structures tell of.
fn variants() -> Vec<Variant> {
    let more: [(&str, &str, BuildOptions); 5] = [
        ("kd-tree", "clip exact", BuildOptions { clip: Clip::Exact, ..BuildOptions::default() }),
        ("octree", "clip exact", BuildOptions { clip: Clip::Exact, ..BuildOptions::default() }),
        ("bsp-tree", "axes only", BuildOptions { oblique_prims: 0, ..BuildOptions::default() }),
        ("uniform-grid", "clip exact", BuildOptions { clip: Clip::Exact, ..BuildOptions::default() }),
        ("compact-grid", "hashed", BuildOptions { grid_cells: GridCells::Hashed, ..BuildOptions::default() }),
    ];
    let mut out = Vec::new();
    for info in STRUCTURES {
        let options = TreeOptions { accel: info.name.to_owned(), ..TreeOptions::default() };
        out.push(Variant { label: info.name.to_owned(), options });
        for (_, what, build) in more.iter().filter(|(name, _, _)| *name == info.name) {
            let options = TreeOptions { accel: info.name.to_owned(), build: build.clone() };
            out.push(Variant { label: format!("{}, {what}", info.name), options });
        }
    }
    out
}

/// Rays that leave the hits in directions of which every one is as likely as its cosine, on the side they came from.
fn bounce(primitives: &Primitives, structure: &dyn Structure, rays: &[Ray], depth: u32) -> Vec<Ray> {
    let mut hits = vec![Hit::MISS; rays.len()];
    structure.closest_hit(rays, &mut hits);
    let found = rays.iter().zip(&hits).filter(|(_, hit)| (hit.prim as usize) < primitives.triangle_count());
    found
        .enumerate()
        .map(|(i, (ray, hit))| {
            let [a, b, c] = primitives.triangle(hit.prim as usize);
            let normal = (b - a).cross(c - a).normalize_or(Vec3::Y);
            let normal = if normal.dot(ray.dir) > 0.0 { -normal } else { normal };
            let mut sampler = Sampler::new(1, StreamKind::Test, depth.into(), i as u32);
            let ball = loop {
                let p = Vec3::new(sampler.next_1d(), sampler.next_1d(), sampler.next_1d()) * 2.0 - Vec3::ONE;
                if (1e-4..1.0).contains(&p.length_squared()) {
                    break p.normalize();
                }
            };
            let dir = (normal + ball * 0.999).normalize();
            Ray { t_min: 1e-3, ..Ray::new(ray.at(hit.t), dir) }
        })
        .collect()
}

/// A structure, and the seconds that its build takes: short builds are repeated.
fn build(
    primitives: &Arc<Primitives>,
    options: &TreeOptions,
    rounds: u32,
) -> Result<(Box<dyn Structure>, f64), BuildError> {
    let mut least = f64::INFINITY;
    let mut round = 0;
    loop {
        round += 1;
        let begun = thread_nanoseconds();
        let structure = photinus_accel::build(&options.accel, primitives.clone(), &options.build)?;
        least = least.min((thread_nanoseconds() - begun) as f64 * 1e-9);
        if round >= rounds || least > 1.0 {
            return Ok((structure, least));
        }
    }
}

/// Millions of rays a second.
fn speed(structure: &dyn Structure, rays: &[Ray], rounds: u32) -> f64 {
    let mut hits = vec![Hit::MISS; BATCH];
    let mut best = f64::INFINITY;
    for _ in 0..rounds {
        let begun = thread_nanoseconds();
        for batch in rays.chunks(BATCH) {
            structure.closest_hit(batch, &mut hits[..batch.len()]);
        }
        best = best.min((thread_nanoseconds() - begun) as f64 * 1e-9);
    }
    rays.len() as f64 * 1e-6 / best
}

/// Nodes and tests of a ray.
fn work(structure: &dyn Structure, rays: &[Ray]) -> [f64; 2] {
    let mut counters = RayCounters::default();
    structure.closest_hit_counted(rays, &mut vec![Hit::MISS; rays.len()], &mut counters);
    [counters.traversal.nodes_visited, counters.intersect.tests].map(|count| count as f64 / rays.len() as f64)
}

fn measure(scene_name: &str, rounds: u32, only: &[String]) -> Result<(), Box<dyn Error>> {
    let scene = photinus::open(scene_name, &LoadOptions::default())?;
    let model = CameraModel::new(&scene.camera, &scene.film);
    let mut sampler = Sampler::new(0, StreamKind::Eye, 0, 0);
    let pixels = (0..scene.film.height).step_by(2).flat_map(|y| (0..scene.film.width).step_by(2).map(move |x| [x, y]));
    let primary: Vec<Ray> = pixels.map(|p| model.ray(p.map(|x| x as f32 + 0.5), &mut sampler).ray).collect();
    let guide = photinus::build_tree(scene.clone(), &TreeOptions::default())?;
    let mut kinds = vec![primary];
    for depth in 0..BOUNCES {
        let next = bounce(&guide.primitives, &*guide.structure, &kinds[kinds.len() - 1], depth);
        kinds.push(next);
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let kinds = [&kinds[0], &kinds[1], &kinds[BOUNCES as usize]];
    println!("\n{scene_name}: {} triangles; rays: {:?}\n", guide.report.triangles, kinds.map(Vec::len));
    println!(
        "| structure | build ms | bytes/tri | depth | nodes | leaves | empty | prims/leaf | nodes/ray, primary, bounce, \
         deep | tests/ray, primary, bounce, deep | M rays/s, primary, bounce, deep |\n|---|---|---|---|---|---|---|---|---|---|---|"
    );
    for Variant { label, options } in variants() {
        if !only.is_empty() && !only.contains(&options.accel) {
            continue;
        }
        let (structure, build_secs) = pool.install(|| build(&guide.primitives, &options, rounds))?;
        let summary = structure.summary();
        let share = if summary.prims_per_leaf > 1000.0 { FEW_RAYS } else { usize::MAX };
        let rays = kinds.map(|rays| &rays[..rays.len().min(share)]);
        let counted = rays.map(|rays| work(&*structure, rays));
        let speeds = rays.map(|rays| speed(&*structure, rays, rounds));
        let three = |values: [f64; 3], digits: usize| values.map(|x| format!("{x:.digits$}")).join(", ");
        println!(
            "| {label} | {:.0} | {:.0} | {} | {} | {} | {} | {:.2} | {} | {} | {} |",
            build_secs * 1e3,
            summary.bytes as f64 / guide.report.triangles.max(1) as f64,
            summary.depth,
            summary.nodes,
            summary.leaves,
            summary.empty_leaves,
            summary.prims_per_leaf,
            three(counted.map(|c| c[0]), 1),
            three(counted.map(|c| c[1]), 1),
            three(speeds, 3),
        );
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut rounds, mut only, mut scenes) = (1, Vec::new(), Vec::new());
    // A folder to write into, which every example may be given, is no scene: nothing is written.
    let mut words = std::env::args().skip(1).filter(|word| !Path::new(word).is_dir());
    while let Some(word) = words.next() {
        match word.as_str() {
            "--rounds" => rounds = words.next().ok_or("--rounds needs a number")?.parse()?,
            "--only" => only = words.next().ok_or("--only needs names")?.split(',').map(str::to_owned).collect(),
            _ => scenes.push(word),
        }
    }
    if scenes.is_empty() {
        scenes.push("texture-1210".to_owned());
    }
    scenes.iter().try_for_each(|scene| measure(scene, rounds, &only))
}
