//! Spectra and black bodies against published numbers.

use photinus_image::colour::{
    SpectrumError, SpectrumKind, blackbody_radiance, blackbody_to_rgb, luminance, spectrum_to_rgb,
};

fn near(found: [f32; 3], expected: [f32; 3], tolerance: f32) {
    let close = (0..3).all(|c| (found[c] - expected[c]).abs() <= tolerance * expected[c].abs().max(0.02));
    assert!(close, "{found:?} is not {expected:?} within {tolerance}");
}

#[test]
fn constant_reflectance_is_grey() {
    for value in [0.0, 0.18, 0.78, 1.0] {
        for list in [vec![(550.0, value)], vec![(400.0, value), (700.0, value)], vec![(500.0, value), (501.0, value)]] {
            near(spectrum_to_rgb(&list, SpectrumKind::Reflectance).unwrap(), [value as f32; 3], 1e-6);
        }
    }
}

#[test]
fn one_value_of_emission_is_grey() {
    assert_eq!(spectrum_to_rgb(&[(550.0, 5.0)], SpectrumKind::Emission), Ok([5.0; 3]));
}

/// Mitsuba's project data publish the Cornell box's paints as reflectance at wavelengths and as RGB; the RGB comes from
/// the spectrum without an illuminant. Here the values every 20 nm (the tables have 4 nm): within 0.02 of the published.
#[test]
fn measured_cornell_paints_give_their_published_colours() {
    let wavelengths = (0..16).map(|i| 400.0 + 20.0 * f64::from(i));
    let green = [
        0.092, 0.095, 0.097, 0.104, 0.125, 0.285, 0.472, 0.441, 0.337, 0.250, 0.160, 0.126, 0.114, 0.120, 0.144, 0.159,
    ];
    let red = [
        0.040, 0.050, 0.059, 0.062, 0.060, 0.058, 0.057, 0.059, 0.067, 0.099, 0.287, 0.513, 0.609, 0.638, 0.642, 0.642,
    ];
    for (paint, published) in [(green, [0.105421, 0.37798, 0.076425]), (red, [0.570068, 0.0430135, 0.0443706])] {
        let list: Vec<(f64, f64)> = wavelengths.clone().zip(paint).collect();
        let found = spectrum_to_rgb(&list, SpectrumKind::Emission).unwrap();
        assert!((0..3).all(|c: usize| (found[c] - published[c]).abs() < 0.02), "{found:?} is not {published:?}");
    }
    let lamp_surface = [(400.0, 0.78), (500.0, 0.78), (600.0, 0.78), (700.0, 0.78)];
    near(spectrum_to_rgb(&lamp_surface, SpectrumKind::Emission).unwrap(), [0.936461, 0.740433, 0.705267], 0.005);
}

#[test]
fn saturated_colours_stay_in_the_gamut() {
    for nm in (380..780).step_by(7).map(f64::from) {
        let line = [(nm - 2.0, 0.0), (nm, 1.0), (nm + 2.0, 0.0)];
        for kind in [SpectrumKind::Reflectance, SpectrumKind::Emission] {
            let rgb = spectrum_to_rgb(&line, kind).unwrap();
            assert!(rgb.iter().all(|c| c.is_finite() && *c >= 0.0 && *c <= 1.0), "{nm} nm: {rgb:?}");
        }
    }
    let red = spectrum_to_rgb(&[(620.0, 0.0), (621.0, 1.0)], SpectrumKind::Reflectance).unwrap();
    assert!(red[0] > 0.4 && red[1] < 0.1 && red[2] < 0.01, "{red:?}");
}

#[test]
fn lists_that_are_no_spectra_are_errors() {
    let refuse = |list: &[(f64, f64)], error| {
        assert_eq!(spectrum_to_rgb(list, SpectrumKind::Emission), Err(error));
        assert_eq!(spectrum_to_rgb(list, SpectrumKind::Reflectance), Err(error));
    };
    refuse(&[], SpectrumError::Empty);
    refuse(&[(500.0, 1.0), (500.0, 2.0)], SpectrumError::NotIncreasing(1));
    refuse(&[(500.0, 1.0), (600.0, f64::NAN)], SpectrumError::NotFinite(1));
    refuse(&[(f64::INFINITY, 1.0)], SpectrumError::NotFinite(0));
}

/// Stefan-Boltzmann: the integral over all wavelengths is sigma T^4 / pi; Wien: the peak lies at b / T.
#[test]
fn black_bodies_obey_stefan_boltzmann_and_wien() {
    for kelvin in [300.0, 1500.0, 6504.0] {
        // In steps of 0.1 % of the wavelength.
        let (mut total, mut peak, mut peak_nm, mut nm) = (0.0, 0.0, 0.0, 10.0);
        while nm < 1e7 {
            let radiance = blackbody_radiance(nm, kelvin);
            if radiance > peak {
                (peak, peak_nm) = (radiance, nm);
            }
            total += radiance * nm * 0.001;
            nm *= 1.001;
        }
        let expected = 5.670_374_419e-8 * kelvin.powi(4) / std::f64::consts::PI;
        assert!((total / expected - 1.0).abs() < 1e-3, "{kelvin} K: {total} for {expected}");
        assert!((peak_nm * kelvin / 2.897_771_955e6 - 1.0).abs() < 2e-3, "{kelvin} K: peak at {peak_nm} nm");
    }
}

/// Chromaticities of the Planckian locus (Wyszecki and Stiles 1982, table 1(3.11)): 2856 K is illuminant A.
#[test]
fn black_bodies_lie_on_the_planckian_locus() {
    for (kelvin, x, y) in [(2856.0, 0.4476, 0.4074), (4000.0, 0.3805, 0.3768), (6500.0, 0.3135, 0.3237)] {
        let rgb = blackbody_to_rgb(kelvin);
        assert!((luminance(rgb) - 1.0).abs() < 1e-3);
        let xyz = photinus_image::colour::rgb_to_xyz(rgb.map(f64::from));
        let sum: f64 = xyz.iter().sum();
        let (found_x, found_y) = (xyz[0] / sum, xyz[1] / sum);
        assert!((found_x - x).abs() < 0.004 && (found_y - y).abs() < 0.004, "{kelvin} K: {found_x} {found_y}");
    }
    for kelvin in [0.0, -5.0, f64::NAN, 1.0] {
        assert_eq!(blackbody_to_rgb(kelvin), [0.0; 3], "{kelvin} K");
    }
}
