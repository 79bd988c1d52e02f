//! The blocked kernels against their scalar twin and against the plain way.

use super::dispatch::Chosen;
use super::*;
use crate::structure::RayCounters;
use photinus_geometry::{Hit, Sphere};
use photinus_num::{Sampler, StreamKind};

fn random(seed: u64, index: u32) -> Vec3 {
    let mut s = Sampler::new(seed, StreamKind::Test, 0, index);
    Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - Vec3::ONE
}

/// Triangles of all sizes around a middle, some degenerate or not finite, and a few spheres.
fn scene(seed: u64, count: u32, middle: Vec3, size: f32) -> Primitives {
    let mut out = Primitives::default();
    for i in 0..count {
        let a = middle + random(seed, 3 * i) * size;
        let edge = size * [0.3, 0.03, 0.003, 1.5][i as usize % 4];
        out.positions.extend([a, a + random(seed, 3 * i + 1) * edge, a + random(seed, 3 * i + 2) * edge]);
        out.triangles.push([3 * i, 3 * i + 1, if i % 50 == 49 { 3 * i } else { 3 * i + 2 }]);
    }
    for (i, bad) in [f32::NAN, f32::INFINITY, 3e38, -3e37].into_iter().enumerate() {
        if let Some(position) = out.positions.get_mut(300 * (i + 1)) {
            position[i % 3] = bad;
        }
    }
    for i in 0..count / 100 {
        out.spheres.push(Sphere { center: middle + random(seed ^ 1, i) * size, radius: 0.1 * size });
    }
    out
}

/// Rays through vertices, along axes and at random; some with intervals, some that can hit nothing.
fn rays(primitives: &Primitives, count: u32, middle: Vec3, size: f32) -> Vec<Ray> {
    (0..count)
        .map(|i| {
            let origin = middle + random(7, 2 * i) * size * 2.0;
            let vertex = primitives.positions.get(i as usize * 31 % primitives.positions.len().max(1));
            let target =
                vertex.copied().filter(|v| i % 2 == 0 && v.is_finite()).unwrap_or(middle + random(7, 2 * i + 1) * size);
            let mut ray = Ray::new(origin, target - origin);
            match i % 16 {
                1 => ray.t_max = 0.9,
                3 => (ray.t_min, ray.t_max) = (-3.0, 0.5),
                4 => {
                    let axis = i as usize / 16 % 3;
                    ray.origin = target - Vec3::AXES[axis] * size;
                    ray.dir = Vec3::AXES[axis] * if i % 32 == 4 { -1.0 } else { 1.0 };
                    ray.t_min = -4.0 * size;
                }
                5 => ray.dir.y = -0.0,
                7 => ray.dir = [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY][i as usize / 16 % 3],
                9 => ray.origin.x = [f32::NAN, 1e38, -3e38][i as usize / 16 % 3],
                11 => ray.t_max = [f32::NAN, -1.0, 0.0][i as usize / 16 % 3],
                13 => ray.dir = Vec3::new(1.0, -1.0, 1.0),
                _ => {}
            }
            ray
        })
        .collect()
}

const SCENES: [(u32, Vec3, f32); 8] = [
    (2500, Vec3::ZERO, 1.0),
    (1100, Vec3::new(1e6, -3.0, 0.1), 10.0),
    (1100, Vec3::ZERO, 1e-20),
    (1100, Vec3::ZERO, 1e-38),
    (1100, Vec3::ZERO, 1e18),
    (1100, Vec3::new(0.0, 1e20, 0.0), 1e15),
    (1100, Vec3::ZERO, 1e36),
    (17, Vec3::ONE, 1.0),
];

/// Hits, any hits, and the counters of both.
type Answers = (Vec<Hit>, Vec<bool>, RayCounters, RayCounters);

fn answers(structure: &dyn Structure, rays: &[Ray]) -> Answers {
    let (mut hits, mut occluded) = (vec![Hit::MISS; rays.len()], vec![false; rays.len()]);
    let mut counters = [RayCounters::default(); 2];
    structure.closest_hit_counted(rays, &mut hits, &mut counters[0]);
    structure.any_hit_counted(rays, &mut occluded, &mut counters[1]);
    let mut uncounted = (vec![Hit::MISS; rays.len()], vec![false; rays.len()]);
    structure.closest_hit(rays, &mut uncounted.0);
    structure.any_hit(rays, &mut uncounted.1);
    assert!(uncounted == (hits.clone(), occluded.clone()), "counting changed the answers");
    for counters in &mut counters {
        counters.ticks = Default::default();
    }
    (hits, occluded, counters[0], counters[1])
}

#[test]
fn all_kernels_give_the_same_bits_and_the_same_work() {
    for (count, middle, size) in SCENES {
        let primitives = scene(1, count, middle, size);
        let rays = rays(&primitives, 700, middle, size);
        let run = |kernel| answers(&Blocked::new(&primitives, kernel), &rays);
        let scalar = run(Kernel::Scalar);
        let found = scalar.0.iter().filter(|hit| hit.is_hit()).count();
        assert!(found > 100 || count < 100, "{found} of {} rays hit around {middle}, size {size}", rays.len());
        for kernel in [Kernel::Avx2, Kernel::Avx512] {
            // Without them there is nothing but the twin.
            if Chosen::new(kernel).kernel() == kernel {
                assert!(run(kernel) == scalar, "{kernel:?} around {middle}, size {size}");
            }
        }
    }
}

#[test]
fn blocks_give_the_bits_of_the_plain_way() {
    for (count, middle, size) in SCENES {
        let primitives = scene(2, count, middle, size);
        let rays = rays(&primitives, 700, middle, size);
        let plain = answers(&Plain::new(&primitives, &BuildOptions::default()).unwrap(), &rays);
        let blocked = answers(&Blocked::new(&primitives, Kernel::Auto), &rays);
        for ((a, b), ray) in plain.0.iter().zip(&blocked.0).zip(&rays) {
            assert_eq!(a, b, "{ray:?} around {middle}, size {size}");
        }
        assert_eq!(plain.1, blocked.1);
        assert_eq!(plain.2, blocked.2, "work for the closest hit");
        // Any hit ends after a chunk of triangles, not after one.
        assert_eq!(plain.3.intersect.hits, blocked.3.intersect.hits);
        assert_eq!(plain.3.traversal, blocked.3.traversal);
        assert!(plain.3.intersect.tests <= blocked.3.intersect.tests);
    }
}

/// The sieve is worth having: it leaves out most blocks of small triangles, also far from the origin of coordinates and
/// with one triangle far out.
#[test]
fn the_sieve_leaves_out_what_rays_pass_by() {
    use super::kernels::Kernel as _;
    use super::layout::{Blocks, CHUNK, LANES};
    use super::sieve::Sieve;
    for (middle, size) in [(Vec3::ZERO, 1.0), (Vec3::splat(1e4), 1.0), (Vec3::ZERO, 1e-12), (Vec3::ZERO, 1e12)] {
        let mut primitives = Primitives::default();
        for i in 0..(CHUNK * LANES) as u32 {
            let a = middle + random(3, 3 * i) * size;
            let edge = if i == 100 { 1e20 } else { 0.03 } * size;
            primitives.positions.extend([a, a + random(3, 3 * i + 1) * edge, a + random(3, 3 * i + 2) * edge]);
            primitives.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        let blocks = Blocks::new(&primitives);
        let mut passed = 0;
        for i in 0..100 {
            let start = <Woop as RtiMethod<f32>>::start((middle + random(4, i) * size).into(), random(5, i).into());
            let sieve = Sieve::new(&start.unwrap(), &blocks.middle);
            passed += kernels::scalar::Scalar.sift(&sieve, &blocks.boxes).count_ones();
        }
        assert!((100..1200).contains(&passed), "{passed} of {} blocks at {middle}, size {size}", 100 * CHUNK);
    }
}
