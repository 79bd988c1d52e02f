//! The kernels against their scalar twin, and the built tree against its invariants.

use super::*;
use crate::options::Kernel;
use photinus_geometry::{Sphere, Vec3};
use photinus_num::{Sampler, StreamKind};

fn scene(seed: u64, count: u32, size: f32) -> Arc<Primitives> {
    let mut out = Primitives::default();
    for i in 0..count {
        let mut s = Sampler::new(seed, StreamKind::Test, 0, i);
        let mut vec3 = || (Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - 1.0) * size;
        let (a, b, c) = (vec3(), vec3(), vec3());
        out.positions.extend([a, a + 0.1 * b, a + 0.1 * c]);
        out.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        if i % 20 == 0 {
            out.spheres.push(Sphere { center: b, radius: 0.05 * size });
        }
    }
    Arc::new(out)
}

fn rays(count: u32, size: f32) -> Vec<Ray> {
    (0..count)
        .map(|i| {
            let mut s = Sampler::new(99, StreamKind::Test, 0, i);
            let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - 1.0;
            let mut ray = Ray::new(vec3() * size, vec3());
            if i % 5 == 0 {
                ray.dir.y = 0.0;
            }
            if i % 7 == 0 {
                ray.t_max = 0.5 * size;
            }
            ray
        })
        .collect()
}

/// The machine's other kernels: none without AVX2, where the scalar kernel is all that runs.
fn kernels() -> Vec<Kernel> {
    [Kernel::Avx2, Kernel::Avx512].into_iter().filter(|kernel| Chosen::new(*kernel).kernel() == *kernel).collect()
}

#[test]
fn all_kernels_give_the_same_bits_and_the_same_work() {
    for (seed, size) in [(1, 1.0), (2, 1e-20), (3, 1e15)] {
        let primitives = scene(seed, 2000, size);
        let rays = rays(3000, size);
        let run = |kernel| {
            let tree = build(primitives.clone(), &BuildOptions { kernel, ..BuildOptions::default() }).unwrap();
            let mut hits = vec![Hit::MISS; rays.len()];
            let mut counters = RayCounters::default();
            tree.closest_hit_counted(&rays, &mut hits, &mut counters);
            let mut plain = vec![Hit::MISS; rays.len()];
            tree.closest_hit(&rays, &mut plain);
            assert_eq!(hits, plain);
            let mut occluded = vec![false; rays.len()];
            tree.any_hit_counted(&rays, &mut occluded, &mut counters);
            (hits, occluded, counters.intersect, counters.traversal)
        };
        let scalar = run(Kernel::Scalar);
        assert!(scalar.0.iter().filter(|h| h.is_hit()).count() > 300);
        for kernel in kernels() {
            assert!(run(kernel) == scalar, "{kernel:?} at size {size}");
        }
    }
}

#[test]
fn trees_hold_what_they_are_built_over_on_any_number_of_threads() {
    for count in [0, 1, 2, 7, 8, 9, 100, 20_000] {
        let primitives = scene(7, count, 1.0);
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let tree = pool.install(|| binary::build(&primitives));
            emit::collapse(&tree, &primitives, Leaves::Blocks).unwrap()
        };
        let one = run(1);
        for threads in [2, 7] {
            let other = run(threads);
            assert!(format!("{:?}{:?}", one.nodes, one.blocks) == format!("{:?}{:?}", other.nodes, other.blocks));
            assert_eq!(one.ids, other.ids);
        }
        let mut ids: Vec<u32> = one.ids.clone();
        ids.extend(one.blocks.iter().flat_map(|b| b.ids).filter(|id| *id != photinus_geometry::NO_HIT));
        ids.sort_unstable();
        assert_eq!(ids, (0..primitives.len() as u32).collect::<Vec<_>>());
    }
}

#[test]
fn boxes_hold_their_contents() {
    for size in [1e-30, 1.0, 1e30] {
        let tree = WideBvh::new(&scene(3, 3000, size), &BuildOptions::default()).unwrap();
        tree.validate();
        let summary = tree.summary();
        assert_eq!(summary.references, 3000 + 150);
        assert!(summary.depth <= 8 && summary.prims_per_leaf > 2.0, "{summary:?}");
    }
}
