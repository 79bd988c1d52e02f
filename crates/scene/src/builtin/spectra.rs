//! The measured spectra of the Cornell box and their colours in linear sRGB.
//!
//! Reflectances of the white, red and green paint: Cornell University Program of Computer Graphics, "Cornell Box
//! Data", 400 to 700 nm in steps of 4 nm; the lamp: four values of the same source.
//! Colours are balanced so that equal energy is (1, 1, 1): for a perfect reflector as for a lamp.

use libm::exp;

/// First wavelength of the reflectances, nm.
const FIRST: f64 = 400.0;
/// Distance of their wavelengths, nm.
const STEP: f64 = 4.0;
const SAMPLES: usize = 76;

/// White paint.
pub const WHITE: [f64; SAMPLES] = [
    0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.71, 0.745, 0.758, 0.739, 0.767, 0.777, 0.765,
    0.751, 0.745, 0.748, 0.729, 0.745, 0.757, 0.753, 0.75, 0.746, 0.747, 0.735, 0.732, 0.739, 0.734, 0.725, 0.721,
    0.733, 0.725, 0.732, 0.743, 0.744, 0.748, 0.728, 0.716, 0.733, 0.726, 0.713, 0.74, 0.754, 0.764, 0.752, 0.736,
    0.734, 0.741, 0.74, 0.732, 0.745, 0.755, 0.751, 0.744, 0.731, 0.733, 0.744, 0.731, 0.712, 0.708, 0.729, 0.73,
    0.727, 0.707, 0.703, 0.729, 0.75, 0.76, 0.751, 0.739, 0.724, 0.73, 0.74, 0.737,
];

/// Red paint, on the left.
pub const RED: [f64; SAMPLES] = [
    0.04, 0.046, 0.048, 0.053, 0.049, 0.05, 0.053, 0.055, 0.057, 0.056, 0.059, 0.057, 0.061, 0.061, 0.06, 0.062, 0.062,
    0.062, 0.061, 0.062, 0.06, 0.059, 0.057, 0.058, 0.058, 0.058, 0.056, 0.055, 0.056, 0.059, 0.057, 0.055, 0.059,
    0.059, 0.058, 0.059, 0.061, 0.061, 0.063, 0.063, 0.067, 0.068, 0.072, 0.08, 0.09, 0.099, 0.124, 0.154, 0.192,
    0.255, 0.287, 0.349, 0.402, 0.443, 0.487, 0.513, 0.558, 0.584, 0.62, 0.606, 0.609, 0.651, 0.612, 0.61, 0.65, 0.638,
    0.627, 0.62, 0.63, 0.628, 0.642, 0.639, 0.657, 0.639, 0.635, 0.642,
];

/// Green paint, on the right.
pub const GREEN: [f64; SAMPLES] = [
    0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097, 0.098, 0.096, 0.101, 0.103, 0.104,
    0.107, 0.109, 0.112, 0.115, 0.125, 0.14, 0.16, 0.187, 0.229, 0.285, 0.343, 0.39, 0.435, 0.464, 0.472, 0.476, 0.481,
    0.462, 0.447, 0.441, 0.426, 0.406, 0.373, 0.347, 0.337, 0.314, 0.285, 0.277, 0.266, 0.25, 0.23, 0.207, 0.186,
    0.171, 0.16, 0.148, 0.141, 0.136, 0.13, 0.126, 0.123, 0.121, 0.122, 0.119, 0.114, 0.115, 0.117, 0.117, 0.118, 0.12,
    0.122, 0.128, 0.132, 0.139, 0.144, 0.146, 0.15, 0.152, 0.157, 0.159,
];

/// Radiance of the lamp in W/m²/sr at 400, 500, 600 and 700 nm.
pub const LAMP: [f64; 4] = [0.0, 8.0, 15.6, 18.4];

/// RGB of a reflectance, 0 to 1.
pub fn reflectance_rgb(spectrum: &[f64; SAMPLES]) -> [f32; 3] {
    balanced_rgb(|i| spectrum[i]).map(|c| c.clamp(0.0, 1.0))
}

/// RGB of the lamp's radiance, W/m²/sr.
pub fn lamp_rgb() -> [f32; 3] {
    balanced_rgb(|i| {
        let x = STEP * i as f64 / 100.0;
        let k = (x as usize).min(LAMP.len() - 2);
        let t = x - k as f64;
        LAMP[k] * (1.0 - t) + LAMP[k + 1] * t
    })
}

/// Linear sRGB of a spectrum, given by sample, over that of a spectrum of ones.
fn balanced_rgb(spectrum: impl Fn(usize) -> f64) -> [f32; 3] {
    let (color, white) = (srgb(spectrum), srgb(|_| 1.0));
    [0, 1, 2].map(|c| (color[c] / white[c]) as f32)
}

/// Linear sRGB (IEC 61966-2-1) of a spectrum over the integral of the luminosity.
fn srgb(spectrum: impl Fn(usize) -> f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let mut norm = 0.0;
    for i in 0..SAMPLES {
        let cmf = color_matching(FIRST + STEP * i as f64);
        let value = spectrum(i);
        norm += cmf[1];
        for c in 0..3 {
            sum[c] += cmf[c] * value;
        }
    }
    let [x, y, z] = sum.map(|v| v / norm);
    [
        3.240_625_5 * x - 1.537_208_0 * y - 0.498_628_6 * z,
        -0.968_930_7 * x + 1.875_756_1 * y + 0.041_517_5 * z,
        0.055_710_1 * x - 0.204_021_1 * y + 1.056_995_9 * z,
    ]
}

/// The CIE 1931 colour matching functions by the sums of lobes of Wyman, Sloan and Shirley, "Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013, listing 1.
fn color_matching(wavelength: f64) -> [f64; 3] {
    let lobe = |height: f64, middle: f64, below: f64, above: f64| {
        let t = (wavelength - middle) * if wavelength < middle { below } else { above };
        height * exp(-0.5 * t * t)
    };
    [
        lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same spectra under Mitsuba 3's integration, which uses the tabulated matching functions: paints divided by
    /// the (1.2048, 0.9483, 0.9088) of equal energy, which it leaves unbalanced.
    #[test]
    fn paints_agree_with_another_integration() {
        for (spectrum, known) in
            [(&WHITE, [0.7352, 0.7370, 0.7333]), (&RED, [0.4732, 0.0454, 0.0488]), (&GREEN, [0.0875, 0.3986, 0.0841])]
        {
            let ours = reflectance_rgb(spectrum);
            for c in 0..3 {
                assert!((ours[c] - known[c]).abs() < 0.012, "{ours:?} {known:?}");
            }
        }
    }

    /// The lamp is commonly given as (17, 12, 4).
    #[test]
    fn equal_energy_is_white_and_the_lamp_is_warm() {
        assert_eq!(reflectance_rgb(&[1.0; SAMPLES]), [1.0; 3]);
        let lamp = lamp_rgb();
        for (ours, known) in lamp.iter().zip([17.0, 12.0, 4.0]) {
            assert!((ours - known).abs() < 1.0, "{lamp:?}");
        }
    }
}
