//! What a refit saves and costs: `cargo run --release -p photinus --example measure_refit -- [SCENE]`.
//!
//! The vertices of a built-in scene swing aside, by a part of the scene's height. Each row
//! says how long the refit and a new build took (the least of five), the cost by the surface-area heuristic before, after
//! the refit, and of the new structure, and how many primitives a ray is tested against in both: rays between random
//! points of the scene's bounds.

#![expect(clippy::print_stdout, reason = "an example talks to its reader")]

use photinus::geometry::{Aabb, Hit, Primitives, Ray, Vec3};
use photinus::{LoadOptions, TreeOptions};
use photinus_accel::{BuildOptions, RayCounters, RefitError, STRUCTURES, Structure, build};
use photinus_num::{Sampler, StreamKind};
use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

const RAYS: u32 = 20_000;
const ROUNDS: usize = 5;

/// Every vertex aside by up to `reach`, by a wave over the scene of that wavelength.
fn swung(primitives: &Primitives, wavelength: f32, reach: f32) -> Primitives {
    let swing = |p: Vec3| {
        let turn = |x: f32| std::f32::consts::TAU * x / wavelength;
        p + Vec3::new(libm::sinf(turn(p.y + 0.3 * p.z)), 0.0, libm::cosf(turn(p.y + 0.3 * p.x))) * reach
    };
    let mut out = primitives.clone();
    out.positions.iter_mut().for_each(|p| *p = swing(*p));
    out
}

/// Tests a ray, of rays between random points.
fn tests(structure: &dyn Structure, bounds: &Aabb) -> f64 {
    let rays: Vec<Ray> = (0..RAYS)
        .map(|i| {
            let mut s = Sampler::new(3, StreamKind::Test, 0, i);
            let mut point = || bounds.min + bounds.size() * Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
            let (a, b) = (point(), point());
            Ray::new(a, b - a)
        })
        .collect();
    let mut counters = RayCounters::default();
    structure.closest_hit_counted(&rays, &mut vec![Hit::MISS; rays.len()], &mut counters);
    counters.intersect.tests as f64 / f64::from(RAYS)
}

fn least(mut secs: impl FnMut() -> Result<f64, Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        best = best.min(secs()?);
    }
    Ok(best * 1e3)
}

fn main() -> Result<(), Box<dyn Error>> {
    // A folder to write into, which every example may be given, is no scene: nothing is written.
    let mut words = std::env::args().skip(1).filter(|word| !Path::new(word).is_dir());
    let name = words.next().unwrap_or_else(|| "texture-1210".into());
    let scene = photinus::open(&name, &LoadOptions::default())?;
    let primitives = photinus::build_tree(scene, &TreeOptions::default())?.primitives;
    // Rays where most vertices are: some scenes stand on a plain that is far larger.
    let mut heights: Vec<f32> = primitives.positions.iter().map(|p| p.y).collect();
    heights.sort_by(f32::total_cmp);
    let height = heights.last().unwrap_or(&0.0) - heights.first().unwrap_or(&0.0);
    let middle = primitives.positions.iter().sum::<Vec3>() / primitives.positions.len().max(1) as f32;
    let half = Vec3::splat(height);
    let bounds = Aabb { min: middle - half, max: middle + half };
    println!("{name}: {} triangles, {height} high\n", primitives.triangle_count());
    println!("| structure | moved | build ms | refit ms | cost before | after | anew | tests a ray after | anew |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for info in STRUCTURES {
        let build = |p: &Primitives| build(info.name, Arc::new(p.clone()), &BuildOptions::default());
        let mut structure = build(&primitives)?;
        let before = structure.summary().sah_cost;
        if let Err(RefitError::Unsupported { .. }) = structure.refit(&primitives) {
            continue;
        }
        for part in [0.02, 0.08, 0.32] {
            let moved = swung(&primitives, height, part * height);
            let refit_ms = least(|| {
                let begun = Instant::now();
                structure.refit(&moved)?;
                Ok(begun.elapsed().as_secs_f64())
            })?;
            let shared = Arc::new(moved.clone());
            let build_ms = least(|| {
                let begun = Instant::now();
                photinus_accel::build(info.name, shared.clone(), &BuildOptions::default())?;
                Ok(begun.elapsed().as_secs_f64())
            })?;
            let anew = build(&moved)?;
            println!(
                "| `{}` | {part} | {build_ms:.1} | {refit_ms:.2} | {before:.2} | {:.2} | {:.2} | {:.1} | {:.1} |",
                info.name,
                structure.summary().sah_cost,
                anew.summary().sah_cost,
                tests(&*structure, &bounds),
                tests(&*anew, &bounds),
            );
        }
    }
    Ok(())
}
