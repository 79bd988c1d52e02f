//! Comparing a picture with its reference.

use crate::Result;
pub use photinus_image::metrics::Comparison;
use std::path::Path;

/// Compares the pictures in two files; with a mask only its white pixels count. Pixels that are not finite are clamped
/// and counted.
///
/// # Errors
/// [`crate::Error::Image`] where a file cannot be read or the sizes differ.
pub fn compare(a: &Path, reference: &Path, mask: Option<&Path>) -> Result<Comparison> {
    Ok(photinus_image::metrics::compare_files(a, reference, mask)?)
}
