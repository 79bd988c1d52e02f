//! The feature pipeline of FLIP: edges and points that are in one image only (section 4.2).

use super::filter::{Kernel, convolve};
use rayon::prelude::*;

/// Width of the features that the eye detects, in degrees.
const FEATURE_WIDTH: f64 = 0.082;

/// The two parts of a detector's answer: along x and along y.
struct Detected {
    x: Vec<f32>,
    y: Vec<f32>,
}

impl Detected {
    fn strength(&self, i: usize) -> f32 {
        (self.x[i] * self.x[i] + self.y[i] * self.y[i]).sqrt()
    }
}

/// Feature differences of all pixels, each in 0..1, from the two images' Y planes of YCxCz.
pub(super) fn differences(a: &[f32], b: &[f32], size: (usize, usize), pixels_per_degree: f64) -> Vec<f32> {
    let detectors = Detectors::new(pixels_per_degree);
    let (a, b) = (normalised(a), normalised(b));
    let [edge_a, point_a] = detectors.detect(&a, size);
    let [edge_b, point_b] = detectors.detect(&b, size);
    (0..a.len())
        .into_par_iter()
        .map(|i| {
            let edge = (edge_a.strength(i) - edge_b.strength(i)).abs();
            let point = (point_a.strength(i) - point_b.strength(i)).abs();
            // The exponent of the paper, 0.5, is a square root.
            (edge.max(point) * std::f32::consts::FRAC_1_SQRT_2).sqrt().clamp(0.0, 1.0)
        })
        .collect()
}

/// Y of YCxCz brought to 0..1.
fn normalised(plane: &[f32]) -> Vec<f32> {
    plane.par_iter().map(|y| (y + 16.0) / 116.0).collect()
}

/// First and second derivatives of a Gaussian along one axis, and the Gaussian itself for the other.
struct Detectors {
    edge: Kernel,
    point: Kernel,
    smooth: Kernel,
}

impl Detectors {
    fn new(pixels_per_degree: f64) -> Self {
        let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as usize;
        let gauss = move |x: f64| libm::exp(-x * x / (2.0 * deviation * deviation));
        let taps = || (-(radius as i64)..=radius as i64).map(|x| x as f64);
        let smooth_sum: f64 = taps().map(gauss).sum();
        // Positive weights sum to 1 and negative ones to -1; over the other axis the Gaussian sums to 1.
        let balanced = |f: &dyn Fn(f64) -> f64| {
            let positive: f64 = taps().map(f).filter(|v| *v > 0.0).sum();
            let negative: f64 = -taps().map(f).filter(|v| *v < 0.0).sum::<f64>();
            Kernel::sample(radius, |x| if f(x) > 0.0 { f(x) / positive } else { f(x) / negative })
        };
        Self {
            edge: balanced(&|x| -x * gauss(x)),
            point: balanced(&|x| (x * x / (deviation * deviation) - 1.0) * gauss(x)),
            smooth: Kernel::sample(radius, gauss).scaled(1.0 / smooth_sum),
        }
    }

    /// Edges and points of a plane.
    fn detect(&self, plane: &[f32], size: (usize, usize)) -> [Detected; 2] {
        [&self.edge, &self.point].map(|kernel| Detected {
            x: convolve(plane, size, kernel, &self.smooth),
            y: convolve(plane, size, &self.smooth, kernel),
        })
    }
}
