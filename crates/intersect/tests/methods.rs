//! What every ray-triangle method promises, checked on all of them against an independent oracle.

use photinus_geometry::{Hit, Primitives, Ray, Vec3};
use photinus_intersect::methods::woop::{Woop, finish, finish_lanes};
use photinus_intersect::methods::{badouel::Badouel, moller_trumbore::MollerTrumbore};
use photinus_intersect::{DEFAULT_METHOD, METHODS, MethodInfo, RtiMethod, TriangleHit, find_method};
use photinus_num::{Counted, OpCounts, Sampler, Scalar, StreamKind};
use std::cell::Cell;

type Vertices<S> = [[S; 3]; 3];

/// A call of one method over one scalar.
type Test<S> = fn([S; 3], [S; 3], Vertices<S>, S, S) -> Option<TriangleHit<S>>;

fn call<M: RtiMethod<S>, S: Scalar>(
    origin: [S; 3],
    dir: [S; 3],
    vertices: Vertices<S>,
    t_min: S,
    t_max: S,
) -> Option<TriangleHit<S>> {
    M::intersect(&M::start(origin, dir)?, &M::prepare(vertices), t_min, t_max)
}

/// Every method by name; a member of the list that is missing here fails `the_list_is_covered`.
fn all<S: Scalar>() -> [(&'static str, Test<S>); 3] {
    [("woop", call::<Woop, S>), ("moller-trumbore", call::<MollerTrumbore, S>), ("badouel", call::<Badouel, S>)]
}

const INF: f32 = f32::INFINITY;

#[test]
fn the_list_is_covered() {
    let names: Vec<_> = METHODS.iter().map(|m| m.name).collect();
    assert_eq!(names, all::<f32>().map(|m| m.0));
    assert!(find_method(DEFAULT_METHOD).is_some_and(|m| m.watertight));
    assert_eq!(find_method("moller_trumbore").map(|m| m.name), Some("moller-trumbore"));
    assert!(find_method("moller").is_none());
}

/// Seeded numbers in [-1, 1).
fn randoms<const N: usize>(seed: u64, index: u32) -> [f64; N] {
    let mut s = Sampler::new(seed, StreamKind::Test, 0, index);
    std::array::from_fn(|_| f64::from(s.next_1d()) * 2.0 - 1.0)
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn det(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Cramer's rule from determinants alone: t, alpha, beta, and the smallest weight of a vertex.
fn oracle(origin: [f64; 3], dir: [f64; 3], [a, b, c]: Vertices<f64>) -> ([f64; 3], f64) {
    let (e1, e2, s) = (sub(b, a), sub(c, a), sub(origin, a));
    let minus = dir.map(|x| -x);
    let whole = det(minus, e1, e2);
    let (t, alpha, beta) = (det(s, e1, e2) / whole, det(minus, s, e2) / whole, det(minus, e1, s) / whole);
    ([t, alpha, beta], alpha.min(beta).min(1.0 - alpha - beta))
}

#[test]
fn random_rays_agree_with_determinants_in_f64_and_f32() {
    let (mut hits, mut near_edges) = ([0; 2], 0);
    for i in 0..20_000 {
        let r = randoms::<15>(1, i).map(|x| f64::from(x as f32));
        let v = |k: usize| [r[k], r[k + 1], r[k + 2]];
        let (origin, dir, vertices) = (v(0), v(3), [v(6), v(9), v(12)]);
        let ([t, alpha, beta], least) = oracle(origin, dir, vertices);
        if least.abs() < 1e-4 || t.abs() < 1e-4 || t.abs() > 1e3 {
            near_edges += 1;
            continue;
        }
        let expected = least > 0.0 && t > 0.0;
        for (name, test) in all::<f64>() {
            let hit = test(origin, dir, vertices, 0.0, f64::INFINITY);
            assert_eq!(hit.is_some(), expected, "{name} on ray {i} of seed 1");
            if let Some(h) = hit {
                hits[0] += 1;
                let error = (h.t / t - 1.0).abs().max((h.alpha - alpha).abs()).max((h.beta - beta).abs());
                assert!(error < 1e-9, "{name} on ray {i}: {h:?} not {t} {alpha} {beta}");
            }
        }
        let single = |v: [f64; 3]| v.map(|x| x as f32);
        for (name, test) in all::<f32>() {
            let hit = test(single(origin), single(dir), vertices.map(single), 0.0, INF);
            assert_eq!(hit.is_some(), expected, "{name} in f32 on ray {i} of seed 1");
            if let Some(h) = hit {
                hits[1] += 1;
                let error = (f64::from(h.alpha) - alpha).abs().max((f64::from(h.beta) - beta).abs());
                assert!(error < 2e-3, "{name} in f32 on ray {i}: {h:?} not {t} {alpha} {beta}");
            }
        }
    }
    assert!(hits[0] > 1500 && hits[0] == hits[1] && near_edges < 1000, "{hits:?}, {near_edges}");
}

#[test]
fn the_operations_are_those_of_the_tables() {
    // Thesis, Table 11, prints 9 9 27 1 for Moller-Trumbore and 8 4 11 1 for Badouel; counted, Badouel's published
    // form has 9 additions and 14 multiplications with three hit coordinates and three reciprocals.
    let expected = [
        ("woop", OpCounts { add: 0, sub: 18, mul: 12, div: 0, sqrt: 0 }),
        ("moller-trumbore", OpCounts { add: 9, sub: 9, mul: 27, div: 1, sqrt: 0 }),
        ("badouel", OpCounts { add: 9, sub: 4, mul: 14, div: 1, sqrt: 0 }),
    ];
    let cell = Cell::new(OpCounts::default());
    let counted = |v: [f64; 3]| v.map(|x| Counted::new(x, &cell));
    let origin = counted([0.1, 0.2, -1.0]);
    let dir = counted([0.02, -0.03, 1.0]);
    let vertices = [[-1.0, -1.0, 0.1], [2.0, -1.0, -0.1], [-1.0, 2.0, 0.3]].map(counted);
    fn count<'a, M: RtiMethod<Counted<'a>>>(
        cell: &Cell<OpCounts>,
        origin: [Counted<'a>; 3],
        dir: [Counted<'a>; 3],
        vertices: Vertices<Counted<'a>>,
    ) -> OpCounts {
        let (ray, triangle) = (M::start(origin, dir).expect("a ray"), M::prepare(vertices));
        cell.set(OpCounts::default());
        let hit = M::intersect(&ray, &triangle, Counted::from_f64(0.0), Counted::from_f64(1e9));
        assert!(hit.is_some());
        cell.get()
    }
    let counts = [
        ("woop", count::<Woop>(&cell, origin, dir, vertices)),
        ("moller-trumbore", count::<MollerTrumbore>(&cell, origin, dir, vertices)),
        ("badouel", count::<Badouel>(&cell, origin, dir, vertices)),
    ];
    assert_eq!(counts, expected);
}

#[test]
fn edges_vertices_and_ends_of_the_interval_belong_to_the_hit() {
    // A right triangle in z = 0 and powers of two: everything here is exact in every method.
    let vertices = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for (x, y) in [(0.0f32, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5), (0.25, 0.25)] {
        for dz in [1.0f32, -1.0, 2.0] {
            for (name, test) in all::<f32>() {
                let origin = [x, y, -2.0 * dz];
                let hit = test(origin, [0.0, 0.0, dz], vertices, 0.0, INF).unwrap_or_else(|| panic!("{name} {x} {y}"));
                assert_eq!((hit.t, hit.alpha, hit.beta), (2.0, x, y), "{name}");
                for (t_min, t_max, expected) in
                    [(2.0, 3.0, true), (1.0, 2.0, true), (2.0, 2.0, true), (2.1, 3.0, false), (1.0, 1.9, false)]
                {
                    assert_eq!(test(origin, [0.0, 0.0, dz], vertices, t_min, t_max).is_some(), expected, "{name}");
                }
            }
        }
    }
}

#[test]
fn degenerate_triangles_and_impossible_rays_never_hit() {
    let nan = f32::NAN;
    let degenerate: [Vertices<f32>; 6] = [
        [[0.0; 3]; 3],
        [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0]],
        [[-1.0, -1.0, 1.0], [0.0, 0.0, 1.0], [2.0, 2.0, 1.0]],
        [[nan, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]],
        [[-INF, -1.0, 1.0], [1.0, -1.0, 1.0], [0.0, 1.0, 1.0]],
        [[-3e38, -3e38, 1.0], [3e38, 3e38, 1.0], [0.0, 0.0, 1.0]],
    ];
    let good: Vertices<f32> = [[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [0.0, 1.0, 1.0]];
    for (name, test) in all::<f32>() {
        for vertices in degenerate {
            for dir in [[0.0, 0.0, 1.0], [0.1, 0.1, 1.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]] {
                assert_eq!(test([0.0; 3], dir, vertices, 0.0, INF), None, "{name} {vertices:?}");
            }
        }
        assert!(test([0.0; 3], [0.0, 0.0, 1.0], good, 0.0, INF).is_some(), "{name}");
        for (origin, dir) in [
            ([0.0; 3], [0.0; 3]),
            ([nan, 0.0, 0.0], [0.0, 0.0, 1.0]),
            ([0.0; 3], [0.0, nan, 1.0]),
            ([0.0; 3], [0.0, 0.0, INF]),
            ([0.0, 0.0, -INF], [0.0, 0.0, 1.0]),
        ] {
            assert_eq!(test(origin, dir, good, 0.0, INF), None, "{name} {origin:?} {dir:?}");
        }
        assert_eq!(test([0.0; 3], [0.0, 0.0, 1.0], good, nan, INF), None);
        assert_eq!(test([0.0; 3], [0.0, 0.0, 1.0], good, 0.0, nan), None);
        // In the plane of the triangle.
        assert_eq!(test([-5.0, 0.0, 1.0], [1.0, 0.0, 0.0], good, 0.0, INF), None, "{name}");
    }
}

/// The published Badouel changes branches where u1 is exactly zero; a tiny u1 then ruins alpha.
#[test]
fn badouel_pivots() {
    let vertices = [[0.0f32, 0.0, 0.0], [1e-7, 1.0, 0.0], [-1.0, 0.5, 0.0]];
    let hit = call::<Badouel, f32>([-0.5, 0.5, -1.0], [0.0, 0.0, 1.0], vertices, 0.0, INF).expect("inside");
    assert!((hit.alpha - 0.25).abs() < 1e-6 && (hit.beta - 0.5).abs() < 1e-6, "{hit:?}");
}

#[test]
fn woop_works_at_every_scale() {
    for exponent in -40..=37 {
        let size = 10f64.powi(exponent);
        let v = |p: [f64; 3]| p.map(|x| (x * size) as f32);
        let vertices = [v([-1.0, -1.0, 1.0]), v([1.5, -1.0, 1.25]), v([0.0, 1.0, 0.75])];
        for scale in [1.0f32, 1e-3, 1e6] {
            let dir = [0.01 * scale, -0.02 * scale, scale];
            let hit = call::<Woop, f32>([0.0; 3], dir, vertices, 0.0, INF);
            let expected = oracle([0.0; 3], dir.map(f64::from), vertices.map(|v| v.map(f64::from))).0;
            if expected[0] > 3e38 {
                continue;
            }
            let hit = hit.unwrap_or_else(|| panic!("size {size}, scale {scale}"));
            assert!((f64::from(hit.alpha) - expected[1]).abs() < 1e-5, "{size} {scale}: {hit:?} {expected:?}");
            // What is below the normal numbers has fewer digits.
            let rounding = 1e-5 * expected[0] + 1e-44;
            assert!((f64::from(hit.t) - expected[0]).abs() < rounding, "{size} {scale}: {hit:?} {expected:?}");
        }
    }
}

/// A closed surface around its middle: a subdivided octahedron, bumpy, so that edges run in all directions.
fn closed_mesh(offset: Vec3, size: f32) -> Primitives {
    const N: usize = 12;
    let mut out = Primitives::default();
    for face in 0..8 {
        let corner = |axis: usize| Vec3::AXES[axis] * if face >> axis & 1 == 1 { -1.0 } else { 1.0 };
        let base = out.positions.len() as u32;
        let place = |i: usize, j: usize| base + (i * (i + 1) / 2 + j) as u32;
        for i in 0..=N {
            for j in 0..=i {
                // Of the octahedron's face: exact multiples, so that faces agree about their borders.
                let (a, b, c) = ((N - i) as f32, (i - j) as f32, j as f32);
                let p = (corner(0) * a + corner(1) * b + corner(2) * c) / N as f32;
                let bumps = 1.0 + 0.3 * (p.x * p.y + p.z * p.z * p.y);
                out.positions.push(p * bumps * size + offset);
            }
        }
        for i in 0..N {
            for j in 0..=i {
                out.triangles.push([place(i, j), place(i + 1, j), place(i + 1, j + 1)]);
                if j < i {
                    out.triangles.push([place(i, j), place(i + 1, j + 1), place(i, j + 1)]);
                }
            }
        }
    }
    out
}

/// Rays from inside a closed mesh at its vertices and edges; how many hit nothing.
fn leaks(method: &MethodInfo, offset: Vec3, size: f32) -> usize {
    let mesh = closed_mesh(offset, size);
    let tester = (method.leaf_tester)(&mesh);
    let ids: Vec<u32> = (0..mesh.triangle_count() as u32).collect();
    let mut targets = mesh.positions.clone();
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
        targets.extend([(a + b) * 0.5, (b + c) * 0.5, a + (c - a) * 0.3]);
    }
    targets.extend(Vec3::AXES.iter().flat_map(|axis| [offset + axis, offset - axis]));
    let leaks = targets.iter().enumerate().filter(|(i, target)| {
        let [x, y, z] = randoms::<3>(3, *i as u32).map(|x| x as f32);
        let inside = offset + Vec3::new(x, y, z) * size * if i % 2 == 0 { 0.0 } else { 0.2 };
        let mut hit = Hit::MISS;
        tester.closest_hit(&Ray::new(inside, *target - inside), &ids, &mut hit);
        !hit.is_hit()
    });
    leaks.count()
}

#[test]
fn no_ray_leaves_a_closed_mesh_through_a_watertight_method() {
    let mut others = 0;
    for method in METHODS {
        for (offset, size) in [(Vec3::ZERO, 1.0), (Vec3::splat(1e6), 100.0), (Vec3::new(0.1, 2e3, -7.7), 3e-1)] {
            let leaks = leaks(method, offset, size);
            assert!(!method.watertight || leaks == 0, "{}: {leaks} rays leak at {offset}", method.name);
            others += leaks;
        }
    }
    assert!(others > 0, "these rays find no seam in any method, so they prove nothing");
}

/// Slivers: t stays on the triangle and the weights stay weights.
#[test]
fn woop_gives_weights_on_slivers() {
    let mut hits = 0;
    for i in 0..20_000 {
        let [x, y, z, w, u, v] = randoms::<6>(4, i).map(|x| x as f32);
        let a = [x, y, 2.0 + z];
        let along = [u, v, 3.0 * w];
        let b: [f32; 3] = std::array::from_fn(|k| a[k] + along[k]);
        let c: [f32; 3] = std::array::from_fn(|k| a[k] + 0.5 * along[k] + [1e-6, -1e-6, 2e-7][k]);
        let aim: [f32; 3] = std::array::from_fn(|k| a[k] + 0.4 * along[k]);
        if let Some(h) = call::<Woop, f32>([0.0; 3], aim, [a, b, c], 0.0, INF) {
            hits += 1;
            let (low, high) = ((a[2].min(b[2]).min(c[2])) / aim[2], (a[2].max(b[2]).max(c[2])) / aim[2]);
            let (low, high) = (low.min(high), low.max(high));
            let slack = 1e-5 * (1.0 + high.abs());
            assert!(h.alpha >= 0.0 && h.beta >= 0.0 && h.alpha + h.beta <= 1.0 + 1e-6, "{h:?}");
            let dominant = aim[2].abs() >= aim[0].abs().max(aim[1].abs());
            assert!(!dominant || (h.t >= low - slack && h.t <= high + slack), "{h:?} outside {low} to {high}");
        }
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn woop_finishes_lanes_as_it_finishes_one() {
    // Few different values: half of the triangles have edges through the ray, corners that coincide or no area.
    let values = [-2.0, -1.0, -0.0, 0.0, 0.5, 1.0, 3.0, 1e-200, 1e300, f64::INFINITY, f64::NAN];
    let (mut hits, mut misses) = (0, 0);
    for i in 0..40_000 {
        let mut sampler = Sampler::new(8, StreamKind::Test, 0, i);
        let common = if i % 2 == 0 { 7 } else { values.len() };
        let mut draw = || values[(sampler.next_1d() * common as f32) as usize];
        let sheared: [[[f64; 4]; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| [0; 4].map(|_| draw())));
        let dir_z = [0; 4].map(|_| draw());
        let found = finish_lanes(&sheared, &dir_z);
        for lane in 0..4 {
            match finish(&sheared.map(|v| v.map(|axis| axis[lane])), dir_z[lane]) {
                Some(hit) => {
                    let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
                    assert!(same(hit.t, found.t[lane]) && same(hit.alpha, found.alpha[lane]), "{sheared:?} {dir_z:?}");
                    assert!(same(hit.beta, found.beta[lane]));
                    hits += 1;
                }
                None => {
                    assert!(found.t[lane].is_nan(), "{sheared:?} {dir_z:?}");
                    misses += 1;
                }
            }
        }
    }
    assert!(hits > 10_000 && misses > 10_000, "{hits} {misses}");
}

#[test]
fn ties_go_to_the_lowest_id_and_the_interval_is_kept() {
    let positions = vec![Vec3::new(-1.0, -1.0, 1.0), Vec3::new(1.0, -1.0, 1.0), Vec3::new(0.0, 1.0, 1.0)];
    let primitives = Primitives { positions, triangles: vec![[0, 1, 2]; 4], spheres: Vec::new() };
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    for method in METHODS {
        let tester = (method.leaf_tester)(&primitives);
        for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1]] {
            let mut best = Hit::MISS;
            let work = tester.closest_hit(&ray, &order, &mut best);
            assert_eq!((best.t, best.prim, work.tests), (1.0, 0, 4), "{}", method.name);
        }
        let mut best = Hit::MISS;
        tester.closest_hit(&Ray { t_max: 0.5, ..ray }, &[0, 1], &mut best);
        assert!(!best.is_hit());
        let (any, work) = tester.any_hit(&ray, &[2, 1]);
        assert!(any && work.tests == 1 && work.hits == 1);
    }
}
