//! Ray-triangle tests a second of `brute-force`, by scene and kernel, on one thread by its processor time:
//! `cargo run --release -p photinus --example measure_brute_force -- [--rounds N] [--rays N] [--only WORDS]`.
//!
//! Scenes are two built-in rooms, and as many triangles as the first has, at random in a cube: small ones, larger ones of which a good part of the blocks
//! pass the sieve, and ones of which most do. Rays run through random points of the bounds in random directions; those that
//! ask for any hit start beyond the bounds and run away, so that no test is spared.

#![expect(clippy::print_stdout, reason = "an example talks to its reader")]

use photinus::geometry::{Hit, Primitives, Ray, Vec3};
use photinus::{LoadOptions, TreeOptions};
use photinus_accel::{BuildOptions, Kernel, Structure, build};
use photinus_num::{Sampler, StreamKind};
use photinus_profile::thread_nanoseconds;
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

/// Seed of triangles and rays.
const SEED: u64 = 1;
/// Triangles of the made-up scenes: as many as room-1 has.
const TRIANGLES: u32 = 54_841;
/// The plain way gets this share of the rays.
const PLAIN_SHARE: usize = 64;

/// Three random numbers in [-1, 1).
fn random(stream: u64, index: u32) -> Vec3 {
    let mut sampler = Sampler::new(SEED, StreamKind::Test, stream, index);
    Vec3::new(sampler.next_1d(), sampler.next_1d(), sampler.next_1d()) * 2.0 - Vec3::ONE
}

/// Triangles with edges of up to about `size` in a cube of edge two.
fn soup(size: f32) -> Primitives {
    let mut out = Primitives::default();
    for i in 0..TRIANGLES {
        let a = random(1, 3 * i);
        out.positions.extend([a, a + random(1, 3 * i + 1) * size, a + random(1, 3 * i + 2) * size]);
        out.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    out
}

/// Rays through random points of the bounds, starting there or beyond the bounds and away.
fn rays(primitives: &Primitives, count: u32, beyond: bool) -> Vec<Ray> {
    let bounds = primitives.bounds();
    let (middle, half) = ((bounds.min + bounds.max) * 0.5, (bounds.max - bounds.min) * 0.5);
    (0..count)
        .map(|i| {
            let dir = random(3, i).normalize_or(Vec3::X);
            let away = if beyond { dir * (2.0 * half.length()) } else { Vec3::ZERO };
            Ray::new(middle + random(2, i) * half + away, dir)
        })
        .collect()
}

/// The median over all rounds of billions of tests a second.
fn speed(tests: f64, rounds: usize, mut run: impl FnMut()) -> f64 {
    let mut speeds: Vec<f64> = (0..rounds)
        .map(|_| {
            let begun = thread_nanoseconds();
            run();
            tests / (thread_nanoseconds() - begun) as f64
        })
        .collect();
    speeds.sort_by(f64::total_cmp);
    speeds[rounds / 2]
}

fn measure(name: &str, primitives: &Arc<Primitives>, settings: &Settings) -> Result<(), Box<dyn Error>> {
    let Settings { rounds, count, only } = settings;
    let (rounds, count) = (*rounds, *count);
    let (nearest, away) = (rays(primitives, count, false), rays(primitives, count, true));
    for (kernel, label) in [(Kernel::Scalar, "plain"), (Kernel::Avx2, "AVX2"), (Kernel::Avx512, "AVX-512")] {
        if !format!("{name}, {label}").contains(only.as_str()) {
            continue;
        }
        let structure: Box<dyn Structure> =
            build("brute-force", Arc::clone(primitives), &BuildOptions { kernel, ..BuildOptions::default() })?;
        let take = if kernel == Kernel::Scalar { nearest.len().div_ceil(PLAIN_SHARE) } else { nearest.len() };
        let tests = (take * primitives.len()) as f64;
        let mut hits = vec![Hit::MISS; take];
        let closest = speed(tests, rounds, || structure.closest_hit(&nearest[..take], &mut hits));
        let mut occluded = vec![false; take];
        let any = speed(tests, rounds, || structure.any_hit(&away[..take], &mut occluded));
        let share = 100 * hits.iter().filter(|hit| hit.is_hit()).count() / take;
        assert!(!occluded.contains(&true), "rays that run away hit nothing");
        println!("| {name} | {label} | {closest:.3} | {any:.3} | {share} |");
    }
    Ok(())
}

/// How much is measured.
struct Settings {
    rounds: usize,
    count: u32,
    /// Part of the names of what is.
    only: String,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut settings = Settings { rounds: 5, count: 4096, only: String::new() };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        // A folder to write into, which every example may be given: a small run that writes nothing.
        if Path::new(&word).is_dir() {
            settings = Settings { rounds: 1, count: 16, ..settings };
            continue;
        }
        let value = words.next().ok_or(format!("{word} needs a value"))?;
        match word.as_str() {
            "--rounds" => settings.rounds = value.parse::<usize>()?.max(1),
            "--rays" => settings.count = value.parse()?,
            "--only" => settings.only = value,
            _ => return Err(format!("unknown: {word}").into()),
        }
    }
    println!("| scene | kernel | closest hit, G tests/s | any hit, G tests/s | rays that hit, per cent |");
    println!("|---|---|---|---|---|");
    for name in ["room-1", "room-4"] {
        let room = photinus::build_tree(photinus::open(name, &LoadOptions::default())?, &TreeOptions::default())?;
        measure(name, &room.primitives, &settings)?;
    }
    for (name, size) in [("small triangles", 0.03), ("large triangles", 0.25), ("huge triangles", 1.0)] {
        measure(name, &Arc::new(soup(size)), &settings)?;
    }
    Ok(())
}
