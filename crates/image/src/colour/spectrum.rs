//! Spectra given at wavelengths, as linear sRGB.

use super::observer::{D65_FIRST_NM, D65_STEP_NM, D65_TABLE, colour_matching};
use super::xyz::xyz_to_rgb;

/// Shortest and longest wavelength that is integrated, in nm; the observer sees next to nothing outside.
const VISIBLE_NM: std::ops::RangeInclusive<u32> = 360..=830;

/// What a spectrum means, which decides how it is weighted and what counts as 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpectrumKind {
    /// A reflectance, transmittance or albedo, seen under D65: the constant 1 is white (1, 1, 1), results lie in 0..1,
    /// and the first and last values hold beyond the ends of the list.
    Reflectance,
    /// Emitted radiance, not weighted by an illuminant, as Mitsuba 3 reads it: luminance is the integral against the
    /// observer's y curve divided by that curve's own integral; the list is dark beyond its ends. A list of one value
    /// is a grey of that value.
    Emission,
}

/// Why a list is no spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SpectrumError {
    /// The list has no entries.
    #[error("the spectrum is empty")]
    Empty,
    /// Wavelengths are not strictly increasing (counted from 0: the entry that does not exceed the one before).
    #[error("the wavelengths of the spectrum do not increase at entry {0}")]
    NotIncreasing(usize),
    /// A wavelength or a value is NaN or infinite.
    #[error("entry {0} of the spectrum is not a finite number")]
    NotFinite(usize),
}

/// Linear sRGB of a spectrum: pairs of wavelength in nm (strictly increasing) and value, linear between them.
///
/// Integrated in steps of 1 nm against the colour matching functions of the CIE 1931 2-degree observer in the analytic
/// form of Wyman, Sloan and Shirley 2013. Colours outside the gamut are clipped to it channel by channel.
pub fn spectrum_to_rgb(spectrum: &[(f64, f64)], kind: SpectrumKind) -> Result<[f32; 3], SpectrumError> {
    check(spectrum)?;
    let &[first, .., last] = spectrum else {
        return Ok([spectrum[0].1 as f32; 3].map(|c| c.max(0.0)));
    };
    let rgb = match kind {
        SpectrumKind::Reflectance => {
            // Held beyond its ends, the list has a value everywhere.
            let clamped = |nm: f64| interpolate(spectrum, nm.clamp(first.0, last.0));
            let colour = integrate(|nm| d65(nm) * clamped(nm));
            let white = integrate(d65);
            [0, 1, 2].map(|c| (colour[c] / white[c]).clamp(0.0, 1.0))
        }
        SpectrumKind::Emission => {
            let inside = |nm: f64| if nm < first.0 || nm > last.0 { 0.0 } else { interpolate(spectrum, nm) };
            integrate(inside).map(|c| c.max(0.0))
        }
    };
    Ok(rgb.map(|c| c as f32))
}

/// Spectral radiance of a black body in W / (m^2 sr nm): Planck's law at a wavelength in nm and a temperature in K; 0 for
/// temperatures that are not positive.
pub fn blackbody_radiance(nm: f64, kelvin: f64) -> f64 {
    /// Planck constant in J s, speed of light in m/s, Boltzmann constant in J/K: exact in the SI of 2019.
    const H: f64 = 6.626_070_15e-34;
    const C: f64 = 299_792_458.0;
    const K: f64 = 1.380_649e-23;
    if kelvin.is_nan() || kelvin <= 0.0 || nm.is_nan() || nm <= 0.0 {
        return 0.0;
    }
    let lambda = nm * 1e-9;
    let lambda2 = lambda * lambda;
    2.0 * H * C * C / (lambda2 * lambda2 * lambda) / libm::expm1(H * C / (lambda * K * kelvin)) * 1e-9
}

/// Linear sRGB colour of a black body at a temperature in K, scaled to luminance 1; black for temperatures that are not
/// positive or so low that nothing is seen.
pub fn blackbody_to_rgb(kelvin: f64) -> [f32; 3] {
    // Relative to its own brightest visible radiance, so that nothing overflows or underflows.
    let peak = VISIBLE_NM.map(|nm| blackbody_radiance(f64::from(nm), kelvin)).fold(0.0, f64::max);
    if !(peak > 0.0 && peak.is_finite()) {
        return [0.0; 3];
    }
    let rgb = integrate(|nm| blackbody_radiance(nm, kelvin) / peak).map(|c| c.max(0.0));
    let luminance = super::xyz::rgb_to_xyz(rgb)[1];
    rgb.map(|c| (c / luminance) as f32)
}

fn check(spectrum: &[(f64, f64)]) -> Result<(), SpectrumError> {
    if spectrum.is_empty() {
        return Err(SpectrumError::Empty);
    }
    if let Some(bad) = spectrum.iter().position(|(nm, value)| !nm.is_finite() || !value.is_finite()) {
        return Err(SpectrumError::NotFinite(bad));
    }
    match spectrum.windows(2).position(|pair| pair[1].0 <= pair[0].0) {
        Some(before) => Err(SpectrumError::NotIncreasing(before + 1)),
        None => Ok(()),
    }
}

/// The value at a wavelength between the first and the last of the list.
fn interpolate(spectrum: &[(f64, f64)], nm: f64) -> f64 {
    let after = spectrum.partition_point(|entry| entry.0 <= nm).clamp(1, spectrum.len() - 1);
    let ((nm0, value0), (nm1, value1)) = (spectrum[after - 1], spectrum[after]);
    value0 + (value1 - value0) * ((nm - nm0) / (nm1 - nm0))
}

/// Linear sRGB of a spectral function, relative to a luminance of 1 for the constant 1.
fn integrate(value: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut xyz = [0.0; 3];
    let mut luminance_of_one = 0.0;
    for nm in VISIBLE_NM.map(f64::from) {
        let observer = colour_matching(nm);
        let value = value(nm);
        for axis in 0..3 {
            xyz[axis] += observer[axis] * value;
        }
        luminance_of_one += observer[1];
    }
    xyz_to_rgb(xyz.map(|sum| sum / luminance_of_one))
}

/// Relative power of the illuminant D65, linear between the table's entries.
fn d65(nm: f64) -> f64 {
    let at = ((nm - D65_FIRST_NM) / D65_STEP_NM).clamp(0.0, (D65_TABLE.len() - 1) as f64);
    let below = (at as usize).min(D65_TABLE.len() - 2);
    D65_TABLE[below] + (D65_TABLE[below + 1] - D65_TABLE[below]) * (at - below as f64)
}
