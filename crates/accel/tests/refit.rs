//! Structures that can be fitted to moved primitives hit them as `brute-force` does; the others say that they cannot.

mod common;

use common::*;
use photinus_accel::{BuildOptions, RefitError, STRUCTURES, Structure, build};
use photinus_geometry::{Hit, Primitives, Ray, Vec3};
use std::sync::Arc;

/// Members that can be fitted.
const FITTED: &[&str] = &[
    "wide-bvh",
    "binned-bvh",
    "spatial-split-bvh",
    "bkd-tree",
    "bih",
    "ellipsoid-bvh",
    "sphere-bvh",
    "box-bvh",
    "two-level",
];

fn built(name: &str, primitives: &Primitives) -> Box<dyn Structure> {
    build(name, Arc::new(primitives.clone()), &BuildOptions::default()).unwrap()
}

fn closest(structure: &dyn Structure, rays: &[Ray]) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    structure.closest_hit(rays, &mut hits);
    hits
}

/// Every vertex and every sphere swings aside by up to `reach`, differently at every height.
fn swung(primitives: &Primitives, reach: f32) -> Primitives {
    let swing = |p: Vec3| p + Vec3::new(libm::sinf(4.0 * p.y), 0.0, libm::cosf(5.0 * p.y)) * reach;
    let mut out = primitives.clone();
    out.positions.iter_mut().for_each(|p| *p = swing(*p));
    out.spheres.iter_mut().for_each(|s| s.center = swing(s.center));
    out
}

#[test]
fn fitted_structures_hit_what_moved() {
    let scenes = [
        with_spheres(random_soup(1, 800, Vec3::ZERO, 1.0, 0.2), 2, 40, 1.0),
        coplanar_grids(3),
        mixed_sizes(4),
        random_soup(5, 1, Vec3::ZERO, 1.0, 0.5),
        random_soup(6, 0, Vec3::ZERO, 1.0, 0.5),
    ];
    for scene in scenes {
        for info in STRUCTURES {
            let mut structure = built(info.name, &scene.primitives);
            let mut now = scene.primitives.clone();
            for reach in [0.05, 0.7] {
                now = swung(&now, reach);
                let outcome = structure.refit(&now);
                if !FITTED.contains(&info.name) {
                    assert_eq!(outcome, Err(RefitError::Unsupported { structure: info.name }));
                    now = scene.primitives.clone();
                }
                let expected = closest(&*built("brute-force", &now), &scene.rays);
                assert_eq!(closest(&*structure, &scene.rays), expected, "{} in {}", info.name, scene.name);
            }
        }
    }
}

#[test]
fn what_is_not_moved_costs_what_it_did_and_what_is_costs_more() {
    let scene = random_soup(7, 3000, Vec3::ZERO, 1.0, 0.05);
    for name in FITTED {
        let mut structure = built(name, &scene.primitives);
        let before = structure.summary();
        structure.refit(&scene.primitives).unwrap();
        let same = structure.summary();
        // Parts of triangles in voxels become whole ones.
        let is_divided = before.references > 3000;
        assert!(is_divided || same == before, "{name}: {same:?} {before:?}");
        structure.refit(&swung(&scene.primitives, 0.8)).unwrap();
        let after = structure.summary();
        assert!(after.sah_cost > before.sah_cost, "{name}: {} {}", after.sah_cost, before.sah_cost);
        assert_eq!((after.nodes, after.leaves, after.bytes), (before.nodes, before.leaves, before.bytes));
    }
}

#[test]
fn other_primitives_are_refused_and_change_nothing() {
    let scene = with_spheres(random_soup(8, 200, Vec3::ZERO, 1.0, 0.3), 9, 10, 1.0);
    let with = |change: fn(&mut Primitives)| {
        let mut out = scene.primitives.clone();
        change(&mut out);
        out
    };
    let others = [
        with(|p| p.triangles.truncate(100)),
        with(|p| p.triangles.push([0, 1, 2])),
        with(|p| p.spheres.truncate(9)),
        with(|p| p.triangles[7].swap(0, 1)),
        with(|p| p.positions.truncate(100)),
    ];
    for name in FITTED {
        let mut structure = built(name, &scene.primitives);
        let before = closest(&*structure, &scene.rays);
        for other in &others {
            assert_eq!(structure.refit(other), Err(RefitError::OtherPrimitives { structure: name }), "{name}");
        }
        assert_eq!(closest(&*structure, &scene.rays), before, "{name}");
    }
}

/// A triangle that vanishes is fitted; one that no ray could hit, and that no leaf holds, cannot come back.
#[test]
fn primitives_may_vanish_but_not_appear() {
    let mut scene = random_soup(10, 300, Vec3::ZERO, 1.0, 0.4);
    let whole = scene.primitives.clone();
    for (i, bad) in [f32::NAN, f32::INFINITY, 0.0].into_iter().enumerate() {
        scene.primitives.positions[30 * i] = Vec3::splat(bad);
        scene.primitives.positions[30 * i + 1] = Vec3::splat(bad);
    }
    for name in FITTED {
        let mut structure = built(name, &whole);
        structure.refit(&scene.primitives).unwrap();
        let expected = closest(&*built("brute-force", &scene.primitives), &scene.rays);
        assert_eq!(closest(&*structure, &scene.rays), expected, "{name}");
        structure.refit(&whole).unwrap();
        assert_eq!(closest(&*structure, &scene.rays), closest(&*built("brute-force", &whole), &scene.rays), "{name}");
        let mut hollow = built(name, &scene.primitives);
        assert_eq!(hollow.refit(&whole), Err(RefitError::OtherPrimitives { structure: name }));
    }
}
