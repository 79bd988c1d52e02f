//! The real scenes of `PHOTINUS_SCENES`.

use crate::common::*;
use photinus_scene::{Geometry, LoadOptions, load};
use std::path::Path;

/// (file, triangles, spheres).
const SCENES: &[(&str, usize, usize)] = &[
    ("caustics/two-spheres/large-lamp.xml", 22, 2),
    ("caustics/two-spheres/small-lamp.xml", 22, 2),
    ("cornell/bitterli/mitsuba/scene_v3.xml", 36, 0),
    ("cornell/mitsuba-data/cbox.xml", 38, 0),
    ("cornell/mitsuba-data/cbox-rgb.xml", 38, 0),
    ("cornell/mitsuba-data/cbox-spectral.xml", 38, 0),
    ("rooms/living-room-mitsuba/scene.xml", 143_163, 0),
    ("atrium/sponza-mitsuba/sponza.xml", 66_445, 1),
];

fn check(root: &Path, file: &str, triangles: usize, spheres: usize, allow_outside: bool) -> photinus_scene::Scene {
    let options = LoadOptions { allow_outside, ..LoadOptions::default() };
    let scene = load(&root.join(file), &options).unwrap_or_else(|e| panic!("{e}"));
    let found = scene.shapes.iter().filter(|s| matches!(s.geometry, Geometry::Sphere { .. })).count();
    assert_eq!((scene.triangle_count(), found), (triangles, spheres), "{file}: {:#?}", warnings(&scene));
    assert!(scene.bounds().diagonal().is_finite());
    scene
}

#[test]
fn all_mitsuba_scenes_load() {
    let Some(root) = real_scenes() else { return };
    for &(file, triangles, spheres) in SCENES {
        let scene = check(&root, file, triangles, spheres, false);
        println!("{file}: {:#?}", warnings(&scene));
    }
}
