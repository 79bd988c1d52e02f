//! Supports and kernels of estimates in renders, and caustic photons in a map of their own.

#![allow(clippy::disallowed_methods)] // Expected values may come from any mathematics library.

mod common;

use common::*;
use photinus_geometry::Vec3;
use photinus_photons::{KERNELS, SUPPORTS};
use photinus_render::{Aov, Mode, Renderer, Settings, Silent, World};
use photinus_scene::*;

/// A glass ball over a floor under a small lamp, and a diffuse ball.
fn caustic_world() -> World {
    let mut scene = scene(camera(Vec3::new(0.0, 1.5, 3.0), Vec3::new(0.0, 0.2, 0.0), 40.0), 32);
    let white = scene.material(diffuse(0.7));
    let dark = scene.material(black());
    let clear = scene.material(glass(1.5));
    scene.quad(Vec3::new(-2.0, 0.0, 2.0), Vec3::X * 4.0, Vec3::NEG_Z * 4.0, white, None);
    scene.sphere(Vec3::new(-0.3, 0.5, 0.0), 0.4, false, clear, None);
    scene.sphere(Vec3::new(0.6, 0.3, 0.0), 0.3, false, white, None);
    scene.quad(Vec3::new(-0.1, 2.5, -0.1), Vec3::X * 0.2, Vec3::Z * 0.2, dark, Some(100.0));
    world(scene)
}

fn assert_alike(a: &[Vec3], b: &[Vec3], context: &str) {
    assert!(mean(b) > 0.01, "{context}: a black picture");
    for (a, b) in a.iter().zip(b) {
        assert!((*a - *b).abs().max_element() <= 1e-5 * (1.0 + b.max_element()), "seed {SEED}: {context}: {a} {b}");
    }
}

/// With photons in heaps and few, with and without a limit on their number, by searches of every kind.
#[test]
fn trimmed_boxes_make_the_picture_of_balls() {
    let world = caustic_world();
    for mode in [Mode::Direct, Mode::Gather, Mode::Progressive] {
        for knn in [None, Some(30)] {
            let render = |search: &str, support: &str| {
                let (search, support) = (search.to_owned(), support.to_owned());
                let settings = Settings { photons: Some(20_000), search, support, knn, ..settings(mode) };
                render(&world, settings, 2).0
            };
            for search in ["grid", "kd-balanced", "bvh", "hashed-grid"] {
                let context = format!("{mode:?} {knn:?} by {search}");
                assert_alike(&render(search, "box-trimmed"), &render(search, "ball"), &context);
            }
        }
    }
}

/// A plane across a diagonal of the axes in parallel light from straight above it: radiance albedo / pi times 1. Of 200,000 photons
/// 14,000 or more fall on each unit of the plane, whose 1.1 units in the picture make the mean: its relative standard error is
/// below 0.01, the cone's, whose weights differ most, too.
#[test]
fn a_slanted_plane_is_as_bright_as_its_light() {
    let normal = Vec3::ONE.normalize();
    let across = Vec3::new(1.0, -1.0, 0.0).normalize();
    let along = normal.cross(across);
    let mut scene = scene(camera(normal * 3.0, Vec3::ZERO, 20.0), 24);
    let white = scene.material(diffuse(0.5));
    scene.quad((across + along) * -1.5, across * 3.0, along * 3.0, white, None);
    scene.lights.push(Light::Directional { irradiance: Vec3::ONE, direction: -normal });
    let world = world(scene);
    let expected = 0.5 / std::f64::consts::PI;
    for support in SUPPORTS {
        for kernel in KERNELS {
            for knn in [None, Some(60)] {
                let settings = Settings {
                    photons: Some(200_000),
                    radius: Some(0.1),
                    support: support.name.to_owned(),
                    kernel: Some(kernel.name.to_owned()),
                    knn,
                    ..settings(Mode::Direct)
                };
                let found = mean(&render(&world, settings, 1).0) / expected;
                // The plane within the box is 0.75 sqrt(3) times a face.
                let factor = if support.name == "box-fixed" { 0.75 * 3f64.sqrt() } else { 1.0 };
                let bias = if knn.is_some() { 60.0 / 59.0 } else { 1.0 };
                let error = found / factor / bias - 1.0;
                assert!(error.abs() < 0.03, "seed {SEED}: {} {} {knn:?}: {found}", support.name, kernel.name);
            }
        }
    }
}

/// In a closed cube that shines, whose edges and corners cut many discs, every kernel finds radiance 0.5: the correction at
/// edges goes by the kernel. Without it the picture is a tenth darker or more.
#[test]
fn edges_are_corrected_for_every_kernel() {
    let mut scene = scene(camera(Vec3::new(0.0, 0.0, 0.9), Vec3::NEG_Z, 90.0), 32);
    let id = scene.material(diffuse(0.5));
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map(|a| Vec3::AXES[a] * 2.0);
        scene.quad(Vec3::NEG_ONE, u, v, id, Some(0.25));
        scene.quad(Vec3::NEG_ONE + Vec3::AXES[axis] * 2.0, v, u, id, Some(0.25));
    }
    let world = world(scene);
    let mean_of = |support: &str, kernel: &str, mode| {
        let (support, kernel) = (support.to_owned(), Some(kernel.to_owned()));
        let settings =
            Settings { photons: Some(100_000), radius: Some(0.4), support, kernel, spp: 4, ..settings(mode) };
        mean(&render(&world, settings, 4).0)
    };
    for kernel in KERNELS {
        for mode in [Mode::Gather, Mode::Progressive] {
            for support in ["ball", "box-trimmed"] {
                let found = mean_of(support, kernel.name, mode);
                assert!((found - 0.5).abs() < 0.005, "seed {SEED}: {mode:?} {support} {}: {found}", kernel.name);
            }
        }
    }
    // What is not corrected is dark.
    for support in ["disc", "ellipsoid"] {
        let found = mean_of(support, "constant", Mode::Gather);
        assert!((0.44..0.49).contains(&found), "seed {SEED}: {support}: {found}");
    }
}

/// Two maps of one radius make the picture of one map: every photon is in one of them, and in one only. The caustic is a part of the
/// picture then; a narrower radius makes it brighter where it is brightest.
#[test]
fn caustic_photons_in_a_map_of_their_own_are_counted_once() {
    let world = caustic_world();
    let settings = Settings { photons: Some(50_000), radius: Some(0.2), ..settings(Mode::Direct) };
    let apart = |caustic_radius, knn| Settings { caustic_radius, knn, ..settings.clone() };
    let (one, counted) = render(&world, settings.clone(), 1);
    let (two, counted_apart) = render(&world, apart(Some(0.2), None), 1);
    assert_alike(&two, &one, "two maps");
    assert_eq!(counted.photons.stored, counted_apart.photons.stored);
    assert_eq!(counted.photons.power.stored, counted_apart.photons.power.stored);
    let of_two = counted_apart.photons.stored_caustic;
    assert!(counted.photons.stored_caustic == 0 && of_two > 1000, "{of_two}");
    assert_eq!(counted_apart.searches, 2 * counted.searches);

    let caustic = |settings: Settings| {
        let settings = Settings { aovs: vec![Aov::Caustic], ..settings };
        let mut renderer = Renderer::new(&world, settings, &Silent).unwrap();
        renderer.render_pass(&Silent).unwrap();
        let (channels, offset) = (renderer.layout().channels(), renderer.layout().offset(Aov::Caustic).unwrap());
        renderer.pixels().chunks_exact(channels).map(|p| p[offset]).collect::<Vec<f32>>()
    };
    let brightest = |pixels: &[f32]| pixels.iter().copied().fold(0.0, f32::max);
    let (wide, narrow) = (caustic(apart(Some(0.2), None)), caustic(apart(Some(0.04), None)));
    assert!(brightest(&wide) > 0.1 && brightest(&narrow) > 2.0 * brightest(&wide), "{wide:?} {narrow:?}");
    assert!(caustic(settings.clone()).iter().all(|value| *value == 0.0));
    // A limit on the number holds for each map by itself; it can only make the sharper map sharper.
    let nearest = caustic(apart(Some(0.2), Some(50)));
    assert!(brightest(&nearest) > brightest(&wide));
}

/// In gather the caustic map has its own radius anyway: the option sets it, and leaves the other one.
#[test]
fn the_caustic_radius_of_gather_is_the_one_asked_for() {
    let world = caustic_world();
    let radii = |caustic_radius, radius| {
        let settings = Settings { photons: Some(20_000), radius, caustic_radius, ..settings(Mode::Gather) };
        Renderer::new(&world, settings, &Silent).unwrap().radii()
    };
    let [global, caustic] = radii(None, None);
    assert_eq!(radii(Some(0.033), None), [global, 0.033]);
    assert_eq!(radii(Some(0.033), Some(0.2)), [0.2, 0.033]);
    assert_eq!(radii(None, Some(0.2)), [0.2, 0.2]);
    assert!(caustic != 0.033);
}
