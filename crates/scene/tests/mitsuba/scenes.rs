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

/// Scenes that read files outside their folder.
const OUTSIDE: &[(&str, usize, usize)] = &[
    ("mitsuba-tests/tests/scenes/floating_sphere/test_directional_direct.xml", 32_514, 0),
    ("mitsuba-tests/tests/scenes/infinite_mirrors/scene_path.xml", 97_536, 0),
    ("mitsuba-tests/tests/scenes/instancing/test_instancing_path.xml", 97_542, 3),
    ("mitsuba-tests/tests/scenes/texture_interp/test_texture_interp_direct.xml", 12, 0),
];

#[test]
fn scenes_that_reach_outside_need_permission() {
    let Some(root) = real_scenes() else { return };
    for &(file, triangles, spheres) in OUTSIDE {
        let refused = load(&root.join(file), &LoadOptions::default()).unwrap_err();
        assert!(one_line(&refused).contains("--allow-outside"), "{refused}");
        let scene = check(&root, file, triangles, spheres, true);
        clean(&scene);
    }
}

#[test]
fn all_mitsuba_scenes_load() {
    let Some(root) = real_scenes() else { return };
    for &(file, triangles, spheres) in SCENES {
        let scene = check(&root, file, triangles, spheres, false);
        let expected: &[&str] = match file {
            "rooms/living-room-mitsuba/scene.xml" => {
                &["22: unknown parameter \"high_quality_edges\" of film \"hdrfilm\": ignored"]
            }
            _ => &[],
        };
        assert_eq!(warnings(&scene), expected, "{file}");
    }
}
