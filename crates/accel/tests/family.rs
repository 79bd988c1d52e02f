//! Every structure of the list gives the hits of `brute-force`, on friendly and on hostile input.

mod common;

use common::*;
use photinus_accel::structures::brute_force;
use photinus_accel::{
    BuildError, BuildOptions, Clip, DEFAULT_STRUCTURE, GridCells, RayCounters, STRUCTURES, SplitCandidates, Structure,
    build, find_structure,
};
use photinus_geometry::{Hit, Primitives, Ray, Sphere, Vec3};
use photinus_intersect::METHODS;
use photinus_intersect::methods::woop::Woop;
use std::sync::Arc;

fn scenes() -> Vec<Scene> {
    let mut scenes = vec![
        random_soup(4, 1000, Vec3::ZERO, 1.0, 0.1),
        random_soup(5, 1000, Vec3::splat(1e6), 10.0, 0.2),
        random_soup(6, 1000, Vec3::ZERO, 1e-12, 0.1),
        random_soup(7, 1000, Vec3::ZERO, 1e12, 0.1),
        with_spheres(random_soup(8, 0, Vec3::ZERO, 1.0, 0.1), 9, 100, 1.0),
        with_spheres(random_soup(10, 500, Vec3::ZERO, 1.0, 0.1), 11, 50, 1.0),
        slivers(12),
        coplanar_grids(13),
        coincident(14, 500),
        geometric_series(15),
        broken(16),
        mixed_sizes(17),
    ];
    scenes.extend((0..20).map(|n| random_soup(100 + n, n as usize, Vec3::ZERO, 1.0, 0.7)));
    scenes
}

fn closest(structure: &dyn Structure, rays: &[Ray]) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    structure.closest_hit(rays, &mut hits);
    hits
}

fn any(structure: &dyn Structure, rays: &[Ray]) -> Vec<bool> {
    let mut occluded = vec![false; rays.len()];
    structure.any_hit(rays, &mut occluded);
    occluded
}

fn built(name: &str, scene: &Scene, options: &BuildOptions) -> Box<dyn Structure> {
    build(name, Arc::new(scene.primitives.clone()), options).unwrap_or_else(|e| panic!("{}: {e}", scene.name))
}

#[test]
fn members_agree_with_brute_force_bit_for_bit() {
    let options = BuildOptions::default();
    for scene in scenes() {
        let oracle = closest(&*built("brute-force", &scene, &options), &scene.rays);
        let found = oracle.iter().filter(|h| h.is_hit()).count();
        assert!(scene.primitives.len() < 20 || found > 50, "{}: only {found} rays hit", scene.name);
        for info in STRUCTURES {
            let structure = built(info.name, &scene, &options);
            for (hit, (ray, expected)) in closest(&*structure, &scene.rays).iter().zip(scene.rays.iter().zip(&oracle)) {
                assert_eq!(hit, expected, "{} in {}: {ray:?}", info.name, scene.name);
            }
            for (hit, (ray, expected)) in any(&*structure, &scene.rays).iter().zip(scene.rays.iter().zip(&oracle)) {
                assert_eq!(*hit, expected.is_hit(), "{} in {}: {ray:?}", info.name, scene.name);
            }
        }
    }
}

/// In doubles the nearest triangle is the same, save where two are as near as floats can tell.
#[test]
fn brute_force_in_doubles_finds_the_same_triangles() {
    let scene = random_soup(60, 500, Vec3::ZERO, 1.0, 0.3);
    let single = closest(&*built("brute-force", &scene, &BuildOptions::default()), &scene.rays);
    let triangles = brute_force::prepare::<f64, Woop>(&scene.primitives);
    let mut hits = 0;
    for (ray, expected) in scene.rays.iter().zip(&single) {
        let found = brute_force::closest_triangle::<f64, Woop>(&triangles, ray);
        let Some((id, hit)) = found.filter(|_| expected.is_hit()) else {
            // Rays through vertices may hit in one arithmetic and not in the other.
            assert!(found.is_none() && !expected.is_hit() || ray.dir.to_array().contains(&0.0), "{ray:?}");
            continue;
        };
        hits += 1;
        let near = (hit.t as f32 - expected.t).abs() <= 1e-5 * (1.0 + expected.t.abs());
        assert!(id == expected.prim && near || ray.dir.to_array().contains(&0.0), "{ray:?}: {hit:?} {expected:?}");
    }
    assert!(hits > 200, "{hits}");
}

/// The other methods round differently from box tests, so that a hit within rounding of a box's face may be lost. Most
/// lose none here; Pluecker coordinates far from the origin of coordinates lose digits, and sums of angles take in points
/// outside of their triangles and so of the boxes.
#[test]
fn members_agree_with_brute_force_over_every_method() {
    for method in METHODS {
        let options = BuildOptions { method: method.name.into(), ..BuildOptions::default() };
        let (mut rays, mut different) = (0, 0);
        for seed in 0..4 {
            for scene in [
                random_soup(200 + seed, 1000, Vec3::ZERO, 1.0, 0.1),
                coplanar_grids(300 + seed),
                mixed_sizes(400 + seed),
                broken(500 + seed),
                slivers(600 + seed),
            ] {
                let oracle = closest(&*built("brute-force", &scene, &options), &scene.rays);
                for info in STRUCTURES.iter().filter(|info| info.name != "brute-force") {
                    let hits = closest(&*built(info.name, &scene, &options), &scene.rays);
                    rays += hits.len();
                    different += hits.iter().zip(&oracle).filter(|(a, b)| a != b).count();
                }
            }
        }
        let allowed = match method.name {
            "pluecker" => rays / 1000,
            "angle-summation" => rays / 5000,
            _ => 0,
        };
        assert!(different <= allowed, "{}: {different} of {rays} rays differ", method.name);
    }
}

/// Structures that divide space, under options that lie far from their defaults, give the oracle's hits everywhere.
#[test]
fn structures_that_divide_space_agree_whatever_their_options() {
    let base = BuildOptions::default;
    let exact = Clip::Exact;
    let variants: Vec<(&str, BuildOptions)> = vec![
        ("kd-tree", BuildOptions { clip: exact, ..base() }),
        ("kd-tree", BuildOptions { clip: exact, node_cost: 0.0, candidates: SplitCandidates::Bounds, ..base() }),
        ("kd-tree", BuildOptions { clip: exact, candidates: SplitCandidates::Uniform, candidate_count: 5, ..base() }),
        ("octree", BuildOptions { clip: exact, leaf_size: Some(1), tree_depth: 10, ..base() }),
        ("octree", BuildOptions { leaf_size: Some(30), ..base() }),
        ("octree", BuildOptions { tree_depth: 0, ..base() }),
        ("uniform-grid", BuildOptions { clip: exact, density: 60.0, ..base() }),
        ("uniform-grid", BuildOptions { density: 0.05, ..base() }),
        ("uniform-grid", BuildOptions { density: 1000.0, ..base() }),
        ("compact-grid", BuildOptions { clip: exact, density: 10.0, ..base() }),
        ("compact-grid", BuildOptions { grid_cells: GridCells::Hashed, density: 30.0, ..base() }),
        ("bsp-tree", BuildOptions { oblique_prims: 64, oblique_cost: 0.0, node_cost: 0.02, ..base() }),
        ("bsp-tree", BuildOptions { oblique_prims: 0, ..base() }),
        ("bsp-tree", BuildOptions { node_cost: 0.0, ..base() }),
    ];
    for scene in scenes() {
        let oracle = closest(&*built("brute-force", &scene, &base()), &scene.rays);
        for (name, options) in &variants {
            let structure = built(name, &scene, options);
            for (hit, (ray, expected)) in closest(&*structure, &scene.rays).iter().zip(scene.rays.iter().zip(&oracle)) {
                assert_eq!(hit, expected, "{name} with {options:?} in {}: {ray:?}", scene.name);
            }
            for (hit, (ray, expected)) in any(&*structure, &scene.rays).iter().zip(scene.rays.iter().zip(&oracle)) {
                assert_eq!(*hit, expected.is_hit(), "{name} with {options:?} in {}: {ray:?}", scene.name);
            }
        }
    }
}

/// Rays from far away: where one rounding of the way is as wide as cells are, hits are the same all the same.
#[test]
fn rays_from_afar_lose_no_hit() {
    let mut random = Random::new(71);
    for distance in [1e3f32, 1e5, 1e7] {
        let mut scene = random_soup(70, 800, Vec3::ZERO, 1.0, 0.2);
        scene.rays = (0..200)
            .map(|_| {
                let (from, to) = (random.vec3() * distance, random.vec3());
                Ray::new(from, (to - from).normalize())
            })
            .collect();
        let oracle = closest(&*built("brute-force", &scene, &BuildOptions::default()), &scene.rays);
        assert!(oracle.iter().filter(|h| h.is_hit()).count() > 50, "{distance}");
        for info in STRUCTURES {
            let hits = closest(&*built(info.name, &scene, &BuildOptions::default()), &scene.rays);
            assert_eq!(hits, oracle, "{} from {distance}", info.name);
        }
    }
}

/// The leaves of a ray, where a structure lists them, hold its hit, and each place is visited at most once.
#[test]
fn leaves_of_a_ray_hold_its_hit() {
    let scene = with_spheres(random_soup(80, 800, Vec3::ZERO, 1.0, 0.2), 81, 30, 1.0);
    for info in STRUCTURES {
        let structure = built(info.name, &scene, &BuildOptions::default());
        let Some(refs) = structure.refs() else { continue };
        let mut found = 0;
        for (ray, hit) in scene.rays.iter().zip(closest(&*structure, &scene.rays)) {
            let mut leaves = structure.leaves(ray).unwrap();
            let holds = leaves.iter().any(|l| refs[l.start as usize..(l.start + l.count) as usize].contains(&hit.prim));
            assert!(holds || !hit.is_hit(), "{}: {ray:?}", info.name);
            found += usize::from(hit.is_hit());
            let visits = leaves.len();
            leaves.sort_by_key(|l| l.start);
            leaves.dedup();
            assert_eq!(leaves.len(), visits, "{}: {ray:?}", info.name);
        }
        assert!(found > 100);
    }
}

#[test]
fn kd_trees_agree_whatever_their_options() {
    let scene = with_spheres(random_soup(20, 400, Vec3::ZERO, 1.0, 0.2), 21, 30, 1.0);
    let oracle = closest(&*built("brute-force", &scene, &BuildOptions::default()), &scene.rays);
    for (_, candidates) in SplitCandidates::ALL {
        for node_cost in [0.0, 0.05, 5.0, 500.0] {
            let options = BuildOptions { candidates, node_cost, candidate_count: 7, ..BuildOptions::default() };
            assert_eq!(closest(&*built("kd-tree", &scene, &options), &scene.rays), oracle, "{options:?}");
        }
    }
}

#[test]
fn rays_that_are_none_hit_nothing_and_end() {
    let nan = f32::NAN;
    let good = Ray::new(Vec3::new(0.0, 0.0, -3.0), Vec3::Z);
    let rays = [
        Ray { origin: Vec3::NAN, ..good },
        Ray { origin: Vec3::new(0.0, f32::INFINITY, 0.0), ..good },
        Ray { dir: Vec3::NAN, ..good },
        Ray { dir: Vec3::new(0.0, nan, 1.0), ..good },
        Ray { dir: Vec3::ZERO, ..good },
        Ray { dir: Vec3::INFINITY, ..good },
        Ray { t_min: nan, ..good },
        Ray { t_max: nan, ..good },
        Ray { t_min: 2.0, t_max: 1.0, ..good },
    ];
    for mut scene in [random_soup(30, 2000, Vec3::ZERO, 1.0, 0.5), coincident(31, 100), broken(32)] {
        scene.primitives.spheres.push(Sphere { center: Vec3::ZERO, radius: 0.5 });
        for info in STRUCTURES {
            let structure = built(info.name, &scene, &BuildOptions::default());
            assert!(closest(&*structure, &[good])[0].is_hit(), "{} in {}", info.name, scene.name);
            assert_eq!(closest(&*structure, &rays), [Hit::MISS; 9], "{} in {}", info.name, scene.name);
            assert_eq!(any(&*structure, &rays), [false; 9]);
        }
    }
}

#[test]
fn answers_do_not_depend_on_the_batch_and_counting_changes_nothing() {
    let scene = with_spheres(random_soup(40, 800, Vec3::ZERO, 1.0, 0.2), 41, 30, 1.0);
    for info in STRUCTURES {
        let structure = built(info.name, &scene, &BuildOptions::default());
        let whole = closest(&*structure, &scene.rays);
        let whole_any = any(&*structure, &scene.rays);
        let mut once = RayCounters::default();
        let mut counted = vec![Hit::MISS; scene.rays.len()];
        structure.closest_hit_counted(&scene.rays, &mut counted, &mut once);
        assert_eq!(counted, whole);
        for size in [1, 2, 15, 16, 17, 100] {
            let mut parts = RayCounters::default();
            for (i, rays) in scene.rays.chunks(size).enumerate() {
                assert_eq!(closest(&*structure, rays), whole[i * size..][..rays.len()], "{}", info.name);
                assert_eq!(any(&*structure, rays), whole_any[i * size..][..rays.len()], "{}", info.name);
                structure.closest_hit_counted(rays, &mut vec![Hit::MISS; rays.len()], &mut parts);
            }
            assert_eq!((parts.intersect, parts.traversal), (once.intersect, once.traversal), "{}", info.name);
            for ticks in [parts.ticks, once.ticks] {
                assert!(0 < ticks.tests && ticks.tests <= ticks.total && ticks.pairs > 0, "{}: {ticks:?}", info.name);
            }
        }
        structure.closest_hit(&[], &mut []);
        let t = once.traversal;
        assert_eq!(t.rays, scene.rays.len() as u64);
        assert_eq!(t.leaf_prims, once.intersect.tests);
        assert!(once.intersect.hits >= whole.iter().filter(|h| h.is_hit()).count() as u64);
        let mut any_work = RayCounters::default();
        structure.any_hit_counted(&scene.rays, &mut vec![false; scene.rays.len()], &mut any_work);
        assert!(any_work.intersect.tests < once.intersect.tests, "{}: any-hit stops no earlier", info.name);
    }
}

/// Rays from inside a closed box at its own vertices and edges, along the axes and across: none may leave.
#[test]
fn closed_meshes_have_no_leaks() {
    for (offset, size) in [(Vec3::ZERO, 1.0), (Vec3::splat(1e6), 64.0), (Vec3::new(-3.0, 1e5, 0.3), 7.0)] {
        const N: u32 = 8;
        let mut mesh = Primitives::default();
        for side in 0..6 {
            let base = mesh.positions.len() as u32;
            for j in 0..=N {
                for i in 0..=N {
                    let at = |k: u32| (k as f32 / N as f32 * 2.0 - 1.0) * size;
                    let mut p = [at(i), at(j), if side < 3 { -size } else { size }];
                    p.rotate_right(side as usize % 3);
                    mesh.positions.push(Vec3::from(p) + offset);
                }
            }
            for j in 0..N {
                for i in 0..N {
                    let a = base + (N + 1) * j + i;
                    mesh.triangles.extend([[a, a + 1, a + N + 2], [a, a + N + 2, a + N + 1]]);
                }
            }
        }
        let mut rays = Vec::new();
        for (i, p) in mesh.positions.iter().enumerate() {
            // The next vertex, mostly at the other end of an edge; after the last one of a side, some point inside.
            let next = mesh.positions[i / 81 * 81 + (i + 1) % 81];
            for target in [*p, (*p + next) * 0.5] {
                rays.push(Ray::new(offset, target - offset));
                for axis in Vec3::AXES {
                    // From the middle of the box along an axis through a vertex of the far side.
                    let start = target - axis * (target - offset).dot(axis);
                    rays.extend([Ray::new(start, axis), Ray::new(start, -axis * 0.3)]);
                }
            }
        }
        for info in STRUCTURES {
            let structure = build(info.name, Arc::new(mesh.clone()), &BuildOptions::default()).unwrap();
            for (ray, hit) in rays.iter().zip(closest(&*structure, &rays)) {
                assert!(hit.is_hit(), "{}: {ray:?} leaves the box at {offset}", info.name);
            }
        }
    }
}

#[test]
fn structures_without_primitives_are_summed_up_too() {
    for info in STRUCTURES {
        let empty = build(info.name, Arc::default(), &BuildOptions::default()).unwrap().summary();
        assert_eq!((empty.name, empty.references, empty.prims_per_leaf), (info.name, 0, 0.0));
        let scene = random_soup(50, 100, Vec3::ZERO, 1.0, 0.1);
        let summary = built(info.name, &scene, &BuildOptions::default()).summary();
        assert!(summary.references >= 100 && summary.leaves > 0 && summary.bytes > 0, "{summary:?}");
        assert!(summary.sah_cost.is_finite());
    }
}

#[test]
fn names_are_found_and_errors_say_what_there_is() {
    assert!(find_structure(DEFAULT_STRUCTURE).is_some());
    assert_eq!(find_structure("kd_tree").map(|s| s.name), Some("kd-tree"));
    let error = |name: &str, primitives: Primitives, options: BuildOptions| {
        build(name, Arc::new(primitives), &options).err().expect("refused").to_string()
    };
    let text = error("magic-tree", Primitives::default(), BuildOptions::default());
    let known: Vec<&str> = STRUCTURES.iter().map(|s| s.name).collect();
    assert_eq!(text, format!("no acceleration structure is called 'magic-tree'; there are {}", known.join(", ")));
    for info in STRUCTURES {
        let options = BuildOptions { method: "magic".into(), ..BuildOptions::default() };
        let text = error(info.name, Primitives::default(), options);
        assert!(text.contains("'magic'") && text.contains("woop, moller-trumbore, badouel, "), "{text}");
        let mut broken = soup([[Vec3::ZERO, Vec3::X, Vec3::Y]]);
        broken.triangles[0][1] = 3;
        let expected = BuildError::VertexOutOfRange { triangle: 0, vertex: 3, vertices: 3 };
        assert_eq!(error(info.name, broken, BuildOptions::default()), expected.to_string());
    }
}
