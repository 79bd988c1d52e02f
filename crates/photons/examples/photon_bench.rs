//! Times building and searching of every member on one thread: processor time, medians with spread.
//!
//! `cargo run --release -p photinus-photons --example photon_bench [-- [MEMBER...] [photons=N] [support=NAME] [only=WORD]]`

#![allow(clippy::print_stdout)]

#[path = "../tests/support/mod.rs"]
mod support;

use photinus_geometry::Vec3;
use photinus_num::Sampler;
use photinus_photons::{
    BuildOptions, DEFAULT_SUPPORT, GatherQuery, Gathered, Kernel, Photon, SEARCHES, Search, SearchMember, Support,
    find_support,
};
use photinus_profile::SearchCounters;
use std::time::Instant;

/// Photons that a query is to find, on the mean.
const FOUND: f32 = 86.0;
/// The room.
const SIZE: Vec3 = Vec3::new(4.0, 3.0, 5.0);
/// Share of photons and queries on a ball in the room's middle, where normals differ from photon to photon.
const ON_BALL: f32 = 0.15;
const BALL_RADIUS: f32 = 0.8;
/// Queries of a batch: a picture's tile of 64 x 64.
const BATCH: usize = 4096;

/// Least length of a timing, nanoseconds.
const LEAST_TIMING: f64 = 0.15e9;

/// What to time.
struct Wanted {
    members: Vec<String>,
    photons: Vec<usize>,
    only: String,
    support: &'static Support,
}

impl Wanted {
    fn from_arguments() -> Self {
        let support = find_support(DEFAULT_SUPPORT).expect("it is on the list");
        let mut wanted = Self { members: Vec::new(), photons: Vec::new(), only: String::new(), support };
        for argument in std::env::args().skip(1) {
            match argument.split_once('=') {
                Some(("photons", n)) => wanted.photons.push(n.parse().expect("photons=N")),
                Some(("support", name)) => wanted.support = find_support(name).expect("support=NAME"),
                Some(("only", word)) => word.clone_into(&mut wanted.only),
                _ => wanted.members.push(argument),
            }
        }
        if wanted.photons.is_empty() {
            wanted.photons = vec![1 << 16, 1 << 20];
        }
        wanted
    }

    fn has(&self, member: &SearchMember) -> bool {
        if self.members.is_empty() {
            member.name != "brute-force"
        } else {
            self.members.iter().any(|m| m == member.name)
        }
    }

    /// Times `work` over `per` items and prints a row, unless that row is not asked for.
    fn row(&self, what: &str, unit: &str, repeats: usize, per: usize, mut work: impl FnMut()) {
        if !what.contains(&self.only) {
            return;
        }
        let start = Instant::now();
        // Often enough for a timing to be long against the clock's step.
        let first = now_nanos(start);
        work();
        let once = (now_nanos(start) - first).max(1e6);
        let times = (LEAST_TIMING / once).ceil().max(1.0);
        let mut nanos: Vec<f64> = (0..repeats)
            .map(|_| {
                let before = now_nanos(start);
                for _ in 0..times as usize {
                    work();
                }
                (now_nanos(start) - before) / per as f64 / times
            })
            .collect();
        nanos.sort_unstable_by(f64::total_cmp);
        println!("  {what:34} {:9.1} ns {unit}  ({:.1} .. {:.1})", nanos[repeats / 2], nanos[0], nanos[repeats - 1]);
    }
}

/// Processor time of this thread where the system tells it (Linux), which neighbours on the machine disturb less
/// than wall time; wall time elsewhere. Linux brings it up to date every few milliseconds.
fn now_nanos(start: Instant) -> f64 {
    let on_processor = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanos = on_processor.and_then(|text| text.split_whitespace().next()?.parse().ok());
    nanos.unwrap_or_else(|| start.elapsed().as_secs_f64() * 1e9)
}

fn place(s: &mut Sampler) -> (Vec3, Vec3) {
    if s.next_1d() < ON_BALL {
        let d = support::direction(s);
        (SIZE * 0.5 + d * BALL_RADIUS, d)
    } else {
        support::on_box(s, SIZE)
    }
}

/// Points to gather at. In order: swept over each surface in bands, as the pixels of a picture are.
fn queries(count: usize, radius: f32, in_order: bool) -> Vec<GatherQuery> {
    let mut queries: Vec<GatherQuery> = (0..count)
        .map(|i| {
            let mut s = support::sampler(500, i);
            let (position, normal) = place(&mut s);
            GatherQuery { position, radius, normal, max_depth: 100 }
        })
        .collect();
    if in_order {
        let key = |q: &GatherQuery| {
            let n = q.normal;
            let side = (0..3).find(|&a| n[a].abs() == 1.0).map_or(6, |a| 2 * a + usize::from(n[a] > 0.0));
            let axis = [1, 2, 0, 0, 0, 0, 0][side];
            let across = [2, 1, 2, 2, 1, 1, 1][side];
            (side, (q.position[across] * 100.0) as i32, (q.position[axis] * 1e4) as i32)
        };
        queries.sort_by_key(key);
    }
    queries
}

fn bench(wanted: &Wanted, member: &SearchMember, photons: &[Photon], radius: f32, count: usize) {
    let options = BuildOptions { radius_hint: radius };
    println!("{} over {} photons, {} of radius {radius:.4}", member.name, photons.len(), wanted.support.name);
    // Many builds a timing, so that each is long against the clock's step.
    let builds = (1 << 20) / photons.len();
    let mut copies: Vec<Vec<Photon>> = Vec::new();
    wanted.row("build and copy", "a photon", 5, builds * photons.len(), || {
        copies.extend((0..builds).map(|_| photons.to_vec()));
        for photons in copies.drain(..) {
            member.build(photons, &options).expect("built");
        }
    });
    wanted.row("copy alone", "a photon", 5, builds * photons.len(), || {
        copies.extend((0..builds).map(|_| photons.to_vec()));
        copies.clear();
    });
    let search = wanted.support.over(member.build(photons.to_vec(), &options).expect("built"));
    println!("  {:34} {:9.1} bytes a photon", "memory", search.summary().bytes as f64 / photons.len() as f64);
    if ["build", "copy"].contains(&wanted.only.as_str()) {
        return;
    }
    for in_order in [true, false] {
        let queries = queries(count, radius, in_order);
        searches(wanted, &*search, &queries, if in_order { "in order" } else { "shuffled" });
    }
}

fn searches(wanted: &Wanted, search: &dyn Search, queries: &[GatherQuery], order: &str) {
    let mut out = vec![Gathered::default(); queries.len()];
    let mut counters = SearchCounters::default();
    search.gather_counted(queries, Kernel::Epanechnikov, &mut out, &mut counters);
    let mean = |n: u64| n as f64 / queries.len() as f64;
    let (found, tested) = (mean(counters.photons_found), mean(counters.photons_tested));
    println!("  {order:34} {found:9.2} found, {tested:.1} tested a query");
    let kernels = [
        (Kernel::Constant, "constant"),
        (Kernel::Cone { k: 1.1 }, "cone"),
        (Kernel::Epanechnikov, "epanechnikov"),
        (Kernel::Gaussian, "gaussian"),
    ];
    for (kernel, name) in kernels {
        wanted.row(&format!("gather, {name}, {order}"), "a query", 7, queries.len(), || {
            for (q, o) in queries.chunks(BATCH).zip(out.chunks_mut(BATCH)) {
                search.gather(q, kernel, o);
            }
        });
    }
    wanted.row(&format!("gather, constant, one batch, {order}"), "a query", 7, queries.len(), || {
        search.gather(queries, Kernel::Constant, &mut out);
    });
    wanted.row(&format!("one by one, {order}"), "a query", 7, queries.len(), || {
        for (q, o) in queries.iter().zip(&mut out) {
            search.gather(std::slice::from_ref(q), Kernel::Epanechnikov, std::slice::from_mut(o));
        }
    });
    let mut sum = 0f32;
    wanted.row(&format!("visit, {order}"), "a query", 5, queries.len(), || {
        for q in queries {
            search.visit(q, &mut |photon, d2| sum += photon.flux().x * d2);
        }
    });
    let mut found = Vec::new();
    for (what, anywhere) in [("50 nearest", false), ("50 nearest anywhere", true)] {
        wanted.row(&format!("{what}, {order}"), "a query", 5, queries.len(), || {
            for q in queries {
                search.nearest(q.position, 50, if anywhere { f32::INFINITY } else { q.radius }, &mut found);
                sum += found.len() as f32;
            }
        });
    }
    assert!(sum.is_finite());
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread");
    // Inside the pool, so that its only thread is the one that is timed.
    pool.install(run);
}

fn run() {
    let wanted = Wanted::from_arguments();
    for &count in &wanted.photons {
        let photons = support::photons(400, count, place);
        let area = 2.0 * (SIZE.x * SIZE.y + SIZE.y * SIZE.z + SIZE.z * SIZE.x);
        let radius = (FOUND * area / (count as f32 * (1.0 - ON_BALL)) / std::f32::consts::PI).sqrt();
        for member in SEARCHES.iter().filter(|m| wanted.has(m)) {
            bench(&wanted, member, &photons, radius, if member.name == "brute-force" { 200 } else { 200_000 });
        }
    }
}
