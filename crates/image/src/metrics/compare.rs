//! All metrics of two images at once: what `photinus compare` prints.

use super::pixels::{Pair, mean};
use super::{flip, psnr, relmse};
use crate::error::Result;
use crate::image::Image;
use crate::read::read_image;
use std::path::Path;

/// How image A differs from its reference B; every number is over the counted pixels only.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Comparison {
    /// Mean of the pixels' relative squared errors.
    pub relmse: f64,
    /// The same without the worst 0.1 % of the pixels.
    pub relmse_trimmed: f64,
    /// Peak signal-to-noise ratio in dB of the sRGB-encoded images, clipped to 0..1; at most 200 (equal images).
    pub psnr: f64,
    /// Mean LDR-FLIP of the images clipped to 0..1, at 67 pixels per degree: 0 (equal) to 1.
    pub flip: f64,
    /// Mean over pixels and channels of A.
    pub mean_a: f64,
    /// Mean over pixels and channels of B.
    pub mean_b: f64,
    /// Pixels with a channel in A or B that is not finite; NaN was taken as 0, infinities as +-65504.
    pub nonfinite: u64,
}

/// Compares `a` with the reference `b`; with a mask of the same size only its white pixels count (those whose sRGB code
/// is at least half). Errors: sizes that differ, a mask that counts nothing.
pub fn compare(a: &Image, b: &Image, mask: Option<&Image>) -> Result<Comparison> {
    compare_named(a, b, mask, Path::new("compare"))
}

/// [`compare`] for files; a size that does not fit is reported at the file that has it.
pub fn compare_files(a: impl AsRef<Path>, b: impl AsRef<Path>, mask: Option<&Path>) -> Result<Comparison> {
    let image_a = read_image(&a)?;
    let image_b = read_image(&b)?;
    let mask = mask.map(read_image).transpose()?;
    compare_named(&image_a, &image_b, mask.as_ref(), a.as_ref())
}

fn compare_named(a: &Image, b: &Image, mask: Option<&Image>, name: &Path) -> Result<Comparison> {
    let pair = Pair::new(a, b, mask, name)?;
    let errors = relmse::errors(&pair);
    Ok(Comparison {
        relmse: mean(&errors),
        relmse_trimmed: relmse::trimmed_mean(errors),
        psnr: psnr::of_pair(&pair),
        flip: flip::mean_of_pair(&pair),
        mean_a: pair.mean_of(&pair.a),
        mean_b: pair.mean_of(&pair.b),
        nonfinite: pair.nonfinite,
    })
}
