//! Build times and ray rates of the acceleration structures: `cargo run --release -p photinus-accel --example
//! measure_rays -- [--scene FOLDER] [--structure NAME] [--kernel NAME] [--rounds N]`. Without a scene folder of OBJ
//! files a made-up room of about 60,000 triangles is measured. Rates are those of one thread, the median over rounds.
#![allow(clippy::print_stdout)] // It exists to print.

use libm::{cosf, sinf};
use photinus_accel::{BuildOptions, DEFAULT_STRUCTURE, Kernel, RayCounters, Structure, build};
use photinus_geometry::{Frame, Hit, Primitives, Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Positions and faces of every OBJ file in a folder, as they stand.
fn load_folder(folder: &Path) -> Primitives {
    let mut out = Primitives::default();
    let mut files: Vec<_> = std::fs::read_dir(folder).expect("the folder is readable").flatten().collect();
    files.sort_by_key(|f| f.path());
    for file in files.iter().filter(|f| f.path().extension().is_some_and(|e| e == "obj")) {
        let base = out.positions.len() as u32;
        for line in std::fs::read_to_string(file.path()).expect("the file is readable").lines() {
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => {
                    let v: Vec<f32> = words.take(3).map(|w| w.parse().expect("a coordinate")).collect();
                    out.positions.push(Vec3::new(v[0], v[1], v[2]));
                }
                Some("f") => {
                    let index = |w: &str| w.split('/').next().and_then(|i| i.parse::<u32>().ok()).expect("an index");
                    let face: Vec<u32> = words.map(|w| base + index(w) - 1).collect();
                    for i in 2..face.len() {
                        out.triangles.push([face[0], face[i - 1], face[i]]);
                    }
                }
                _ => {}
            }
        }
    }
    out
}

/// A grid of quads over `point(u, v)`.
fn patch(out: &mut Primitives, nu: u32, nv: u32, point: impl Fn(f32, f32) -> Vec3) {
    let base = out.positions.len() as u32;
    for j in 0..=nv {
        for i in 0..=nu {
            out.positions.push(point(i as f32 / nu as f32, j as f32 / nv as f32));
        }
    }
    for j in 0..nv {
        for i in 0..nu {
            let a = base + j * (nu + 1) + i;
            let (b, c, d) = (a + 1, a + nu + 1, a + nu + 2);
            out.triangles.push([a, b, d]);
            out.triangles.push([a, d, c]);
        }
    }
}

/// A room of 10 x 6 x 10 with 50 bumpy spheres of 1,200 triangles each and walls of 400.
fn made_up_room() -> Primitives {
    let mut out = Primitives::default();
    let size = Vec3::new(10.0, 6.0, 10.0);
    for axis in 0..3 {
        for side in [0.0, 1.0] {
            patch(&mut out, 14, 14, |u, v| {
                let mut p = [u, v, side];
                p.rotate_right((axis + 1) % 3);
                Vec3::from(p) * size
            });
        }
    }
    for k in 0..50 {
        let mut s = Sampler::new(7, StreamKind::Scene, 0, k);
        let center = Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * (size - 2.0) + 1.0;
        let radius = 0.25 + 0.5 * s.next_1d();
        patch(&mut out, 30, 20, |u, v| {
            let (phi, theta) = (u * std::f32::consts::TAU, v * std::f32::consts::PI);
            let r = radius * (1.0 + 0.1 * sinf(7.0 * phi) * sinf(5.0 * theta));
            center + r * Vec3::new(sinf(theta) * cosf(phi), cosf(theta), sinf(theta) * sinf(phi))
        });
    }
    out
}

/// Rays from inside the scene's box in all directions.
fn camera_rays(primitives: &Primitives, count: u32) -> Vec<Ray> {
    let b = primitives.bounds();
    let side = (count as f32).sqrt() as u32;
    let eye = b.min + b.size() * Vec3::new(0.5, 0.5, 0.1);
    (0..side * side)
        .map(|i| {
            let x = (i % side) as f32 / side as f32 - 0.5;
            let y = (i / side) as f32 / side as f32 - 0.5;
            Ray { t_min: 1e-4, ..Ray::new(eye, Vec3::new(1.2 * x, 1.2 * y, 1.0).normalize()) }
        })
        .collect()
}

/// One diffuse bounce for each ray that hits, on the side that it came from.
fn bounce(primitives: &Primitives, rays: &[Ray], hits: &[Hit], seed: u64) -> Vec<Ray> {
    let mut out = Vec::new();
    for (i, (ray, hit)) in rays.iter().zip(hits).enumerate().filter(|(_, (_, h))| h.is_hit()) {
        let [a, b, c] = primitives.triangle(hit.prim as usize);
        let normal = (b - a).cross(c - a).normalize();
        let normal = if normal.dot(ray.dir) > 0.0 { -normal } else { normal };
        let [u, v] = Sampler::new(seed, StreamKind::Test, 0, i as u32).next_2d();
        let (r, phi) = (u.sqrt(), v * std::f32::consts::TAU);
        let local = Vec3::new(r * cosf(phi), r * sinf(phi), (1.0 - u).sqrt());
        let dir = Frame::from_normal(normal).to_world(local);
        out.push(Ray { t_min: 1e-4, ..Ray::new(ray.at(hit.t), dir) });
    }
    // Neighbours in a render's queue are no neighbours in space after a few bounces.
    for i in (1..out.len()).rev() {
        let j = Sampler::new(seed, StreamKind::Test, 1, i as u32).next_1d() * (i + 1) as f32;
        out.swap(i, (j as usize).min(i));
    }
    out
}

/// Seconds for which this thread has run, where the system says so: other programs then disturb less.
fn thread_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split(' ').next()?.parse::<f64>().ok()? * 1e-9)
}

/// Median and least over rounds of the seconds that `work` takes, those of this thread alone where it is said to be `serial`.
fn median_seconds(rounds: usize, serial: bool, mut work: impl FnMut()) -> (f64, f64) {
    let mut seconds: Vec<f64> = (0..rounds)
        .map(|_| {
            let (start, thread_start) = (Instant::now(), thread_seconds());
            work();
            let wall = start.elapsed().as_secs_f64();
            thread_start.filter(|_| serial).and_then(|s| Some(thread_seconds()? - s)).unwrap_or(wall)
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    (seconds[rounds / 2], seconds[0])
}

fn measure(structure: &dyn Structure, name: &str, rays: &[Ray], rounds: usize) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    let mut counters = RayCounters::default();
    structure.closest_hit_counted(rays, &mut hits, &mut counters);
    let seconds = median_seconds(rounds, true, || {
        for (rays, hits) in rays.chunks(1024).zip(hits.chunks_mut(1024)) {
            structure.closest_hit(rays, hits);
        }
    });
    let n = rays.len() as f64;
    println!(
        "{name:8} {:7.3} M rays/s (best {:.3}), {:5.2} nodes, {:5.2} leaves, {:5.2} tests a ray, {:4.1} % hit",
        n / seconds.0 / 1e6,
        n / seconds.1 / 1e6,
        counters.traversal.nodes_visited as f64 / n,
        counters.traversal.leaves_visited as f64 / n,
        counters.intersect.tests as f64 / n,
        100.0 * hits.iter().filter(|h| h.is_hit()).count() as f64 / n,
    );
    hits
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let option = |name: &str| args.iter().position(|a| a == name).and_then(|i| args.get(i + 1)).map(String::as_str);
    let rounds = option("--rounds").map_or(7, |r| r.parse().expect("a number of rounds"));
    let kernel = match option("--kernel") {
        Some("scalar") => Kernel::Scalar,
        Some("avx2") => Kernel::Avx2,
        Some("avx512") => Kernel::Avx512,
        _ => Kernel::Auto,
    };
    let primitives = Arc::new(option("--scene").map_or_else(made_up_room, |f| load_folder(Path::new(f))));
    let name = option("--structure").unwrap_or(DEFAULT_STRUCTURE);
    let options = BuildOptions { kernel, ..BuildOptions::default() };
    println!("{} triangles, {name}, {:?}", primitives.triangle_count(), kernel);
    for threads in [2, 1] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        // One thread is this one, whose own time can be told from that of other programs.
        let pool = if threads == 1 { pool.use_current_thread() } else { pool }.build().expect("threads");
        let once = || drop(std::hint::black_box(build(name, primitives.clone(), &options)).expect("a known name"));
        let seconds = pool.install(|| median_seconds(rounds, threads == 1, once));
        println!("build    {:7.1} ms (best {:.1}) on {threads} threads", seconds.0 * 1e3, seconds.1 * 1e3);
    }
    let structure = build(name, primitives.clone(), &options).expect("a known name");
    println!("{:?}", structure.summary());

    let primary = camera_rays(&primitives, 1 << 18);
    let hits = measure(&*structure, "primary", &primary, rounds);
    let first = bounce(&primitives, &primary, &hits, 1);
    let hits = measure(&*structure, "bounce", &first, rounds);
    let second = bounce(&primitives, &first, &hits, 2);
    let hits = measure(&*structure, "deep", &second, rounds);
    let b = primitives.bounds();
    let lamp = b.min + b.size() * Vec3::new(0.5, 0.9, 0.5);
    let shadow: Vec<Ray> = second
        .iter()
        .zip(&hits)
        .filter(|(_, h)| h.is_hit())
        .map(|(r, h)| Ray { t_max: 0.999, ..Ray { t_min: 1e-3, ..Ray::new(r.at(h.t), lamp - r.at(h.t)) } })
        .collect();
    let mut occluded = vec![false; shadow.len()];
    let seconds = median_seconds(rounds, true, || structure.any_hit(&shadow, &mut occluded));
    let n = shadow.len() as f64 / 1e6;
    println!("any-hit  {:7.3} M rays/s (best {:.3})", n / seconds.0, n / seconds.1);
}
