//! Separable convolution with the image's edge pixels repeated outside.

use rayon::prelude::*;

/// A kernel of odd length, centred.
pub(super) struct Kernel {
    taps: Vec<f32>,
}

impl Kernel {
    /// Samples a function at -radius ..= radius.
    pub(super) fn sample(radius: usize, value: impl Fn(f64) -> f64) -> Self {
        let radius = radius as i64;
        Self { taps: (-radius..=radius).map(|x| value(x as f64) as f32).collect() }
    }

    /// Multiplies every tap.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { taps: self.taps.into_iter().map(|tap| (f64::from(tap) * factor) as f32).collect() }
    }

    fn radius(&self) -> usize {
        self.taps.len() / 2
    }
}

/// The plane convolved with `horizontal` along rows and `vertical` along columns. Both kernels are applied as
/// correlations: tap `radius + k` weighs the pixel `k` to the right or below.
pub(super) fn convolve(plane: &[f32], size: (usize, usize), horizontal: &Kernel, vertical: &Kernel) -> Vec<f32> {
    let (width, height) = size;
    let mut rows = vec![0.0; plane.len()];
    rows.par_chunks_mut(width).zip(plane.par_chunks(width)).for_each(|(target, source)| {
        let radius = horizontal.radius();
        let mut padded = vec![source[0]; radius];
        padded.extend_from_slice(source);
        padded.resize(width + 2 * radius, source[width - 1]);
        for (k, tap) in horizontal.taps.iter().enumerate() {
            add_scaled(target, &padded[k..k + width], *tap);
        }
    });
    let mut result = vec![0.0; plane.len()];
    result.par_chunks_mut(width).enumerate().for_each(|(y, target)| {
        for (k, tap) in vertical.taps.iter().enumerate() {
            let from = (y + k).saturating_sub(vertical.radius()).min(height - 1);
            add_scaled(target, &rows[from * width..(from + 1) * width], *tap);
        }
    });
    result
}

fn add_scaled(target: &mut [f32], source: &[f32], factor: f32) {
    for (t, s) in target.iter_mut().zip(source) {
        *t += factor * s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition, pixel by pixel.
    fn brute_force(plane: &[f32], (width, height): (usize, usize), horizontal: &Kernel, vertical: &Kernel) -> Vec<f32> {
        let at = |x: i64, y: i64| {
            plane[y.clamp(0, height as i64 - 1) as usize * width + x.clamp(0, width as i64 - 1) as usize]
        };
        let (rx, ry) = (horizontal.radius() as i64, vertical.radius() as i64);
        let mut result = Vec::new();
        for y in 0..height as i64 {
            for x in 0..width as i64 {
                let mut sum = 0.0;
                for (j, v) in (-ry..=ry).zip(&vertical.taps) {
                    for (i, h) in (-rx..=rx).zip(&horizontal.taps) {
                        sum += f64::from(*v) * f64::from(*h) * f64::from(at(x + i, y + j));
                    }
                }
                result.push(sum as f32);
            }
        }
        result
    }

    #[test]
    fn separable_convolution_matches_the_definition() {
        // Unsymmetric kernels, images smaller and larger than they are.
        let horizontal = Kernel::sample(3, |x| 0.3 + 0.1 * x);
        let vertical = Kernel::sample(2, |x| 1.0 - 0.2 * x * x + 0.05 * x);
        for size in [(1, 1), (2, 5), (9, 4), (17, 13)] {
            let plane: Vec<f32> = (0..size.0 * size.1).map(|i| ((i * 37) % 101) as f32 * 0.01).collect();
            let expected = brute_force(&plane, size, &horizontal, &vertical);
            let found = convolve(&plane, size, &horizontal, &vertical);
            for (f, e) in found.iter().zip(&expected) {
                assert!((f - e).abs() < 1e-5, "{size:?}: {f} is not {e}");
            }
        }
    }
}
