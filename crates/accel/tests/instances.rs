//! Instances hit what their transformed triangles hit, within what floats can tell, and say which they are.

mod common;

use common::*;
use glam::{Affine3A, Quat};
use photinus_accel::instances::{InstanceError, InstanceHit, Instances, Placement, Prototype};
use photinus_accel::{BuildError, BuildOptions, RayCounters, build};
use photinus_geometry::{Hit, NO_HIT, Primitives, Ray, Vec3};
use std::sync::Arc;

fn prototype(primitives: &Primitives) -> Arc<Prototype> {
    Arc::new(Prototype::build("binned-bvh", Arc::new(primitives.clone()), &BuildOptions::default()).unwrap())
}

fn meshes() -> Vec<Primitives> {
    vec![random_soup(1, 200, Vec3::ZERO, 1.0, 0.3).primitives, random_soup(2, 50, Vec3::ONE, 0.5, 0.5).primitives]
}

/// Turned, scaled by different factors along the axes, some mirrored, and spread out.
fn placements(seed: u64, count: usize) -> Vec<Placement> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|i| {
            let turn = Quat::from_vec4(random.vec3().extend(random.unit()) + glam::Vec4::splat(1e-3)).normalize();
            let scale = (random.vec3().abs() + 0.3) * if i % 3 == 0 { Vec3::new(-1.0, 1.0, 1.0) } else { Vec3::ONE };
            let to_world = Affine3A::from_scale_rotation_translation(scale, turn, random.vec3() * 6.0);
            Placement { prototype: i % 2, to_world }
        })
        .collect()
}

fn instances(placements: &[Placement]) -> Instances {
    let prototypes = meshes().iter().map(prototype).collect();
    Instances::new(prototypes, placements, &BuildOptions::default()).unwrap()
}

fn closest(instances: &Instances, rays: &[Ray]) -> Vec<InstanceHit> {
    let mut hits = vec![InstanceHit::MISS; rays.len()];
    instances.closest_hit(rays, &mut hits);
    hits
}

/// All triangles in world space, with the instance and the triangle that each of them is.
fn flattened(placements: &[Placement]) -> (Primitives, Vec<(u32, u32)>) {
    let (meshes, mut names) = (meshes(), Vec::new());
    let mut triangles = Vec::new();
    for (i, p) in placements.iter().enumerate() {
        for id in 0..meshes[p.prototype].triangle_count() {
            triangles.push(meshes[p.prototype].triangle(id).map(|v| p.to_world.transform_point3(v)));
            names.push((i as u32, id as u32));
        }
    }
    (soup(triangles), names)
}

fn rays(seed: u64) -> Vec<Ray> {
    Scene::new("around", Primitives::default(), seed, Vec3::ZERO, 7.0).rays
}

/// Parameters agree to 2^-16 of themselves and of the scene's size; at most one ray in a hundred passes an edge on the
/// other side, or meets the other one of two triangles that are as near as floats can tell.
#[test]
fn instances_hit_what_their_transformed_triangles_hit() {
    let placements = placements(3, 60);
    let (flat, names) = flattened(&placements);
    let oracle = build("brute-force", Arc::new(flat), &BuildOptions::default()).unwrap();
    let instances = instances(&placements);
    let (mut hits, mut different, mut count) = (0, 0, 0);
    for seed in 0..8 {
        let rays = rays(seed);
        let mut expected = vec![Hit::MISS; rays.len()];
        oracle.closest_hit(&rays, &mut expected);
        let mut occluded = vec![false; rays.len()];
        instances.any_hit(&rays, &mut occluded);
        for (i, found) in closest(&instances, &rays).iter().enumerate() {
            count += 1;
            assert_eq!(occluded[i], found.hit.is_hit());
            let name = (expected[i].is_hit()).then(|| names[expected[i].prim as usize]);
            if (name, expected[i].is_hit()) != (Some((found.instance, found.hit.prim)), found.hit.is_hit()) {
                different += usize::from(found.hit.is_hit() || expected[i].is_hit());
                continue;
            }
            hits += 1;
            let tolerance = 1.5e-5 * (expected[i].t.abs() + 14.0 / rays[i].dir.length());
            assert!((found.hit.t - expected[i].t).abs() <= tolerance, "{found:?} {:?} {:?}", expected[i], rays[i]);
        }
    }
    assert!(hits > count / 6, "{hits} of {count}");
    assert!(different * 100 <= count, "{different} of {count}");
}

#[test]
fn in_place_prototypes_are_hit_bit_for_bit() {
    let scene = random_soup(4, 500, Vec3::ZERO, 1.0, 0.2);
    let place = [Placement { prototype: 0, to_world: Affine3A::IDENTITY }; 2];
    let twice = Instances::new(vec![prototype(&scene.primitives)], &place, &BuildOptions::default()).unwrap();
    let mut expected = vec![Hit::MISS; scene.rays.len()];
    build("brute-force", Arc::new(scene.primitives.clone()), &BuildOptions::default())
        .unwrap()
        .closest_hit(&scene.rays, &mut expected);
    for (found, expected) in closest(&twice, &scene.rays).iter().zip(&expected) {
        assert_eq!(found.hit, *expected);
        // Of two in the same place the lower is hit.
        assert_eq!(found.instance, if expected.is_hit() { 0 } else { NO_HIT });
    }
}

#[test]
fn moved_instances_are_hit_where_they_are() {
    let mut moving = instances(&placements(5, 40));
    let before = moving.summary();
    let there = placements(6, 40);
    moving.move_to(&there).unwrap();
    let anew = instances(&there);
    for seed in 0..4 {
        let rays = rays(10 + seed);
        assert_eq!(closest(&moving, &rays), closest(&anew, &rays));
    }
    // The old shape over places that have nothing to do with it.
    assert!(moving.summary().sah_cost > 1.2 * anew.summary().sah_cost);
    assert_eq!(moving.summary().nodes, before.nodes);
}

#[test]
fn what_cannot_be_placed_is_refused_and_changes_nothing() {
    let good = placements(7, 10);
    let mut placed = instances(&good);
    let rays = rays(7);
    let before = closest(&placed, &rays);
    let refused = |to_world: Affine3A| {
        let mut bad = good.clone();
        bad[3].to_world = to_world;
        let prototypes = meshes().iter().map(prototype).collect();
        (Instances::new(prototypes, &bad, &BuildOptions::default()).err(), bad)
    };
    for scale in [Vec3::new(1.0, 1.0, 0.0), Vec3::ZERO, Vec3::NAN, Vec3::new(1e-9, 1.0, 1.0)] {
        let (error, bad) = refused(Affine3A::from_scale(scale));
        assert_eq!(error, Some(InstanceError::Singular { placement: 3 }), "{scale}");
        assert_eq!(placed.move_to(&bad), Err(InstanceError::Singular { placement: 3 }));
    }
    assert_eq!(placed.move_to(&good[1..]), Err(InstanceError::OtherPlacements));
    let mut swapped = good.clone();
    swapped.swap(0, 1);
    assert_eq!(placed.move_to(&swapped), Err(InstanceError::OtherPlacements));
    assert_eq!(closest(&placed, &rays), before);
    let none = Placement { prototype: 2, to_world: Affine3A::IDENTITY };
    let error = Instances::new(vec![], &[none], &BuildOptions::default()).err();
    assert_eq!(error, Some(InstanceError::UnknownPrototype { placement: 0, prototype: 2, count: 0 }));
    let options = BuildOptions { bins: 1, ..BuildOptions::default() };
    let error = Instances::new(vec![], &[], &options).err();
    assert!(matches!(error, Some(InstanceError::Build(BuildError::BadOption { .. }))), "{error:?}");
}

#[test]
fn nothing_is_placed_and_hit_without_a_panic() {
    let empty = Instances::new(vec![], &[], &BuildOptions::default()).unwrap();
    let hollow = prototype(&Primitives::default());
    let place = [Placement { prototype: 0, to_world: Affine3A::IDENTITY }];
    let mut hollow = Instances::new(vec![hollow], &place, &BuildOptions::default()).unwrap();
    hollow.move_to(&place).unwrap();
    for nothing in [&empty, &hollow] {
        assert_eq!(closest(nothing, &[Ray::new(Vec3::ZERO, Vec3::X)]), [InstanceHit::MISS]);
        assert_eq!(nothing.summary().references, 0);
    }
    let hits = closest(&instances(&placements(8, 5)), &[Ray::new(Vec3::NAN, Vec3::X), Ray::new(Vec3::X, Vec3::ZERO)]);
    assert_eq!(hits, [InstanceHit::MISS; 2]);
}

#[test]
fn counting_changes_nothing() {
    let instances = instances(&placements(9, 30));
    let rays = rays(9);
    let mut counters = RayCounters::default();
    let mut hits = vec![InstanceHit::MISS; rays.len()];
    instances.closest_hit_counted(&rays, &mut hits, &mut counters);
    assert_eq!(hits, closest(&instances, &rays));
    assert!(counters.intersect.tests > 0 && counters.traversal.nodes_visited > rays.len() as u64 / 2);
}
