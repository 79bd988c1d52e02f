//! What structures promise beyond their answers: leaves that cover primitives, equal trees on any number of threads,
//! options that hold.

mod common;

use common::*;
use photinus_accel::{BuildError, BuildOptions, LeafRange, STRUCTURES, Structure, build};
use photinus_geometry::{Hit, Ray, Vec3};
use std::sync::Arc;

fn closest(structure: &dyn Structure, rays: &[Ray]) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    structure.closest_hit(rays, &mut hits);
    hits
}

fn built(name: &str, scene: &Scene, options: &BuildOptions) -> Box<dyn Structure> {
    build(name, Arc::new(scene.primitives.clone()), options).unwrap_or_else(|e| panic!("{}: {e}", scene.name))
}

/// Every point of a primitive lies in a leaf that holds it, whatever the structure divides.
#[test]
fn points_of_primitives_lie_in_leaves_that_hold_them() {
    let scene = with_spheres(random_soup(70, 700, Vec3::ZERO, 1.0, 0.4), 71, 20, 1.0);
    let mut random = Random::new(72);
    for info in STRUCTURES {
        let structure = built(info.name, &scene, &BuildOptions::default());
        let Some(refs) = structure.refs() else { continue };
        for id in 0..scene.primitives.len() {
            let place = match id.checked_sub(scene.primitives.triangle_count()) {
                None => {
                    let [a, b, c] = scene.primitives.triangle(id);
                    let (u, v) = (random.unit(), random.unit());
                    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                    a + (b - a) * u + (c - a) * v
                }
                Some(j) => {
                    let s = &scene.primitives.spheres[j];
                    s.center + random.vec3().normalize() * s.radius
                }
            };
            let leaves = structure.leaves(&Ray { t_max: 0.0, ..Ray::new(place, Vec3::Y) }).unwrap();
            let holds = |l: &LeafRange| refs[l.start as usize..(l.start + l.count) as usize].contains(&(id as u32));
            assert!(leaves.iter().any(holds), "{}: primitive {id} at {place}", info.name);
        }
    }
}

/// Structures and costs are the same whatever the number of threads.
#[test]
fn structures_do_not_depend_on_the_number_of_threads() {
    let scene = with_spheres(random_soup(75, 12_000, Vec3::ZERO, 1.0, 0.03), 76, 100, 1.0);
    for info in STRUCTURES {
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let structure = pool.install(|| built(info.name, &scene, &BuildOptions::default()));
            (structure.refs().map(<[u32]>::to_vec), structure.summary())
        };
        assert_eq!(run(1), run(3), "{}", info.name);
    }
}

#[test]
fn hierarchies_agree_whatever_their_options() {
    let scene = with_spheres(random_soup(77, 400, Vec3::ZERO, 1.0, 0.4), 78, 30, 1.0);
    let oracle = closest(&*built("brute-force", &scene, &BuildOptions::default()), &scene.rays);
    let default = BuildOptions::default();
    let all = [
        BuildOptions { leaf_size: Some(1), ..default.clone() },
        BuildOptions { leaf_size: Some(100), bins: 2, ..default.clone() },
        BuildOptions { node_cost: 0.0, bins: 64, reference_limit: Some(64.0), ..default.clone() },
        BuildOptions { node_cost: 50.0, split_alpha: 0.0, reference_limit: Some(1.0), ..default.clone() },
        BuildOptions { split_alpha: 0.0, reference_limit: Some(64.0), leaf_size: Some(2), ..default.clone() },
    ];
    for options in all {
        for info in STRUCTURES {
            let structure = built(info.name, &scene, &options);
            assert_eq!(closest(&*structure, &scene.rays), oracle, "{}: {options:?}", info.name);
            let limit = options.reference_limit.unwrap_or(32.0) * scene.primitives.len() as f64;
            let is_limited = ["spatial-split-bvh", "ellipsoid-bvh", "sphere-bvh", "box-bvh"].contains(&info.name);
            assert!(!is_limited || structure.summary().references as f64 <= limit, "{}: {options:?}", info.name);
        }
    }
}

#[test]
fn options_that_mean_nothing_are_refused() {
    let refused = |name: &str, options: BuildOptions| {
        let error = build(name, Arc::default(), &options).err();
        assert!(matches!(error, Some(BuildError::BadOption { .. })), "{name}: {options:?} gives {error:?}");
    };
    let default = BuildOptions::default;
    let by_cost = ["kd-tree", "binned-bvh", "spatial-split-bvh", "bkd-tree", "two-level"];
    let by_size = ["bih", "ellipsoid-bvh", "sphere-bvh", "box-bvh"];
    for name in by_cost.into_iter().chain(by_size) {
        refused(name, BuildOptions { node_cost: f64::NAN, ..default() });
        refused(name, BuildOptions { triangle_cost: 0.0, ..default() });
    }
    for name in by_cost[1..].iter().chain(&by_size) {
        refused(name, BuildOptions { leaf_size: Some(0), ..default() });
        refused(name, BuildOptions { bins: 65, ..default() });
    }
    for (alpha, limit) in [(-0.1, 4.0), (f64::NAN, 4.0), (0.5, 0.9), (0.5, f64::INFINITY)] {
        let options = BuildOptions { split_alpha: alpha, reference_limit: Some(limit), ..default() };
        refused("spatial-split-bvh", options);
    }
}
