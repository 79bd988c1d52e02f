//! Which format some bytes are, by their content.

use crate::error::{ImageError, Result};
use image::ImageFormat;
use std::path::Path;

/// A format that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// OpenEXR.
    Exr,
    /// Anything that the `image` crate decodes for us.
    Raster(ImageFormat),
}

/// First bytes of the formats that can be read; TGA has none.
const READABLE: &[(&[u8], Format)] = &[
    (&[0x76, 0x2f, 0x31, 0x01], Format::Exr),
    (b"\x89PNG\r\n\x1a\n", Format::Raster(ImageFormat::Png)),
    (&[0xff, 0xd8, 0xff], Format::Raster(ImageFormat::Jpeg)),
    (b"#?RADIANCE", Format::Raster(ImageFormat::Hdr)),
    (b"#?RGBE", Format::Raster(ImageFormat::Hdr)),
    (b"BM", Format::Raster(ImageFormat::Bmp)),
];

/// First bytes of well-known formats that are refused by name.
const REFUSED: &[(&[u8], &str)] = &[
    (b"GIF8", "GIF"),
    (b"II*\0", "TIFF"),
    (b"MM\0*", "TIFF"),
    (b"RIFF", "WebP or another RIFF file"),
    (b"DDS ", "DDS"),
    (b"\xabKTX", "KTX"),
    (b"PF\n", "PFM"),
    (b"Pf\n", "PFM"),
    (b"P5", "PGM"),
    (b"P6", "PPM"),
    (b"8BPS", "Photoshop"),
    (b"qoif", "QOI"),
    (b"\0\0\0\x0cjP", "JPEG 2000"),
    (b"<svg", "SVG"),
    (b"<?xml", "XML"),
];

/// Ending of TGA files of version 2.
const TGA_FOOTER: &[u8] = b"TRUEVISION-XFILE.\0";

/// Recognises the format, or says by name what cannot be read.
pub(super) fn recognise(bytes: &[u8], path: &Path) -> Result<Format> {
    if let Some((_, format)) = READABLE.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Ok(*format);
    }
    let accepted = "convert it to EXR, PNG, JPEG, HDR, BMP or TGA";
    if bytes.is_empty() {
        return Err(ImageError::malformed(path, "the file is empty"));
    }
    if let Some((_, name)) = REFUSED.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Err(ImageError::unsupported(path, format!("{name} images are not read"), accepted));
    }
    if bytes.get(1..4) == Some(b"PNG") {
        return Err(ImageError::malformed(path, "the PNG signature is damaged (often by a transfer as text)"));
    }
    let named_tga = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("tga"));
    if bytes.ends_with(TGA_FOOTER) || (named_tga && is_tga_header(bytes)) {
        return Ok(Format::Raster(ImageFormat::Tga));
    }
    Err(ImageError::unsupported(path, "this is no image format that is read here", accepted))
}

/// Whether a TGA header could start like this: a known image type, colour map flag and depth.
fn is_tga_header(bytes: &[u8]) -> bool {
    bytes.len() > 18
        && bytes[1] <= 1
        && matches!(bytes[2], 1 | 2 | 3 | 9 | 10 | 11)
        && matches!(bytes[16], 8 | 15 | 16 | 24 | 32)
}
