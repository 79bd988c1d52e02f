//! The CIE 1931 2-degree observer and the illuminant D65.

/// x, y and z of the colour matching functions at a wavelength in nm: sums of Gaussians with a width on either side,
/// from Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions" (JCGT
/// 2(2)), listing 1 (multi-lobe fit).
pub(super) fn colour_matching(nm: f64) -> [f64; 3] {
    let lobe = |height: f64, centre: f64, inv_below: f64, inv_above: f64| {
        let t = (nm - centre) * if nm < centre { inv_below } else { inv_above };
        height * libm::exp(-0.5 * t * t)
    };
    [
        lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    ]
}

/// Wavelength of the first entry of [`D65_TABLE`], in nm.
pub(super) const D65_FIRST_NM: f64 = 360.0;
/// Distance of its entries, in nm.
pub(super) const D65_STEP_NM: f64 = 10.0;
/// Relative spectral power of the illuminant D65, 100 at 560 nm: ISO 11664-2 (CIE 15:2004, table T.1), 360 to 830 nm.
pub(super) const D65_TABLE: [f64; 48] = [
    46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861,
    115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856,
    90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490,
    61.6040, 69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828, 64.3040, 59.4519, 51.9590, 57.4406, 60.3125,
];
