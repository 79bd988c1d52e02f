//! `psnr`: peak signal-to-noise ratio of what a screen would show.

use super::pixels::Pair;
use crate::colour::linear_to_srgb;
use crate::error::Result;
use crate::image::Image;
use std::path::Path;

/// Mean squared errors below this count as this: equal images have 200 dB, a number that JSON can hold.
const SMALLEST_ERROR: f64 = 1e-20;

/// PSNR in dB of `a` against `b`, both sRGB-encoded and clipped to 0..1 (peak 1), over pixels and channels; at most 200.
pub fn psnr(a: &Image, b: &Image, mask: Option<&Image>) -> Result<f64> {
    Ok(of_pair(&Pair::new(a, b, mask, Path::new("psnr"))?))
}

pub(super) fn of_pair(pair: &Pair) -> f64 {
    let shown = |c: f32| f64::from(linear_to_srgb(c.clamp(0.0, 1.0)));
    let squared_error = |&i: &usize| -> f64 {
        (0..3)
            .map(|c| {
                let difference = shown(pair.a[i][c]) - shown(pair.b[i][c]);
                difference * difference
            })
            .sum()
    };
    let sum: f64 = pair.counted.iter().map(squared_error).sum();
    -10.0 * libm::log10((sum / (3 * pair.counted.len()) as f64).max(SMALLEST_ERROR))
}
