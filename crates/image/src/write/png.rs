//! PNG out: 8 bits a channel, tone-mapped and sRGB-encoded.

use super::atomic::write_atomic;
use crate::colour::SrgbCodes;
use crate::error::{ImageError, ImageErrorKind, Result};
use crate::image::{Image, Layers};
use crate::tonemap::Tonemap;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use rayon::prelude::*;
use std::path::Path;

/// Pixels that one task encodes: a handful of microseconds' worth are not worth handing over.
const PIXELS_A_TASK: usize = 4096;

/// Writes a picture as 8-bit sRGB PNG, atomically: exposure in stops (EV), then the tone curve, then the sRGB curve.
pub fn write_png(path: impl AsRef<Path>, image: &Image, tonemap: Tonemap, exposure_ev: f32) -> Result<()> {
    let path = path.as_ref();
    write_atomic(path, &encode_image(image, tonemap, exposure_ev, path)?)
}

/// As [`write_png`], the layer without a name: as a picture where it has one or three channels, else an error.
pub fn write_layers_png(path: impl AsRef<Path>, layers: &Layers, tonemap: Tonemap, exposure_ev: f32) -> Result<()> {
    let path = path.as_ref();
    let Some([red, green, blue]) = layers.rgb_planes("") else {
        return Err(mismatch(path, "there is no layer without a name to show".into()));
    };
    let pixel = |i: usize| [red[i], green[i], blue[i]];
    write_atomic(path, &encode([layers.width, layers.height], pixel, tonemap, exposure_ev, path)?)
}

/// The bytes of that PNG; the same picture gives the same bytes.
pub fn encode_png(image: &Image, tonemap: Tonemap, exposure_ev: f32) -> Result<Vec<u8>> {
    encode_image(image, tonemap, exposure_ev, Path::new("PNG"))
}

/// Writes 8-bit RGB samples as they are (drawings, textures), atomically; row by row, the top row first.
pub fn write_png8(path: impl AsRef<Path>, width: usize, height: usize, samples: &[[u8; 3]]) -> Result<()> {
    let path = path.as_ref();
    write_atomic(path, &encode_rgb8(width, height, samples.as_flattened(), path)?)
}

/// As [`write_png8`], with an alpha channel.
pub fn write_png8_rgba(path: impl AsRef<Path>, width: usize, height: usize, samples: &[[u8; 4]]) -> Result<()> {
    let path = path.as_ref();
    write_atomic(path, &encode8(width, height, samples.as_flattened(), ExtendedColorType::Rgba8, path)?)
}

fn encode_image(image: &Image, tonemap: Tonemap, exposure_ev: f32, path: &Path) -> Result<Vec<u8>> {
    encode([image.width, image.height], |i| image.pixels[i], tonemap, exposure_ev, path)
}

/// The PNG of pixels by their number, row by row.
fn encode(
    [width, height]: [usize; 2],
    pixel: impl Fn(usize) -> [f32; 3] + Sync,
    tonemap: Tonemap,
    exposure_ev: f32,
    path: &Path,
) -> Result<Vec<u8>> {
    let scale = libm::exp2f(exposure_ev);
    let codes = SrgbCodes::new();
    let shown = |i: usize| tonemap.map(pixel(i).map(|c| c * scale)).map(|c| codes.nearest(c));
    let places = (0..width * height).into_par_iter().with_min_len(PIXELS_A_TASK);
    let samples: Vec<[u8; 3]> = places.map(shown).collect();
    encode_rgb8(width, height, samples.as_flattened(), path)
}

fn mismatch(path: &Path, what: String) -> ImageError {
    ImageError::new(ImageErrorKind::Mismatch, path, what, "this is an error of the program that writes the image")
}

fn encode_rgb8(width: usize, height: usize, samples: &[u8], path: &Path) -> Result<Vec<u8>> {
    encode8(width, height, samples, ExtendedColorType::Rgb8, path)
}

fn encode8(width: usize, height: usize, samples: &[u8], color: ExtendedColorType, path: &Path) -> Result<Vec<u8>> {
    let (Ok(columns), Ok(rows)) = (u32::try_from(width), u32::try_from(height)) else {
        return Err(mismatch(path, format!("{width} x {height} pixels are too many for PNG")));
    };
    if samples.len() != width * height * usize::from(color.channel_count()) || samples.is_empty() {
        return Err(mismatch(path, format!("{} samples do not make {width} x {height} pixels", samples.len())));
    }
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive)
        .write_image(samples, columns, rows, color)
        .map_err(|error| mismatch(path, error.to_string()))?;
    Ok(bytes)
}
