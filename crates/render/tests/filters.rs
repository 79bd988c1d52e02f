//! Filters whose samples several pixels share: sums, edges, borders of tiles and of the picture, labels.

mod common;

use common::*;
use photinus_geometry::Vec3;
use photinus_render::{Aov, Mode, Renderer, Settings, Silent};
use photinus_scene::{Filter, Scene};

const SHARED: [Filter; 2] = [Filter::Tent { radius: 1.0 }, Filter::Gaussian { stddev: 0.5 }];

/// An emitting square right of the middle, before black; at 64 pixels its left edge lies at column 35.25.
fn half_bright() -> Scene {
    let mut scene = scene(camera(Vec3::ZERO, Vec3::Z, 90.0), 64);
    let black = scene.material(black());
    let edge = (35.25 / 32.0 - 1.0) * 10.0;
    // The camera looks along z with y up: x grows to the left of the picture.
    scene.quad(Vec3::new(-edge, -20.0, 10.0), Vec3::new(-40.0, 0.0, 0.0), Vec3::new(0.0, 40.0, 0.0), black, Some(1.0));
    scene.quad(Vec3::new(-edge, -20.0, 10.0), Vec3::new(0.0, 40.0, 0.0), Vec3::new(40.0, 0.0, 0.0), black, None);
    scene
}

/// Integral of the filter from `x` on over all of it.
fn step(filter: Filter, x: f32) -> f32 {
    let (radius, f): (f32, Box<dyn Fn(f32) -> f32>) = match filter {
        Filter::Tent { radius } => (radius, Box::new(move |x: f32| (1.0 - x.abs() / radius).max(0.0))),
        Filter::Gaussian { stddev } => {
            let bell = move |x: f32| libm::expf(-x * x / (2.0 * stddev * stddev));
            (4.0 * stddev, Box::new(move |x: f32| (bell(x) - bell(4.0 * stddev)).max(0.0)))
        }
        other => unreachable!("{other:?}"),
    };
    let (mut above, mut all) = (0.0, 0.0);
    for i in 0..20_000 {
        let at = radius * ((i as f32 + 0.5) / 10_000.0 - 1.0);
        all += f(at);
        above += if at > x { f(at) } else { 0.0 };
    }
    above / all
}

/// Pixels near an edge are the integral of the filter over the bright side, at every row; elsewhere they are 0 or 1 to
/// rounding, at borders of tiles and of the picture too.
#[test]
fn an_edge_is_the_integral_of_the_filter() {
    for filter in SHARED {
        for crop in [None, Some([20, 3, 41, 60])] {
            let mut scene = half_bright();
            scene.film.filter = filter;
            scene.film.crop = crop;
            let world = world(scene);
            let settings = Settings { mode: Mode::Path, spp: 2, max_depth: Some(1), ..Settings::default() };
            let (pixels, _) = render(&world, settings, 64);
            let [x0, _, width, height] = crop.unwrap_or([0, 0, 64, 64]);
            assert_eq!(pixels.len(), (width * height) as usize);
            for (i, pixel) in pixels.iter().enumerate() {
                let middle = (x0 + i as u32 % width) as f32 + 0.5;
                let expected = step(filter, 35.25 - middle);
                // 128 samples a pixel and its neighbours': well spread, their error is below a hundredth.
                let tolerance = if (1e-6..1.0 - 1e-6).contains(&expected) { 0.03 } else { 1e-5 };
                assert!((pixel.x - expected).abs() < tolerance, "{filter:?} {crop:?} {i}: {} not {expected}", pixel.x);
            }
        }
    }
}

/// Labels are those of a surface and no mixtures; a stop in the middle leaves means.
#[test]
fn labels_are_not_mixed() {
    let mut scene = half_bright();
    scene.film.filter = Filter::Gaussian { stddev: 0.5 };
    let world = world(scene);
    let settings =
        Settings { mode: Mode::Progressive, photons: Some(1000), aovs: Aov::ALL.to_vec(), ..Settings::default() };
    let mut renderer = Renderer::new(&world, settings, &Silent).expect("it starts");
    for _ in 0..3 {
        renderer.render_pass(&Silent).expect("nothing stops it");
    }
    let (layout, pixels) = (renderer.layout().clone(), renderer.pixels());
    let at = |aov: Aov| layout.offset(aov).expect("all are there");
    for pixel in pixels.chunks_exact(layout.channels()) {
        assert!([1.0, 2.0].contains(&pixel[at(Aov::ObjectId)]), "{}", pixel[at(Aov::ObjectId)]);
        assert_eq!(pixel[at(Aov::MaterialId)], 1.0);
        assert!((pixel[at(Aov::Normal) + 2] + 1.0).abs() < 1e-4, "{}", pixel[at(Aov::Normal) + 2]);
        let variance = pixel[at(Aov::Variance)];
        assert!((0.0..0.3).contains(&variance), "{variance}");
        let dark_or_bright = pixel[0] < 1e-6 || pixel[0] > 1.0 - 1e-5;
        assert!(!dark_or_bright || variance < 1e-5, "{} {variance}", pixel[0]);
    }
}

/// The variance that is told against the squared differences of renders with other seeds. Squares of passes that do not
/// count by the weights of their samples, as their mean does, tell three times as much.
#[test]
fn variance_is_that_of_the_picture() {
    for filter in [Filter::Box, SHARED[0], SHARED[1]] {
        let mut scene = scene(camera(Vec3::ZERO, Vec3::Z, 90.0), 32);
        let grey = scene.material(diffuse(0.5));
        scene.sphere(Vec3::ZERO, 1.0, true, grey, Some(0.25));
        scene.film.filter = filter;
        let world = world(scene);
        let picture = |seed| {
            let settings = Settings { photons: Some(5000), seed, track_error: true, ..Settings::default() };
            let mut renderer = Renderer::new(&world, settings, &Silent).expect("it starts");
            (0..6).for_each(|_| renderer.render_pass(&Silent).expect("nothing stops it"));
            let (channels, variance) = (renderer.layout().channels(), renderer.layout().offset(Aov::Variance));
            let variance = variance.expect("it is tracked");
            // All three channels are equal.
            renderer.pixels().chunks_exact(channels).map(|p| [p[0], p[variance]].map(f64::from)).collect::<Vec<_>>()
        };
        let (mut told, mut found) = (0.0, 0.0);
        for seed in 0..12 {
            for ([a, of_a], [b, of_b]) in picture(2 * seed).into_iter().zip(picture(2 * seed + 1)) {
                told += of_a + of_b;
                found += (a - b) * (a - b);
            }
        }
        println!("{filter:?}: {:.3}", told / found);
        assert!((0.7..2.0).contains(&(told / found)), "{filter:?}: {told} for {found}");
    }
}
