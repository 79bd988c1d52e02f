//! PNG, JPEG, HDR, BMP and TGA through the `image` crate.

use super::texels::{DecodedImage, Texels};
use crate::error::{ImageError, Result};
use crate::limits::Limits;
use image::error::{ImageError as CodecError, LimitErrorKind};
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader};
use std::io::Cursor;
use std::path::Path;

/// Decodes one image of the given format.
pub(super) fn read(bytes: &[u8], path: &Path, format: ImageFormat, limits: Limits) -> Result<DecodedImage> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut codec_limits = image::Limits::default();
    codec_limits.max_alloc = Some(limits.bytes);
    reader.limits(codec_limits);
    let decoder = reader.into_decoder().map_err(|error| codec_error(path, format, &error))?;

    let (width, height) = decoder.dimensions();
    let colour = decoder.color_type();
    // Samples are widened to RGBA, so that is what must fit.
    let bytes_per_pixel = 4 * u64::from(colour.bytes_per_pixel()).div_ceil(u64::from(colour.channel_count()));
    limits.check(path, u64::from(width), u64::from(height), bytes_per_pixel, bytes.len())?;
    let picture = DynamicImage::from_decoder(decoder).map_err(|error| codec_error(path, format, &error))?;

    let is_grey = matches!(colour, ColorType::L8 | ColorType::La8 | ColorType::L16 | ColorType::La16);
    Ok(DecodedImage {
        width: width as usize,
        height: height as usize,
        has_alpha: colour.has_alpha(),
        is_grey,
        texels: texels(picture),
    })
}

fn texels(picture: DynamicImage) -> Texels {
    match picture {
        DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_) => Texels::Rgba16(quads(picture.into_rgba16().into_raw())),
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            Texels::RgbaF32(quads(picture.into_rgba32f().into_raw()))
        }
        _ => Texels::Rgba8(quads(picture.into_rgba8().into_raw())),
    }
}

fn quads<T: Copy>(samples: Vec<T>) -> Vec<[T; 4]> {
    samples.chunks_exact(4).map(|s| [s[0], s[1], s[2], s[3]]).collect()
}

fn codec_error(path: &Path, format: ImageFormat, error: &CodecError) -> ImageError {
    let name = format.extensions_str().first().copied().unwrap_or("image").to_uppercase();
    match error {
        CodecError::Unsupported(_) => ImageError::unsupported(
            path,
            format!("this kind of {name} is not read ({error})"),
            "save the image as 8- or 16-bit PNG",
        ),
        CodecError::Limits(limit) if !matches!(limit.kind(), LimitErrorKind::Unsupported { .. }) => ImageError::new(
            crate::error::ImageErrorKind::TooLarge,
            path,
            format!("the image is too large ({error})"),
            "use a smaller image",
        ),
        _ => ImageError::malformed(path, format!("the {name} data are damaged ({})", reason(error))),
    }
}

/// What the decoder says at the bottom of its chain of errors, in one line and without dumps of its own structures.
fn reason(error: &CodecError) -> String {
    let mut deepest: &dyn std::error::Error = error;
    while let Some(source) = deepest.source() {
        deepest = source;
    }
    let mut message = deepest.to_string();
    while let (Some(open), Some(close)) = (message.find('{'), message.rfind('}'))
        && open < close
    {
        message.replace_range(open..=close, "");
    }
    message.split_whitespace().collect::<Vec<_>>().join(" ").trim_end_matches('.').to_owned()
}
