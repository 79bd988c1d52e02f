//! Bounds that are checked before anything is allocated for a file's pixels.

use crate::error::{ImageError, ImageErrorKind, Result};
use std::path::Path;

/// How large an image may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Most pixels of one image.
    pub pixels: u64,
    /// Most bytes of decoded samples, and of the file itself.
    pub bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { pixels: 1 << 28, bytes: 4 << 30 }
    }
}

/// Decoded bytes that are believed whatever the length of the file.
const BELIEVED_BYTES: u64 = 256 << 20;
/// Decoded bytes believed for each byte of file beyond that: deflate, the densest codec here, cannot exceed 1032 : 1.
const BELIEVED_RATIO: u64 = 2048;

impl Limits {
    /// Checks a declared size against the limits and against the length of the file that declares it.
    pub(crate) fn check(
        &self,
        path: &Path,
        width: u64,
        height: u64,
        bytes_per_pixel: u64,
        file_bytes: usize,
    ) -> Result<()> {
        let too_large = |what: String| {
            ImageError::new(ImageErrorKind::TooLarge, path, what, "use a smaller image or check that the file is whole")
        };
        if width == 0 || height == 0 {
            return Err(ImageError::malformed(path, format!("the image is empty ({width} x {height} pixels)")));
        }
        let pixels = width.saturating_mul(height);
        if pixels > self.pixels {
            return Err(too_large(format!(
                "the image declares {width} x {height} pixels, more than the limit of {}",
                self.pixels
            )));
        }
        let bytes = pixels.saturating_mul(bytes_per_pixel);
        let believed = BELIEVED_BYTES.saturating_add(BELIEVED_RATIO.saturating_mul(file_bytes as u64));
        if bytes > self.bytes.min(believed) {
            return Err(too_large(format!(
                "the image declares {bytes} bytes of samples, more than {} bytes of file can hold or than the limit of {}",
                file_bytes, self.bytes
            )));
        }
        Ok(())
    }
}
