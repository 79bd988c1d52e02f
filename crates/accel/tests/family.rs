//! Every structure of the list gives the hits of `brute-force`.

mod common;

use common::{Scene, random_soup, with_spheres};
use photinus_accel::{BuildOptions, STRUCTURES, Structure, build};
use photinus_geometry::{Hit, Vec3};
use std::sync::Arc;

fn scenes() -> Vec<Scene> {
    vec![
        random_soup(1, 0, Vec3::ZERO, 1.0, 0.1),
        random_soup(2, 1, Vec3::ZERO, 1.0, 0.5),
        random_soup(3, 3, Vec3::ZERO, 1.0, 0.5),
        random_soup(4, 1000, Vec3::ZERO, 1.0, 0.1),
        random_soup(5, 1000, Vec3::splat(1e6), 10.0, 0.2),
        random_soup(6, 1000, Vec3::ZERO, 1e-12, 0.1),
        random_soup(7, 1000, Vec3::ZERO, 1e12, 0.1),
        with_spheres(random_soup(8, 0, Vec3::ZERO, 1.0, 0.1), 9, 100, 1.0),
        with_spheres(random_soup(10, 500, Vec3::ZERO, 1.0, 0.1), 11, 50, 1.0),
    ]
}

fn closest(structure: &dyn Structure, scene: &Scene) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; scene.rays.len()];
    structure.closest_hit(&scene.rays, &mut hits);
    hits
}

#[test]
fn members_agree_with_brute_force_bit_for_bit() {
    let options = BuildOptions::default();
    for scene in scenes() {
        let primitives = Arc::new(scene.primitives.clone());
        let oracle = closest(&*build("brute-force", primitives.clone(), &options).unwrap(), &scene);
        let found = oracle.iter().filter(|h| h.is_hit()).count();
        assert!(scene.primitives.len() < 100 || found > 20, "{}: only {found} rays hit", scene.name);
        for info in STRUCTURES {
            let structure = build(info.name, primitives.clone(), &options).unwrap();
            let hits = closest(&*structure, &scene);
            for ((ray, hit), expected) in scene.rays.iter().zip(&hits).zip(&oracle) {
                assert_eq!(hit, expected, "{} in {}: {ray:?}", info.name, scene.name);
            }
            let mut occluded = vec![false; scene.rays.len()];
            structure.any_hit(&scene.rays, &mut occluded);
            for ((ray, any), expected) in scene.rays.iter().zip(&occluded).zip(&oracle) {
                assert_eq!(*any, expected.is_hit(), "{} in {}: {ray:?}", info.name, scene.name);
            }
        }
    }
}
