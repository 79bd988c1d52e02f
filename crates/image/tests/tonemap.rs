//! Every tone curve on the list: bounded, monotone, black stays black, and its published points.

use photinus_image::tonemap::{TONEMAPS, Tonemap};

#[test]
fn every_curve_is_bounded_and_monotone_in_grey() {
    for tonemap in TONEMAPS {
        let mut before = -1.0;
        for step in -200..200 {
            let light = libm::exp2(f64::from(step) / 10.0) as f32;
            let [r, g, b] = tonemap.map([light; 3]);
            assert!((r - g).abs() < 2e-3 && (g - b).abs() < 2e-3, "{}: grey {light} became {r} {g} {b}", tonemap.name);
            assert!(
                (0.0..=1.0).contains(&r) && r >= before - 1e-6,
                "{}: {light} gives {r} after {before}",
                tonemap.name
            );
            before = r;
        }
        assert!(before > 0.95, "{}: bright light gives {before}", tonemap.name);
        assert!(tonemap.map([0.0; 3]).iter().all(|c| *c < 1e-3), "{}: black is lit", tonemap.name);
    }
}

#[test]
fn every_curve_survives_any_input() {
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -0.0, 0.0, f32::MIN_POSITIVE, f32::MAX, 1e-30, 1e30];
    for tonemap in TONEMAPS {
        for r in odd {
            for g in odd {
                for b in odd {
                    let shown = tonemap.map([r, g, b]);
                    assert!(
                        shown.iter().all(|c| (0.0..=1.0).contains(c)),
                        "{}: {:?} gives {shown:?}",
                        tonemap.name,
                        [r, g, b]
                    );
                }
            }
        }
    }
}

fn curve(name: &str) -> Tonemap {
    TONEMAPS.iter().find(|tonemap| tonemap.name == name).copied().expect("a name on the list")
}

#[test]
fn curves_pass_their_published_points() {
    let grey = |name: &str, light: f32| curve(name).map([light; 3])[1];
    let near = |found: f32, expected: f32| assert!((found - expected).abs() < 2e-3, "{found} is not {expected}");
    near(grey("srgb", 0.5), 0.5);
    near(grey("srgb", 7.0), 1.0);
    // White point 4 maps to 1, 1 to (1 + 1/16) / 2.
    near(grey("reinhard", 4.0), 1.0);
    near(grey("reinhard", 1.0), 0.53125);
    // Hable's white, before his exposure bias of 2.
    near(grey("filmic", 5.6), 1.0);
    near(grey("aces", 1.0), (2.51 + 0.03) / (2.43 + 0.59 + 0.14));
    // The polynomial's ends: -0.00232 (clipped) and 0.98858; AgX puts 0.18 at about 0.18 by construction.
    near(grey("agx", 1e-6), 0.0);
    assert!((grey("agx", 0.18) - 0.18).abs() < 0.05, "{}", grey("agx", 0.18));
}

#[test]
fn reinhard_keeps_the_ratios_of_a_colour() {
    let [r, g, b] = curve("reinhard").map([0.8, 0.4, 0.2]);
    assert!((r / g - 2.0).abs() < 1e-5 && (g / b - 2.0).abs() < 1e-5);
}

#[test]
fn names_are_distinct() {
    for tonemap in TONEMAPS {
        assert_eq!(TONEMAPS.iter().filter(|other| other.name == tonemap.name).count(), 1);
        assert!(!tonemap.summary.is_empty());
    }
    assert_eq!(Tonemap::default().name, "srgb");
}
