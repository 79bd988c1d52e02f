//! Metrics against numbers worked out by hand, FLIP's published properties, and the references of the real scenes.
// Whoever runs the tests must see what did not run, and the seed.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use photinus_image::metrics::{compare, compare_files, flip, flip_map, psnr, relmse, relmse_trimmed};
use photinus_image::{Image, ImageErrorKind};
use std::path::PathBuf;

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected} within {tolerance}");
}

fn image(width: usize, height: usize, pixel: impl Fn(usize, usize) -> [f32; 3]) -> Image {
    let pixels = (0..width * height).map(|i| pixel(i % width, i / width)).collect();
    Image { width, height, pixels }
}

#[test]
fn relmse_by_hand() {
    // Pixel 0: errors 1, 0, 2 over the reference 1, 2, 2: (5 / 3) / (3 + 0.01). Pixel 1: 0.1 over black: 0.01 / 0.01.
    let a = image(2, 1, |x, _| if x == 0 { [2.0, 2.0, 4.0] } else { [0.1; 3] });
    let b = image(2, 1, |x, _| if x == 0 { [1.0, 2.0, 2.0] } else { [0.0; 3] });
    let first = 5.0 / 3.0 / 3.01;
    near(relmse(&a, &b, None).unwrap(), (first + 1.0) / 2.0, 1e-7);
    // The mask leaves the first pixel; grey below half does not count.
    let mask = image(2, 1, |x, _| if x == 0 { [1.0; 3] } else { [0.2; 3] });
    near(relmse(&a, &b, Some(&mask)).unwrap(), first, 1e-12);
    let all = compare(&a, &b, Some(&mask)).unwrap();
    near(all.mean_a, 8.0 / 3.0, 1e-12);
    near(all.mean_b, 5.0 / 3.0, 1e-12);
    // The reference is the second image: swapped, the first pixel's error is divided by 8 + 0.01.
    near(relmse(&b, &a, Some(&mask)).unwrap(), 5.0 / 3.0 / 8.01, 1e-12);
}

#[test]
fn trimming_drops_the_worst_pixel_in_a_thousand() {
    // 2999 pixels lose 2, not 3: rounded down.
    for (count, dropped) in [(999, 0), (1000, 1), (1999, 1), (2000, 2), (2999, 2)] {
        let b = Image::filled(count, 1, [1.0; 3]);
        let mut a = b.clone();
        // Errors of 1 / 1.01, 4 / 1.01 and 9 / 1.01 in three pixels.
        for (i, value) in [(0, 2.0), (count / 2, 3.0), (count - 1, 4.0)] {
            a.pixels[i] = [value; 3];
        }
        let kept: f64 = [1.0, 4.0, 9.0][..3 - dropped].iter().sum();
        near(relmse(&a, &b, None).unwrap(), 14.0 / 1.01 / count as f64, 1e-12);
        near(relmse_trimmed(&a, &b, None).unwrap(), kept / 1.01 / (count - dropped) as f64, 1e-12);
    }
}

#[test]
fn psnr_by_hand() {
    // sRGB codes 0.5 apart everywhere: 10 log10(1 / 0.25).
    let b = Image::filled(4, 4, [0.0; 3]);
    let a = Image::filled(4, 4, [0.214_041_14; 3]);
    near(psnr(&a, &b, None).unwrap(), 6.0206, 1e-4);
    // What is clipped does not differ.
    near(psnr(&Image::filled(2, 2, [5.0; 3]), &Image::filled(2, 2, [1.0; 3]), None).unwrap(), 200.0, 0.0);
    near(psnr(&Image::filled(2, 2, [-1.0; 3]), &Image::filled(2, 2, [0.0; 3]), None).unwrap(), 200.0, 0.0);
}

#[test]
fn pixels_that_are_not_finite_are_clamped_and_counted() {
    let mut a = Image::filled(3, 1, [1.0; 3]);
    let mut b = Image::filled(3, 1, [1.0; 3]);
    a.pixels[0] = [f32::NAN, 1.0, 1.0];
    b.pixels[0] = [1.0, f32::INFINITY, 1.0];
    b.pixels[2] = [f32::NEG_INFINITY; 3];
    let found = compare(&a, &b, None).unwrap();
    assert_eq!(found.nonfinite, 2);
    near(found.mean_a, 8.0 / 9.0, 1e-12);
    near(found.mean_b, (3.0 + 65504.0 + 2.0 - 3.0 * 65504.0) / 9.0, 1e-9);
    let mask = image(3, 1, |x, _| if x == 1 { [1.0; 3] } else { [0.0; 3] });
    let middle = compare(&a, &b, Some(&mask)).unwrap();
    assert_eq!((middle.nonfinite, middle.relmse, middle.psnr), (0, 0.0, 200.0));
    for value in [found.relmse, found.relmse_trimmed, found.psnr, found.flip] {
        assert!(value.is_finite());
    }
}

#[test]
fn what_cannot_be_compared_is_one_clear_error() {
    let a = Image::filled(3, 2, [1.0; 3]);
    let b = Image::filled(2, 3, [1.0; 3]);
    let error = compare(&a, &b, None).unwrap_err();
    assert_eq!(error.kind, ImageErrorKind::Mismatch);
    assert!(error.to_string().contains("3 x 2") && error.to_string().contains("2 x 3"), "{error}");
    assert!(compare(&a, &a, Some(&b)).unwrap_err().to_string().contains("mask"));
    assert!(compare(&a, &a, Some(&Image::filled(3, 2, [0.0; 3]))).unwrap_err().to_string().contains("no pixel counts"));
    assert!(compare(&Image::default(), &Image::default(), None).is_err());
    let short = Image { width: 3, height: 2, pixels: vec![[1.0; 3]; 5] };
    assert!(compare(&short, &short, None).is_err());
}

#[test]
fn comparison_serialises_under_its_contract_names() {
    let a = Image::filled(4, 4, [0.5; 3]);
    let json = serde_json::to_value(compare(&a, &a, None).unwrap()).unwrap();
    let mut names: Vec<_> = json.as_object().unwrap().keys().map(String::as_str).collect();
    names.sort_unstable();
    assert_eq!(names, ["flip", "mean_a", "mean_b", "nonfinite", "psnr", "relmse", "relmse_trimmed"]);
    assert_eq!((json["psnr"].as_f64(), json["flip"].as_f64()), (Some(200.0), Some(0.0)));
}

/// Smooth colours with some structure.
fn scene() -> Image {
    image(80, 60, |x, y| {
        let (x, y) = (x as f32 / 80.0, y as f32 / 60.0);
        [x * x, 0.3 + 0.5 * y, if (x - 0.5).abs() < 0.2 { 0.9 } else { 0.1 }]
    })
}

#[test]
fn flip_has_its_published_properties() {
    let b = scene();
    assert_eq!(flip(&b, &b, None).unwrap(), 0.0);
    // Symmetric, within 0..1.
    let a = image(80, 60, |x, y| b.at(x, y).map(|c| c * if (x + y) % 7 == 0 { 0.2 } else { 1.1 }));
    let forward = flip(&a, &b, None).unwrap();
    near(forward, flip(&b, &a, None).unwrap(), 1e-12);
    assert!(forward > 0.02 && forward < 1.0);
    assert!(flip_map(&a, &b).unwrap().iter().all(|e| (0.0..=1.0).contains(e)));
    // Green against blue is the largest error of all, by construction of the scale (section 4.1.3).
    let green = Image::filled(20, 20, [0.0, 1.0, 0.0]);
    let blue = Image::filled(20, 20, [0.0, 0.0, 1.0]);
    near(flip(&green, &blue, None).unwrap(), 1.0, 1e-6);
    // A larger error is never judged smaller.
    let errors: Vec<f64> = [1.0, 0.95, 0.8, 0.5, 0.0]
        .iter()
        .map(|k| flip(&image(80, 60, |x, y| b.at(x, y).map(|c| c * k)), &b, None).unwrap())
        .collect();
    assert!(errors.windows(2).all(|pair| pair[0] < pair[1]), "{errors:?}");
    // The filters act within their radius: an error in one corner leaves the other alone.
    let mut corner = b.clone();
    corner.pixels[0] = [1.0, 0.0, 0.0];
    let map = flip_map(&corner, &b).unwrap();
    assert!(map[0] > 0.1 && map[79] == 0.0 && map[59 * 80] == 0.0);
    let mask = image(80, 60, |x, _| if x >= 40 { [1.0; 3] } else { [0.0; 3] });
    assert_eq!(flip(&corner, &b, Some(&mask)).unwrap(), 0.0);
}

/// Numbers of the authors' own program (flip-evaluator 1.7 from PyPI, LDR, 67 pixels per degree) for the same images,
/// which are exact in 8 bits.
#[test]
fn flip_agrees_with_the_authors_program() {
    let decode = |code: usize| photinus_image::colour::srgb_to_linear(code as f32 / 255.0);
    let black = Image::filled(32, 32, [0.0; 3]);
    let white = Image::filled(32, 32, [1.0; 3]);
    near(flip(&black, &white, None).unwrap(), 0.967_395, 1e-4);
    let base = image(64, 48, |x, y| [decode(x * 4), decode(y * 5), decode((x + y) * 2)]);
    let checks = image(64, 48, |x, y| if (x / 8 + y / 8) % 2 == 0 { base.at(x, y) } else { [decode(200); 3] });
    near(flip(&checks, &base, None).unwrap(), 0.612_417, 1e-4);
    let dots = image(64, 48, |x, y| if x % 13 == 0 && y % 11 == 0 { [1.0; 3] } else { base.at(x, y) });
    near(flip(&dots, &base, None).unwrap(), 0.053_921, 1e-4);
}

#[test]
fn real_references_compare_with_themselves_and_each_other() {
    let Some(scenes) = std::env::var_os("PHOTINUS_SCENES").map(PathBuf::from) else {
        eprintln!("PHOTINUS_SCENES is not set: the suite of real image files did not run");
        return;
    };
    let folder = scenes.join("caustics/two-spheres");
    let large = folder.join("large-lamp.exr");
    let counted = folder.join("large-lamp.counted.png");
    let same = compare_files(&large, &large, Some(&counted)).unwrap();
    assert_eq!((same.relmse, same.relmse_trimmed, same.psnr, same.flip, same.nonfinite), (0.0, 0.0, 200.0, 0.0, 0));
    assert!(same.mean_a > 0.05 && same.mean_a < 2.0, "{}", same.mean_a);
    // Lamps of one power but another size: alike, not equal.
    let other =
        compare_files(folder.join("small-lamp.exr"), &large, Some(&folder.join("small-lamp.counted.png"))).unwrap();
    assert!(other.relmse > 1e-3 && other.relmse < 10.0 && other.relmse_trimmed < other.relmse, "{other:?}");
    // Half-precision overflow in the published reference.
    let water = scenes.join("caustics/water-caustic-pbrt/TungstenRender.exr");
    let infinite = compare_files(&water, &water, None).unwrap();
    assert!(infinite.nonfinite > 0 && infinite.relmse == 0.0 && infinite.mean_a.is_finite(), "{infinite:?}");
    // The README of the scenes gives this mean.
    let room = scenes.join("rooms/living-room-mitsuba/TungstenRender.exr");
    near(compare_files(&room, &room, None).unwrap().mean_b, 1.629, 0.001);
}
