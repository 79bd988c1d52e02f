//! The colour pipeline of FLIP: what the eye cannot resolve is filtered away, the rest measured in a uniform space.

use super::Opponent;
use super::filter::{Kernel, convolve};
use crate::colour::{rgb_to_xyz, xyz_to_rgb};
use rayon::prelude::*;

/// Gaussians (height a, width b) whose sum is each opponent channel's contrast sensitivity (table 1 of the paper).
const SENSITIVITY: [&[(f64, f64)]; 3] = [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];
/// Exponent that compresses large colour distances (section 4.1.3).
const QC: f64 = 0.7;
/// Fraction of the largest distance up to which errors are spread over most of the scale.
const PC: f64 = 0.4;
/// The part of the scale that they get.
const PT: f64 = 0.95;

/// YCxCz of a linear RGB colour: CIELab's axes without its cube root.
pub(super) fn rgb_to_opponent(rgb: [f32; 3]) -> [f32; 3] {
    let white = rgb_to_xyz([1.0; 3]);
    let xyz = rgb_to_xyz(rgb.map(f64::from));
    let [x, y, z] = [0, 1, 2].map(|i| xyz[i] / white[i]);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)].map(|c| c as f32)
}

fn opponent_to_rgb(opponent: [f64; 3]) -> [f64; 3] {
    let white = rgb_to_xyz([1.0; 3]);
    let y = (opponent[0] + 16.0) / 116.0;
    let (x, z) = (y + opponent[1] / 500.0, y - opponent[2] / 200.0);
    xyz_to_rgb([x * white[0], y * white[1], z * white[2]])
}

/// CIELab with the chroma adjusted for the Hunt effect (section 4.1.2): a and b scaled by lightness / 100.
fn hunt_lab(rgb: [f64; 3]) -> [f64; 3] {
    let white = rgb_to_xyz([1.0; 3]);
    let xyz = rgb_to_xyz(rgb);
    let [x, y, z] = [0, 1, 2].map(|i| {
        /// Where the cube root gives way to its tangent.
        const DELTA: f64 = 6.0 / 29.0;
        let t = xyz[i] / white[i];
        if t > DELTA * DELTA * DELTA { libm::cbrt(t) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    });
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

/// HyAB distance (section 4.1.2): lightness by itself, chroma as a Euclidean distance.
fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    let (da, db) = (a[1] - b[1], a[2] - b[2]);
    (a[0] - b[0]).abs() + (da * da + db * db).sqrt()
}

/// An image after the contrast sensitivity filters, clipped to displayable colours, in Hunt-adjusted Lab.
fn perceived(image: &Opponent, size: (usize, usize), pixels_per_degree: f64) -> Vec<[f64; 3]> {
    let planes: [Vec<f32>; 3] =
        [0, 1, 2].map(|c| filter_plane(&image.planes[c], size, SENSITIVITY[c], pixels_per_degree));
    (0..planes[0].len())
        .into_par_iter()
        .map(|i| {
            let rgb = opponent_to_rgb([0, 1, 2].map(|c| f64::from(planes[c][i])));
            hunt_lab(rgb.map(|c| c.clamp(0.0, 1.0)))
        })
        .collect()
}

/// A sum of Gaussians, normalised as a whole: each is separable, so the filtered planes are summed.
fn filter_plane(plane: &[f32], size: (usize, usize), gaussians: &[(f64, f64)], pixels_per_degree: f64) -> Vec<f32> {
    use std::f64::consts::PI;
    let widest = SENSITIVITY.iter().flat_map(|g| g.iter()).map(|g| g.1).fold(0.0, f64::max);
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as usize;
    // exp(-pi^2 / b (x^2 + y^2)) with x, y in degrees.
    let profile = |b: f64| {
        move |x: f64| {
            let degrees = x / pixels_per_degree;
            libm::exp(-PI * PI / b * degrees * degrees)
        }
    };
    let sum_1d = |b: f64| -> f64 { (-(radius as i64)..=radius as i64).map(|x| profile(b)(x as f64)).sum() };
    let weight = |a: f64, b: f64| a * (PI / b).sqrt();
    let total: f64 = gaussians.iter().map(|&(a, b)| weight(a, b) * sum_1d(b) * sum_1d(b)).sum();
    let mut result = vec![0.0; plane.len()];
    for &(a, b) in gaussians {
        let horizontal = Kernel::sample(radius, profile(b));
        let vertical = Kernel::sample(radius, profile(b)).scaled(weight(a, b) / total);
        let filtered = convolve(plane, size, &horizontal, &vertical);
        result.par_iter_mut().zip(filtered).for_each(|(sum, part)| *sum += part);
    }
    result
}

/// Colour differences of all pixels, each in 0..1.
pub(super) fn differences(a: &Opponent, b: &Opponent, size: (usize, usize), pixels_per_degree: f64) -> Vec<f32> {
    // The largest distance there is: between green and blue.
    let largest = libm::pow(hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])), QC);
    let a = perceived(a, size, pixels_per_degree);
    let b = perceived(b, size, pixels_per_degree);
    a.par_iter()
        .zip(b)
        .map(|(&a, b)| {
            let distance = libm::pow(hyab(a, b), QC);
            // Section 4.1.3: two straight pieces, the steep one below PC of the largest.
            let knee = PC * largest;
            let error = if distance < knee {
                PT / knee * distance
            } else {
                PT + (distance - knee) / (largest - knee) * (1.0 - PT)
            };
            error.clamp(0.0, 1.0) as f32
        })
        .collect()
}
