//! What every ray-triangle method promises, checked on all of them against an independent oracle.

mod common;

use common::*;
use photinus_geometry::{Hit, Primitives, Ray, Vec3};
use photinus_intersect::doubles::Lanes;
use photinus_intersect::methods::angle_summation::tolerance;
use photinus_intersect::methods::woop::{Woop, finish, finish_lanes};
use photinus_intersect::{DEFAULT_METHOD, METHODS, MethodInfo, TriangleHit, find_method, is_degenerate};
use photinus_num::{Sampler, Scalar, StreamKind};

#[test]
fn the_list_is_covered() {
    let names: Vec<_> = METHODS.iter().map(|m| m.name).collect();
    assert_eq!(names, all::<f32>().map(|m| m.0));
    assert!(find_method(DEFAULT_METHOD).is_some_and(|m| m.watertight));
    assert_eq!(find_method("moller_trumbore").map(|m| m.name), Some("moller-trumbore"));
    assert!(find_method("moller").is_none());
}

#[test]
fn random_rays_agree_with_determinants_in_f64_and_f32() {
    let (mut hits, mut near_edges, mut within_tolerance) = ([0; 2], 0, 0);
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
            // Sums of angles are compared with a tolerance, which takes more of a thin triangle's surroundings.
            let point = std::array::from_fn(|k| origin[k] + t * dir[k]);
            if name == "angle-summation" && !expected && turn_lacks(point, vertices) < 2.0 * tolerance::<f32>() {
                within_tolerance += 1;
                continue;
            }
            let hit = test(single(origin), single(dir), vertices.map(single), 0.0, INF);
            assert_eq!(hit.is_some(), expected, "{name} in f32 on ray {i} of seed 1");
            if let Some(h) = hit {
                hits[1] += 1;
                let error = (f64::from(h.alpha) - alpha).abs().max((f64::from(h.beta) - beta).abs());
                assert!(error < 2e-3, "{name} in f32 on ray {i}: {h:?} not {t} {alpha} {beta}");
            }
        }
    }
    assert!(hits[0] > 6000 && hits[0] == hits[1] && near_edges < 1000, "{hits:?}, {near_edges}");
    assert!(within_tolerance < 1000, "{within_tolerance}");
}

/// How much the angles under which `point` sees the edges lack of a full turn.
fn turn_lacks(point: [f64; 3], vertices: Vertices<f64>) -> f64 {
    let [a, b, c] = vertices.map(|v| unit(sub(v, point)));
    let angle = |a: [f64; 3], b: [f64; 3]| libm::acos((0..3).map(|k| a[k] * b[k]).sum::<f64>().clamp(-1.0, 1.0));
    std::f64::consts::TAU - angle(a, b) - angle(b, c) - angle(c, a)
}

/// The vector of length one.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// A right triangle in powers of two, in each plane of the axes and in a slanted one: everything is exact in every method.
#[test]
fn edges_vertices_and_ends_of_the_interval_belong_to_the_hit() {
    exact_borders::<f32>();
    exact_borders::<f64>();
}

fn exact_borders<S: Scalar>() {
    let s = S::from_f64;
    let on_border = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5), (0.25, 0.75), (0.25, 0.0)];
    let outside = [(-0.25, 0.0), (1.25, 0.0), (0.0, -0.25), (0.0, 1.25), (0.75, 0.5), (1.5, -0.5), (-0.5, 1.5)];
    for turn in 0..6 {
        // The plane z = 0 with axes in all orders: half of them turn the triangle's face.
        let place = |p: [f64; 3]| {
            let mut p = if turn < 3 { p } else { [p[1], p[0], p[2]] };
            p.rotate_right(turn % 3);
            p.map(s)
        };
        for slant in [0.0, 1.0] {
            let vertices = [place([0.0, 0.0, 0.0]), place([1.0, 0.0, slant]), place([0.0, 1.0, 0.0])];
            for (i, (x, y)) in on_border.into_iter().chain([(0.25, 0.25)]).chain(outside).enumerate() {
                for dz in [1.0, -1.0, 2.0] {
                    let origin = place([x, y, slant * x - 2.0 * dz]);
                    for (name, test) in all::<S>() {
                        let closed = find_method(name).is_some_and(|m| m.closed);
                        let expected = i <= on_border.len() && (closed || x + y < 1.0);
                        let what = format!("{name} at {x} {y}, turn {turn}, slant {slant}");
                        let hit = test(origin, place([0.0, 0.0, dz]), vertices, s(0.0), s(1e9));
                        assert_eq!(hit.is_some(), expected, "{what}");
                        let Some(hit) = hit else { continue };
                        assert_eq!([hit.t, hit.alpha, hit.beta].map(S::to_f64), [2.0, x, y], "{what}");
                        for (t_min, t_max, expected) in
                            [(2.0, 3.0, true), (1.0, 2.0, true), (2.0, 2.0, true), (2.1, 3.0, false), (1.0, 1.9, false)]
                        {
                            let hit = test(origin, place([0.0, 0.0, dz]), vertices, s(t_min), s(t_max));
                            assert_eq!(hit.is_some(), expected, "{what}");
                        }
                    }
                }
            }
        }
    }
}

/// Numbers that hardly anything survives: no panic, and a hit is one within the interval, of a triangle that is none of
/// the broken ones.
#[test]
fn hostile_numbers_are_survived() {
    hostile::<f32>(&[0.0, -0.0, 1.0, -1.0, 0.5, 3.0, 1e-45, 1e-38, -1e-20, 1e19, 3e38, -3e38, f64::INFINITY, f64::NAN]);
    hostile::<f64>(&[
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        3.0,
        5e-324,
        1e-308,
        -1e-160,
        1e154,
        1e308,
        f64::NEG_INFINITY,
        f64::NAN,
    ]);
}

fn hostile<S: Scalar>(values: &[f64]) {
    let mut hits = 0;
    for i in 0..60_000 {
        let mut sampler = Sampler::new(9, StreamKind::Test, 0, i);
        // Two rays in three with friendly values only, so that some hit.
        let common = if i % 3 == 0 { values.len() } else { 6 };
        let mut draw = || S::from_f64(values[(sampler.next_1d() * common as f32) as usize]);
        let mut vec3 = || [draw(), draw(), draw()];
        let (origin, dir, vertices) = (vec3(), vec3(), [vec3(), vec3(), vec3()]);
        let [t_min, t_max, _] = vec3();
        for (t_min, t_max) in [(S::zero(), S::from_f64(f64::INFINITY)), (t_min, t_max)] {
            for (name, test) in all::<S>() {
                let Some(hit) = test(origin, dir, vertices, t_min, t_max) else { continue };
                let what = format!("{name} on ray {i} of seed 9: {origin:?} {dir:?} {vertices:?}: {hit:?}");
                assert!(hit.t >= t_min && hit.t <= t_max && hit.t.is_finite(), "{what}");
                assert!(hit.alpha.is_finite() && hit.beta.is_finite(), "{what}");
                assert!(!is_degenerate(&vertices), "{what}");
                hits += 1;
            }
        }
    }
    assert!(hits > 1000, "{hits}");
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

/// Where edges and vertices are met exactly a closed method loses no ray; the half-open one does, at edges that both
/// neighbours leave out.
#[test]
fn exact_seams_are_closed() {
    let mesh = exact_box(12);
    let rays = exact_rays(&mesh);
    let ids: Vec<u32> = (0..mesh.triangle_count() as u32).collect();
    for method in METHODS {
        let tester = (method.leaf_tester)(&mesh);
        let lost = rays.iter().filter(|ray| {
            let mut hit = Hit::MISS;
            tester.closest_hit(ray, &ids, &mut hit);
            !hit.is_hit()
        });
        let lost = lost.count();
        assert_eq!(lost == 0, method.closed, "{}: {lost} of {} rays", method.name, rays.len());
    }
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
        let found = finish_lanes(&sheared.map(|v| v.map(Lanes)), Lanes(dir_z));
        for lane in 0..4 {
            match finish(&sheared.map(|v| v.map(|axis| axis[lane])), dir_z[lane]) {
                Some(hit) => {
                    let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
                    assert!(
                        same(hit.t, found.t.0[lane]) && same(hit.alpha, found.alpha.0[lane]),
                        "{sheared:?} {dir_z:?}"
                    );
                    assert!(same(hit.beta, found.beta.0[lane]) && found.hits >> lane & 1 == 1);
                    hits += 1;
                }
                None => {
                    assert!(found.hits >> lane & 1 == 0, "{sheared:?} {dir_z:?}");
                    misses += 1;
                }
            }
        }
    }
    assert!(hits > 10_000 && misses > 10_000, "{hits} {misses}");
}

#[test]
fn woop_is_the_same_to_the_bit_where_the_other_vertices_change_places() {
    let mut hits = 0;
    for i in 0..40_000 {
        let r = randoms::<12>(21, i).map(|x| x as f32);
        let v = |k: usize| [r[k], r[k + 1], r[k + 2]];
        let (a, b, c) = (v(0), v(3), v(6));
        let aim: [f32; 3] = std::array::from_fn(|k| (a[k] + r[9].abs() * b[k] + r[10].abs() * c[k]) / 2.0);
        let one = call::<Woop, f32>([r[11]; 3], aim, [a, b, c], 0.0, INF);
        let other = call::<Woop, f32>([r[11]; 3], aim, [a, c, b], 0.0, INF);
        let bits = |h: Option<TriangleHit<f32>>| h.map(|h| [h.t, h.alpha, h.beta].map(f32::to_bits));
        let turned = other.map(|h| TriangleHit { alpha: h.beta, beta: h.alpha, ..h });
        assert_eq!(bits(one), bits(turned), "triangle {i} of seed 21");
        hits += u32::from(one.is_some());
    }
    assert!(hits > 5000, "{hits}");
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
