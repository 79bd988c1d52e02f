//! `relmse`: relative mean squared error, whole and trimmed of its fireflies.

use super::pixels::{Pair, mean};
use crate::error::Result;
use crate::image::Image;
use std::path::Path;

/// Keeps the error of black reference pixels finite.
const EPSILON: f64 = 0.01;

/// One pixel in so many is dropped from the trimmed mean (0.1 %, rounded down).
const TRIMMED_ONE_IN: usize = 1000;

/// relMSE of `a` against the reference `b`: the mean over pixels of
/// mean over channels of (a - b)^2 / (mean over channels of b^2 + 0.01).
pub fn relmse(a: &Image, b: &Image, mask: Option<&Image>) -> Result<f64> {
    Ok(mean(&errors(&Pair::new(a, b, mask, Path::new("relmse"))?)))
}

/// [`relmse`] without the worst 0.1 % of the counted pixels (rounded down to whole pixels).
pub fn relmse_trimmed(a: &Image, b: &Image, mask: Option<&Image>) -> Result<f64> {
    Ok(trimmed_mean(errors(&Pair::new(a, b, mask, Path::new("relmse"))?)))
}

/// The error of every counted pixel.
pub(super) fn errors(pair: &Pair) -> Vec<f64> {
    let pixel = |&i: &usize| {
        let (a, b) = (pair.a[i].map(f64::from), pair.b[i].map(f64::from));
        let squared_error: f64 = (0..3).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum();
        let squared_reference: f64 = (0..3).map(|c| b[c] * b[c]).sum();
        (squared_error / 3.0) / (squared_reference / 3.0 + EPSILON)
    };
    pair.counted.iter().map(pixel).collect()
}

/// Mean of all but the largest errors.
pub(super) fn trimmed_mean(mut errors: Vec<f64>) -> f64 {
    errors.sort_by(f64::total_cmp);
    mean(&errors[..errors.len() - errors.len() / TRIMMED_ONE_IN])
}
