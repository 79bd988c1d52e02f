//! Pictures against references that other renderers made, on the real scenes of `PHOTINUS_SCENES`.

#![expect(clippy::print_stdout, reason = "a suite that does not run says so")]

use photinus::image::colour::rgb_to_xyz;
use photinus::image::metrics::{relmse, relmse_trimmed};
use photinus::image::{Image, read_image};
use photinus::render::{Mode, RenderOptions, Session, Settings, Silent, Stop};
use photinus::{LoadOptions, Scene};
use std::path::{Path, PathBuf};

/// A test scene of Mitsuba 3, and the start of the names of its reference pictures.
struct Reference {
    scene: &'static str,
    pictures: &'static str,
    /// Most relMSE in the mode `progressive`: about three times what was measured.
    progressive_relmse: f64,
}

const MITSUBA: &[Reference] = &[
    Reference {
        scene: "floating_sphere/test_directional_direct.xml",
        pictures: "floating_sphere/refs/test_directional_ref_rgb",
        progressive_relmse: 5e-6,
    },
    Reference {
        scene: "infinite_mirrors/scene_path.xml",
        pictures: "infinite_mirrors/refs/scene_ref_rgb",
        progressive_relmse: 1.5e-3,
    },
    Reference {
        scene: "instancing/test_instancing_path.xml",
        pictures: "instancing/refs/test_instancing_ref_rgb",
        progressive_relmse: 1e-5,
    },
    Reference {
        scene: "texture_interp/test_texture_interp_direct.xml",
        pictures: "texture_interp/refs/test_texture_interp_ref_rgb",
        progressive_relmse: 8e-5,
    },
];

/// Samples of a picture: twice as many as Mitsuba's test takes.
const SAMPLES: usize = 4_000_000;

/// Probability that a right renderer fails in any pixel, and the share of pixels that must pass.
const SIGNIFICANCE: f64 = 0.01;
const PASSING: f64 = 0.9975;

/// The folder of real scenes; where it is not set, one line says so.
fn real_scenes() -> Option<PathBuf> {
    let folder = std::env::var_os("PHOTINUS_SCENES").map(PathBuf::from);
    if folder.is_none() {
        println!("PHOTINUS_SCENES is not set: the suite of reference pictures did not run");
    }
    folder
}

fn open(path: &Path) -> Scene {
    // The scenes share a folder of meshes and textures above their own.
    let options = LoadOptions { allow_outside: true, ..LoadOptions::default() };
    photinus::open(path.to_str().expect("a path in Unicode"), &options).unwrap()
}

fn render(scene: &Scene, options: RenderOptions) -> Image {
    let rendered = Session::new(scene.clone(), options).unwrap().render(&Silent).unwrap();
    rendered.picture.expect("a finished pass").image()
}

fn settings(mode: Mode, spp: u32, passes: u32) -> RenderOptions {
    RenderOptions {
        settings: Settings { mode, spp, ..Settings::default() },
        stop: Stop { passes: Some(passes), ..Stop::default() },
        ..RenderOptions::default()
    }
}

/// Share of the pixels' X, Y and Z that pass the two-sided z-test of `mean`, of `spp` samples a pixel, against the
/// reference, at the significance that Sidak's correction gives each pixel.
fn share_that_passes(mean: &Image, spp: usize, reference: &Image, variance: &Image) -> f64 {
    assert_eq!((mean.width, mean.height), (reference.width, reference.height));
    assert_eq!((mean.width, mean.height), (variance.width, variance.height));
    let pixels = mean.pixels.len();
    let alpha = 1.0 - libm::pow(1.0 - SIGNIFICANCE, 1.0 / pixels as f64);
    let mut passed = 0;
    for i in 0..pixels {
        let xyz = |image: &Image| rgb_to_xyz(image.pixels[i].map(f64::from));
        let (mean, reference, variance) = (xyz(mean), xyz(reference), xyz(variance));
        for c in 0..3 {
            let z = (mean[c] - reference[c]).abs() * (spp as f64 / variance[c].max(1e-4)).sqrt();
            passed += usize::from(libm::erfc(z / std::f64::consts::SQRT_2) > alpha);
        }
    }
    passed as f64 / (3 * pixels) as f64
}

fn mean(image: &Image) -> f64 {
    let sum: f64 = image.pixels.iter().flatten().map(|&v| f64::from(v)).sum();
    sum / (3 * image.pixels.len()) as f64
}

#[test]
fn mitsubas_test_scenes_pass_its_own_test() {
    let Some(scenes) = real_scenes() else { return };
    let folder = scenes.join("mitsuba-tests/tests/scenes");
    for reference in MITSUBA {
        let scene = open(&folder.join(reference.scene));
        let expected = read_image(folder.join(format!("{}.exr", reference.pictures))).unwrap();
        let variance = read_image(folder.join(format!("{}_var.exr", reference.pictures))).unwrap();
        let spp = SAMPLES / expected.pixels.len();

        let traced = render(&scene, settings(Mode::Path, spp as u32, 1));
        let passing = share_that_passes(&traced, spp, &expected, &variance);
        assert!(passing >= PASSING, "{}: {passing}", reference.scene);
        // The test has teeth: two per cent more light fail it.
        let brighter = Image { pixels: traced.pixels.iter().map(|p| p.map(|v| 1.02 * v)).collect(), ..traced };
        let failing = share_that_passes(&brighter, spp, &expected, &variance);
        assert!(failing < PASSING, "{} with 2 % too much light: {failing}", reference.scene);

        let mapped = render(&scene, settings(Mode::Progressive, 32, 16));
        let error = relmse(&mapped, &expected, None).unwrap();
        let ratio = mean(&mapped) / mean(&expected);
        println!("{}: {passing} pass, {failing} of brighter; progressive {error:.2e}, {ratio}", reference.scene);
        assert!(error <= reference.progressive_relmse, "{}: relMSE {error}", reference.scene);
        assert!((ratio - 1.0).abs() < 0.001, "{}: mean {ratio} of the reference's", reference.scene);
    }
}

/// Bitterli's Cornell box at a quarter of its size, against the means of blocks of 4 x 4 pixels of the reference. The
/// filters of both differ along edges only, which the trimmed mean leaves out in part.
#[test]
fn cornell_box_agrees_with_tungsten() {
    const BLOCK: usize = 4;
    let Some(scenes) = real_scenes() else { return };
    let folder = scenes.join("cornell/bitterli");
    let scene = open(&folder.join("mitsuba/scene_v3.xml"));
    let whole = read_image(folder.join("pbrt/TungstenRender.exr")).unwrap();
    let (width, height) = (whole.width / BLOCK, whole.height / BLOCK);
    let mut expected = Image::filled(width, height, [0.0; 3]);
    for (i, &pixel) in whole.pixels.iter().enumerate() {
        let (x, y) = (i % whole.width / BLOCK, i / whole.width / BLOCK);
        for c in 0..3 {
            expected.pixels[y * width + x][c] += pixel[c] / (BLOCK * BLOCK) as f32;
        }
    }
    let size = Some([width as u32, height as u32]);
    let rendered = render(&scene, RenderOptions { size, ..settings(Mode::Progressive, 1, 32) });
    let (error, ratio) = (relmse_trimmed(&rendered, &expected, None).unwrap(), mean(&rendered) / mean(&expected));
    println!("Cornell box: trimmed relMSE {error:.2e}, mean {ratio}");
    // 0.0026 and 0.9943: with the wide radii of so small a picture the box is darker along its seams.
    assert!(error <= 0.005, "relMSE {error}");
    assert!((ratio - 1.0).abs() < 0.01, "mean {ratio} of the reference's");
}
