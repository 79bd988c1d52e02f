//! The kernels against their scalar twin, and the built tree against its invariants.

use super::packet::PACKET;
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
        let primitives = scene(seed, 1000, size);
        let rays = [rays(3000, size), grouped_rays(size)].concat();
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
            let tree = pool.install(|| binary::build(&primitives, Leaves::Blocks, 2));
            emit::collapse(&tree, &primitives).unwrap()
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

/// Triangles that no bin border divides, or whose sizes leave what can be computed.
#[test]
fn trees_of_hopeless_scenes_are_shallow_and_whole() {
    let alike = |i: u32| if i.is_multiple_of(1000) { scene(5, 1, 1e30) } else { scene(4, 1, 1.0) };
    let far = |i: u32| scene(i.into(), 1, if i.is_multiple_of(2) { 1.1e38 } else { 1e-38 });
    let nested = |i: u32| scene(6, 1, 2.0_f32.powi(i as i32 % 200 - 100));
    let unbounded = |i: u32| scene(i.into(), 1, [1.0, f32::NAN, f32::INFINITY, 1e38][i as usize % 4]);
    let parts: [&dyn Fn(u32) -> Arc<Primitives>; 4] = [&alike, &far, &nested, &unbounded];
    for (i, (part, hittable)) in parts.into_iter().zip([10_000, 10_000, 10_000, 5000]).enumerate() {
        let mut all = Primitives::default();
        for part in (0..10_000).map(part) {
            all.triangles.push([0, 1, 2].map(|v| v + all.positions.len() as u32));
            all.positions.extend(&part.positions);
        }
        let tree = WideBvh::new(&all, &BuildOptions::default()).unwrap();
        tree.validate();
        let summary = tree.summary();
        assert_eq!((summary.references, summary.depth <= 78), (hittable, true), "scene {i}: {summary:?}");
    }
}

/// All nodes of a binary tree, each held against its children.
fn binary_nodes(tree: &binary::BinaryTree) -> Vec<binary::BinaryNode> {
    let (mut out, mut waiting) = (Vec::new(), vec![binary::Place::default()]);
    while let Some(place) = waiting.pop() {
        let node = tree.node(place);
        out.push(*node);
        if !node.is_leaf() {
            let [a, b] = tree.children(place).map(|child| tree.node(child));
            assert_eq!(node.bounds, a.bounds.union(b.bounds));
            assert_eq!((a.first, b.first, node.count), (node.first, node.first + a.count, a.count + b.count));
            waiting.extend(tree.children(place));
        }
    }
    out
}

#[test]
fn reinsertions_leave_trees_whole_and_make_them_cheaper() {
    let primitives = scene(7, 20_000, 1.0);
    let mut last = f64::INFINITY;
    for rounds in [0, 1, 4] {
        let tree = binary::build(&primitives, Leaves::Blocks, rounds);
        let nodes = binary_nodes(&tree);
        let measure = visits::Visits::new(&tree.bounds());
        let visits: f64 = nodes.iter().map(|node| f64::from(measure.of(&node.bounds))).sum();
        assert!(visits < last, "{rounds} rounds: {visits} after {last}");
        last = visits;
        let options = BuildOptions { reinsertion_rounds: rounds, ..BuildOptions::default() };
        WideBvh::new(&primitives, &options).unwrap().validate();
    }
    let options = BuildOptions { reinsertion_rounds: 101, ..BuildOptions::default() };
    assert!(WideBvh::new(&primitives, &options).is_err());
}

#[test]
fn reinsertions_end_where_all_boxes_are_alike() {
    let mut alike = Primitives::default();
    for i in 0..30_000 {
        let [x, y, z] = [i % 7, i % 11, i % 13].map(|k| 1e-3 * k as f32);
        alike.positions.extend([Vec3::new(x, 0.0, y), Vec3::new(1.0, 1.0 + y, z), Vec3::new(z, 1.0, 1.0 + x)]);
        alike.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let options = BuildOptions { reinsertion_rounds: 20, ..BuildOptions::default() };
    let tree = WideBvh::new(&alike, &options).unwrap();
    tree.validate();
    assert_eq!(tree.summary().references, 30_000);
}

#[test]
fn walls_that_fit_a_block_may_stand_apart() {
    // Floor, ceiling and two sides of a low hall: any two parts of them are as large as the hall.
    let corner = |i: usize| Vec3::from(std::array::from_fn(|axis| [9.0, 2.0, 9.0][axis] * (i >> axis & 1) as f32));
    let mut hall = Primitives { positions: (0..8).map(corner).collect(), ..Primitives::default() };
    for [a, b, c, d] in [[0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]] {
        hall.triangles.extend([[a, b, c], [a, c, d]]);
    }
    let tree = binary::build(&hall, Leaves::Blocks, 0);
    let nodes = binary_nodes(&tree);
    let flat = nodes.iter().filter(|node| node.count == 2 && node.bounds.size().min_element() < 0.1).count();
    assert_eq!(flat, 4);
}

/// Groups of sixteen rays side by side: a camera's, mirrored ones, shadows, and some that must not run together.
fn grouped_rays(size: f32) -> Vec<Ray> {
    let mut out = Vec::new();
    for group in 0..600 {
        let mut s = Sampler::new(77, StreamKind::Test, 1, group);
        let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - 1.0;
        let (origin, dir) = (vec3() * size, vec3());
        for i in 0..PACKET as u32 {
            let mut s = Sampler::new(78, StreamKind::Test, group.into(), i);
            let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - 1.0;
            let apart = if group % 3 == 0 { Vec3::ZERO } else { vec3() * (0.01 * size) };
            let mut ray = Ray::new(origin + apart, dir + vec3() * 0.02);
            ray.t_max = if group % 5 == 0 { size * s.next_1d() } else { f32::INFINITY };
            match (group % 50, i) {
                (10, 7) => ray.dir = -ray.dir,
                (20, 3) => ray.dir.y = 0.0,
                (30, 15) => ray.t_min = -1.0,
                (40, 9) => ray.t_max = -1.0,
                (45, 2) => ray.origin.x = f32::NAN,
                (47, 8) => ray.dir.z = f32::INFINITY,
                (49, 0) => ray.dir = Vec3::ZERO,
                _ => {}
            }
            out.push(ray);
        }
    }
    out
}

#[test]
fn packets_find_what_single_rays_find() {
    for (seed, size) in [(1, 1.0), (2, 1e-20), (3, 1e15)] {
        let rays = grouped_rays(size);
        let (mut alone, mut together) = (vec![Hit::MISS; rays.len()], vec![Hit::MISS; rays.len()]);
        let tree = WideBvh::new(&scene(seed, 1000, size), &BuildOptions::default()).unwrap();
        let counters = &mut RayCounters::default();
        let set = |i: usize, hit| alone[i] = hit;
        tree.trace::<_, false, false>(kernels::scalar::Scalar, &rays, Vec::new(), set, counters);
        let set = &mut |i: usize, hit| together[i] = hit;
        let done = tree.trace_packets::<_, false, false>(kernels::scalar::Scalar, &rays, set, counters);
        let groups = done.iter().filter(|done| **done).count();
        assert!((200..580).contains(&groups), "{groups} of 600 groups ran as packets, size {size}");
        let mut hits = 0;
        for (i, (a, b)) in alone.iter().zip(&together).enumerate() {
            if done.get(i / PACKET) == Some(&true) {
                assert_eq!(a, b, "ray {i} of seed {seed}: {:?}", rays[i]);
                hits += usize::from(a.is_hit());
            }
        }
        assert!(hits > 500, "{hits}");
        for kernel in [Kernel::Scalar, Kernel::Avx2, Kernel::Avx512] {
            let tree = build(scene(seed, 1000, size), &BuildOptions { kernel, ..BuildOptions::default() }).unwrap();
            let (mut hits, mut counters) = (vec![Hit::MISS; rays.len()], RayCounters::default());
            tree.closest_hit_counted(&rays, &mut hits, &mut counters);
            assert_eq!(hits, alone, "{kernel:?}");
            let mut occluded = vec![false; rays.len()];
            tree.any_hit(&rays, &mut occluded);
            assert!(occluded.iter().zip(&alone).all(|(any, hit)| *any == hit.is_hit()), "{kernel:?}");
            assert_eq!(counters.traversal.rays, rays.len() as u64);
        }
    }
}

/// Bundles of 64 rays from a point, and what they look at: triangles of all sizes, slivers, some behind or around the point,
/// each seen by a bundle of its own from a place of its own, half of whose rays aim at its vertices and edges as exactly as
/// floats can.
fn looks(seed: u64, count: u32, apart: f32) -> (Arc<Primitives>, Vec<Ray>) {
    let (mut scene, mut rays) = (Primitives::default(), Vec::new());
    for look in 0..count {
        let mut s = Sampler::new(seed, StreamKind::Test, 2, look);
        let mut next = || s.next_1d();
        let mut vec3 = || Vec3::new(next(), next(), next()) * 2.0 - 1.0;
        let (dir, b, c, aside) = (vec3() + Vec3::splat(0.01), vec3(), vec3(), vec3());
        let place = Vec3::new((look % 10) as f32, (look / 10 % 10) as f32, (look / 100) as f32) * apart + vec3();
        let (u, v) = (next(), next());
        let (far, size) = (0.1 + 3.0 * u * u * u, (0.1 + 3.0 * u * u * u) * (v * v * v * v).max(1e-4));
        let c = if look % 3 == 0 { b * next() + c * 1e-4 } else { c };
        let middle = match look % 10 {
            0 => place - dir * size,
            1 => place - (b + c) * (0.3 * size),
            _ => place + dir * far,
        };
        let corners = [middle, middle + b * size, middle + c * size];
        let first = scene.positions.len() as u32;
        scene.positions.extend(corners);
        scene.triangles.push([first, first + 1, first + 2]);
        let spread = if look % 2 == 0 { 0.05 } else { size / far };
        for i in 0..4 * PACKET as u32 {
            let mut s = Sampler::new(seed, StreamKind::Test, 3, look * 64 + i);
            let mut next = || s.next_1d();
            let (corner, other, along) = ((next() * 3.0) as usize, (next() * 3.0) as usize, next());
            let to = match i % 4 {
                0 => corners[corner],
                1 => corners[corner] + (corners[other] - corners[corner]) * along,
                _ => middle + (Vec3::new(next(), next(), next()) * 2.0 - 1.0) * (spread * far),
            };
            rays.push(Ray::new(place, if look % 10 < 2 { dir + aside * (0.05 * along) } else { to - place }));
        }
    }
    (Arc::new(scene), rays)
}

#[test]
fn frustums_lose_no_hit() {
    for (seed, apart) in [(4, 10.0), (5, 100.0), (6, 3000.0)] {
        let (scene, rays) = looks(seed, 1000, apart);
        for kernel in [Kernel::Scalar, Kernel::Avx2, Kernel::Avx512] {
            let tree = WideBvh::new(&scene, &BuildOptions { kernel, ..BuildOptions::default() }).unwrap();
            let mut alone = vec![Hit::MISS; rays.len()];
            let counters = &mut RayCounters::default();
            let set = |i: usize, hit| alone[i] = hit;
            tree.trace::<_, false, false>(kernels::scalar::Scalar, &rays, Vec::new(), set, counters);
            let mut together = vec![Hit::MISS; rays.len()];
            for (rays, hits) in rays.chunks(4 * PACKET).zip(together.chunks_mut(4 * PACKET)) {
                tree.closest_hit(rays, hits);
            }
            for (i, (a, b)) in alone.iter().zip(&together).enumerate() {
                assert_eq!(a, b, "ray {i} of seed {seed}, {kernel:?}: {:?}", rays[i]);
            }
            let set = &mut |i: usize, hit| together[i] = hit;
            let done = tree.trace_packets::<_, false, false>(kernels::scalar::Scalar, &rays, set, counters);
            let hits = (0..rays.len()).filter(|i| done.get(i / PACKET) == Some(&true) && alone[*i].is_hit()).count();
            let packets = done.iter().filter(|done| **done).count();
            assert!(packets > 800 && hits > 5000, "{packets} {hits}");
        }
    }
}

/// Every order of three vertices.
const ORDERS: [[u32; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// Triangles, each once more in one of the six orders of its vertices, at a place of its own in the order of ids.
fn doubled_scene(seed: u64, count: u32) -> Arc<Primitives> {
    let once = scene(seed, count, 1.0);
    let mut out = Primitives { spheres: Vec::new(), ..Primitives::clone(&once) };
    for (i, t) in once.triangles.iter().enumerate() {
        out.positions.extend(t.map(|v| once.positions[v as usize]));
        let first = out.positions.len() as u32 - 3;
        out.triangles.push(ORDERS[i % 6].map(|v| first + v));
    }
    Arc::new(out)
}

#[test]
fn triangles_that_lie_on_others_are_hidden_until_they_move() {
    let count = 600;
    let mut moved = Primitives::clone(&doubled_scene(12, count));
    let doubled = Arc::new(moved.clone());
    for v in &mut moved.positions[3 * count as usize..] {
        *v += Vec3::splat(1e-3);
    }
    let moved = Arc::new(moved);
    let rays = [rays(3000, 1.0), grouped_rays(1.0)].concat();
    let find = |structure: &dyn Structure| {
        let mut hits = vec![Hit::MISS; rays.len()];
        structure.closest_hit(&rays, &mut hits);
        hits
    };
    let hidden = |tree: &WideBvh| {
        let lanes = |block: &TriangleBlock| (0..block.len()).filter(|l| block.vertices[0][*l].is_nan()).count();
        tree.blocks.iter().map(lanes).sum::<usize>()
    };
    for kernel in [vec![Kernel::Scalar], kernels()].concat() {
        let options = BuildOptions { kernel, ..BuildOptions::default() };
        let mut tree = WideBvh::new(&doubled, &options).unwrap();
        // Two orders of six have the first vertex in common.
        assert_eq!(hidden(&tree), count as usize / 3, "seed 12, {kernel:?}");
        for (primitives, hide) in [(&doubled, true), (&moved, false), (&doubled, true)] {
            tree.refit(primitives).unwrap();
            assert_eq!(hidden(&tree), if hide { count as usize / 3 } else { 0 }, "seed 12, {kernel:?}");
            let oracle = crate::build("brute-force", primitives.clone(), &options).unwrap();
            let (found, expected) = (find(&tree), find(&*oracle));
            assert!(expected.iter().filter(|hit| hit.is_hit()).count() > 500);
            assert_eq!(found, expected, "seed 12, {kernel:?}");
        }
    }
}
