//! Renders small pictures with every ray-triangle method and every acceleration structure, and counts the pixels that
//! differ from those of the default members: `cargo run --release -p photinus --example method_pictures [-- --brute-force]`.
//!
//! Testing every triangle of the room for every ray takes minutes and is done on demand only.

#![expect(clippy::print_stdout, reason = "an example talks to its reader")]

use photinus::image::Image;
use photinus::image::colour::linear_to_srgb;
use photinus::names;
use photinus::render::{Aov, Mode, RenderOptions, Session, Settings, Silent, Stop};
use photinus::{LoadOptions, Result};

/// A scene in the thesis's mode, with few pixels and photons: one structure tests every triangle.
struct Scene {
    name: &'static str,
    size: [u32; 2],
    photons: u32,
    radius: Option<f32>,
}

const SCENES: [Scene; 2] = [
    Scene { name: "two-spheres", size: [96, 96], photons: 5000, radius: None },
    Scene { name: "room-1", size: [48, 36], photons: 1000, radius: Some(20.0) },
];

/// The picture and the distances in its first pass.
fn render(scene: &Scene, accel: &str, intersect: &str) -> Result<(Image, Vec<f32>)> {
    let options = RenderOptions {
        settings: Settings {
            mode: Mode::Direct,
            photons: Some(scene.photons),
            radius: scene.radius,
            aovs: vec![Aov::Depth],
            ..Settings::default()
        },
        accel: accel.into(),
        intersect: intersect.into(),
        size: Some(scene.size),
        stop: Stop { passes: Some(1), ..Stop::default() },
        ..RenderOptions::default()
    };
    let session = Session::new(photinus::open(scene.name, &LoadOptions::default())?, options)?;
    let picture = session.render(&Silent)?.picture.expect("one pass was asked for");
    let depth = picture.layers.channel("depth.Z").expect("the layer was asked for").to_vec();
    Ok((picture.image(), depth))
}

/// The largest difference of two pixels in 8-bit sRGB codes.
fn codes(a: [f32; 3], b: [f32; 3]) -> f32 {
    let code = |x: f32| linear_to_srgb(x.clamp(0.0, 1.0)) * 255.0;
    a.iter().zip(b).map(|(a, b)| (code(*a) - code(b)).abs()).fold(0.0, f32::max)
}

fn main() -> Result<()> {
    let brute_force = std::env::args().any(|argument| argument == "--brute-force");
    // A folder to write into, which every example may be given: a small run that writes nothing.
    let is_small = std::env::args().skip(1).any(|argument| std::path::Path::new(&argument).is_dir());
    for scene in SCENES.into_iter().take(if is_small { 1 } else { SCENES.len() }) {
        let (reference, distances) = render(&scene, names::ACCEL.default, names::INTERSECT.default)?;
        println!("{}, {} pixels: another distance, more than one code, more than eight", scene.name, distances.len());
        for method in names::INTERSECT.members() {
            print!("{:<17}", method.name);
            for structure in names::ACCEL.members().iter().filter(|s| brute_force || s.name != "brute-force") {
                let (picture, depth) = render(&scene, structure.name, method.name)?;
                let far = depth.iter().zip(&distances).filter(|(a, b)| !((*a - *b).abs() <= 1e-3 * b.abs())).count();
                let pixels = || (0..depth.len()).map(|i| [i % scene.size[0] as usize, i / scene.size[0] as usize]);
                let above = |limit: f32| {
                    pixels().filter(|[x, y]| codes(picture.at(*x, *y), reference.at(*x, *y)) > limit).count()
                };
                print!("  {} {far} {} {}", structure.name, above(1.0), above(8.0));
            }
            println!();
        }
    }
    Ok(())
}
