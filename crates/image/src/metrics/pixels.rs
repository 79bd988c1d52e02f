//! Two images made comparable: one size, finite, with the list of pixels that count.

use crate::colour::{luminance, srgb_to_linear};
use crate::error::{ImageError, ImageErrorKind, Result};
use crate::image::Image;
use std::path::Path;

/// What an infinite channel counts as: the largest half-precision number.
const INFINITE_AS: f32 = 65504.0;

/// Two images of one size without NaN and infinities.
pub(super) struct Pair {
    pub width: usize,
    pub height: usize,
    pub a: Vec<[f32; 3]>,
    pub b: Vec<[f32; 3]>,
    /// Indices of the pixels that count, increasing; never empty.
    pub counted: Vec<usize>,
    /// Counted pixels that had a channel that is not finite, in `a` or `b`.
    pub nonfinite: u64,
}

impl Pair {
    pub(super) fn new(a: &Image, b: &Image, mask: Option<&Image>, name: &Path) -> Result<Self> {
        let mismatch = |what: String, remedy: &str| ImageError::new(ImageErrorKind::Mismatch, name, what, remedy);
        for (what, image) in [("image", a), ("reference", b)] {
            if image.pixels.len() != image.width * image.height {
                let (found, width, height) = (image.pixels.len(), image.width, image.height);
                return Err(mismatch(
                    format!("the {what} has {found} pixels for {width} x {height}"),
                    "this is an error of the program that compares",
                ));
            }
        }
        let size_check = |what: &str, other: &Image| {
            if (other.width, other.height) == (a.width, a.height) && other.pixels.len() == a.pixels.len() {
                return Ok(());
            }
            let (w, h) = (other.width, other.height);
            Err(mismatch(
                format!("the image has {} x {} pixels and the {what} {w} x {h}", a.width, a.height),
                "compare images of one size",
            ))
        };
        size_check("reference", b)?;
        let counted: Vec<usize> = match mask {
            None => (0..a.pixels.len()).collect(),
            Some(mask) => {
                size_check("mask", mask)?;
                let half = srgb_to_linear(0.5);
                (0..a.pixels.len()).filter(|&i| luminance(mask.pixels[i]) >= half).collect()
            }
        };
        if counted.is_empty() {
            return Err(mismatch("no pixel counts".to_string(), "give images with pixels and a mask with white ones"));
        }
        let is_finite = |pixel: &[f32; 3]| pixel.iter().all(|c| c.is_finite());
        let nonfinite = counted.iter().filter(|&&i| !is_finite(&a.pixels[i]) || !is_finite(&b.pixels[i])).count();
        Ok(Self {
            width: a.width,
            height: a.height,
            a: a.pixels.iter().map(|p| p.map(finite)).collect(),
            b: b.pixels.iter().map(|p| p.map(finite)).collect(),
            counted,
            nonfinite: nonfinite as u64,
        })
    }

    /// Mean over counted pixels and channels of one of the two.
    pub(super) fn mean_of(&self, pixels: &[[f32; 3]]) -> f64 {
        let sum: f64 = self.counted.iter().map(|&i| pixels[i].iter().map(|c| f64::from(*c)).sum::<f64>()).sum();
        sum / (3 * self.counted.len()) as f64
    }
}

/// NaN as 0, infinities as the largest half.
fn finite(c: f32) -> f32 {
    if c.is_nan() {
        0.0
    } else if c.is_infinite() {
        INFINITE_AS.copysign(c)
    } else {
        c
    }
}

/// Mean of a list that is not empty, summed in its order.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
