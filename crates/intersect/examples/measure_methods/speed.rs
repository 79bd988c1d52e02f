//! Time of a test: rays against blocks of eight triangles, as a leaf has them, all in the nearest cache.

use crate::Figure;
use crate::common::randoms;
use photinus_geometry::{Hit, Primitives, Ray, Vec3};
use photinus_intersect::MethodInfo;
use std::hint::black_box;
use std::time::Instant;

/// Blocks, and triangles of a block.
const BLOCKS: u32 = 8;
const BLOCK: u32 = 8;
const RAYS: u32 = 2000;
/// Rounds of all methods in turn; the median counts.
const ROUNDS: usize = 31;

/// Nanoseconds of a test of each method, and the share of tests that hit.
pub fn measure(seed: u64, methods: &[&MethodInfo]) -> Vec<Vec<Figure>> {
    let vec3 = |index: u32| Vec3::from(randoms::<3>(seed, index).map(|x| x as f32));
    let mut triangles = Primitives::default();
    for i in 0..BLOCKS * BLOCK {
        let middle = vec3(4 * i) * 0.5;
        triangles.positions.extend([1, 2, 3].map(|k| middle + vec3(4 * i + k) * 0.7));
        triangles.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let rays: Vec<Ray> = (0..RAYS)
        .map(|i| {
            let origin = vec3(10_000 + 2 * i).normalize() * 2.0;
            Ray::new(origin, vec3(10_001 + 2 * i) * 0.5 - origin)
        })
        .collect();
    let testers: Vec<_> = methods.iter().map(|m| (m.leaf_tester)(&triangles)).collect();
    let blocks: Vec<Vec<u32>> = (0..BLOCKS).map(|b| (b * BLOCK..(b + 1) * BLOCK).collect()).collect();
    let mut times = vec![Vec::new(); methods.len()];
    let mut hits = vec![0u32; methods.len()];
    for _ in 0..ROUNDS {
        for (i, tester) in testers.iter().enumerate() {
            hits[i] = 0;
            let begun = Instant::now();
            for ray in &rays {
                for block in &blocks {
                    let mut best = Hit::MISS;
                    hits[i] += tester.closest_hit(black_box(ray), black_box(block), &mut best).hits;
                    black_box(best);
                }
            }
            times[i].push(begun.elapsed().as_secs_f64() * 1e9 / f64::from(RAYS * BLOCKS * BLOCK));
        }
    }
    let tests = f64::from(RAYS * BLOCKS * BLOCK);
    let mut figures = Vec::new();
    for (times, hits) in times.iter_mut().zip(hits) {
        times.sort_by(f64::total_cmp);
        figures.push(vec![
            ("ns a test".into(), times[ROUNDS / 2]),
            ("ns a test, fastest round".into(), times[0]),
            ("hits within the interval, per cent".into(), 100.0 * f64::from(hits) / tests),
        ]);
    }
    figures
}
