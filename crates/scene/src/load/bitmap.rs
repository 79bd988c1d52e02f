//! Pictures for textures and environments.

use super::{Context, LoadError, Place};
use crate::{Bitmap, BitmapPixels};
use photinus_geometry::Vec3;
use photinus_image::colour::{linear_to_srgb, srgb_to_linear};
use photinus_image::{DecodedImage, Texels, decode_bytes};
use std::path::Path;
use std::sync::Arc;

/// How the numbers of a picture file are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BitmapEncoding {
    /// As the format says: 8- and 16-bit pictures are sRGB, floating-point ones linear.
    Auto,
    /// Linear: data such as normals, heights and roughness.
    Raw,
    /// sRGB.
    Srgb,
}

/// The largest finite half: what stands for infinite radiance.
const LARGEST: f32 = 65504.0;

/// Reads the picture at `path` (from [`Context::resolve`]); `place` is who asked for it. Held once per file and
/// encoding.
///
/// Values that are not finite are replaced, with a warning: NaN by 0, infinity by 65504. Negative values are kept in
/// [`BitmapEncoding::Raw`] pictures and become 0 in others.
///
/// # Errors
/// [`LoadError`] where the file is missing, damaged or too large; importers turn it into a warning and mid-grey.
pub fn load_bitmap(
    place: &Place,
    path: &Path,
    encoding: BitmapEncoding,
    context: &mut Context<'_>,
) -> Result<Arc<Bitmap>, LoadError> {
    let key = (path.to_path_buf(), encoding);
    if let Some(bitmap) = context.bitmaps.get(&key) {
        return Ok(bitmap.clone());
    }
    let bytes = context.read(place, path)?;
    let decoded = decode_bytes(&bytes, path).map_err(|e| LoadError::invalid(place.clone(), e.to_string()))?;
    let (bitmap, replaced) = to_bitmap(decoded, encoding);
    if replaced > 0 {
        context.warn(&Place::file(path), format!("{replaced} value(s) not finite: read as 0 or {LARGEST}"));
    }
    let bitmap = Arc::new(bitmap);
    context.bitmaps.insert(key, bitmap.clone());
    Ok(bitmap)
}

/// One pixel of mid-grey: what stands for a missing picture.
pub fn grey_pixel() -> Arc<Bitmap> {
    Arc::new(Bitmap { width: 1, height: 1, pixels: BitmapPixels::RgbaF32(vec![[0.5, 0.5, 0.5, 1.0]]) })
}

/// The picture with its colours multiplied by `tint`; alpha stays.
pub fn tinted(bitmap: &Arc<Bitmap>, tint: Vec3) -> Arc<Bitmap> {
    if tint == Vec3::ONE {
        return bitmap.clone();
    }
    let bright = tint.max_element() > 1.0;
    let pixels = match &bitmap.pixels {
        BitmapPixels::Rgba8 { data, srgb } if !bright => {
            let tables: Vec<[u8; 256]> = (0..3).map(|k| tint_codes(tint[k], *srgb)).collect();
            let tint_pixel =
                |p: &[u8; 4]| [tables[0][p[0] as usize], tables[1][p[1] as usize], tables[2][p[2] as usize], p[3]];
            BitmapPixels::Rgba8 { data: data.iter().map(tint_pixel).collect(), srgb: *srgb }
        }
        BitmapPixels::Rgba8 { data, srgb } => {
            let decode = |code: u8| {
                let value = f32::from(code) / 255.0;
                if *srgb { srgb_to_linear(value) } else { value }
            };
            let table: Vec<f32> = (0..=255).map(decode).collect();
            let tint_pixel = |p: &[u8; 4]| {
                let [r, g, b] = [0, 1, 2].map(|k| table[p[k] as usize] * tint[k]);
                [r, g, b, f32::from(p[3]) / 255.0]
            };
            BitmapPixels::RgbaF32(data.iter().map(tint_pixel).collect())
        }
        BitmapPixels::RgbaF32(data) => {
            BitmapPixels::RgbaF32(data.iter().map(|p| [p[0] * tint.x, p[1] * tint.y, p[2] * tint.z, p[3]]).collect())
        }
    };
    Arc::new(Bitmap { width: bitmap.width, height: bitmap.height, pixels })
}

/// For every 8-bit code that of its value times `factor` (at most 1).
fn tint_codes(factor: f32, srgb: bool) -> [u8; 256] {
    std::array::from_fn(|code| {
        let value = code as f32 / 255.0;
        let value = if srgb { linear_to_srgb(srgb_to_linear(value) * factor) } else { value * factor };
        (value * 255.0 + 0.5) as u8
    })
}

/// The decoded file as a bitmap, and how many of its values were not finite.
fn to_bitmap(decoded: DecodedImage, encoding: BitmapEncoding) -> (Bitmap, u64) {
    let mut replaced = 0;
    let pixels = match decoded.texels {
        Texels::Rgba8(data) => BitmapPixels::Rgba8 { data, srgb: encoding != BitmapEncoding::Raw },
        Texels::Rgba16(data) => {
            let linear = |x: u16| {
                let value = f32::from(x) / 65535.0;
                if encoding == BitmapEncoding::Raw { value } else { srgb_to_linear(value) }
            };
            let pixel = |p: [u16; 4]| [linear(p[0]), linear(p[1]), linear(p[2]), f32::from(p[3]) / 65535.0];
            BitmapPixels::RgbaF32(data.into_iter().map(pixel).collect())
        }
        Texels::RgbaF32(mut data) => {
            for value in data.iter_mut().flatten() {
                if !value.is_finite() {
                    replaced += 1;
                    *value = if value.is_nan() { 0.0 } else { LARGEST.copysign(*value) };
                }
                if encoding != BitmapEncoding::Raw {
                    *value = value.max(0.0);
                }
            }
            if encoding == BitmapEncoding::Srgb {
                data.iter_mut().for_each(|p| p[..3].iter_mut().for_each(|x| *x = srgb_to_linear(*x)));
            }
            BitmapPixels::RgbaF32(data)
        }
    };
    (Bitmap { width: decoded.width as u32, height: decoded.height as u32, pixels }, replaced)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(texels: Texels) -> DecodedImage {
        DecodedImage { width: 1, height: 1, has_alpha: true, is_grey: false, texels }
    }

    #[test]
    fn encodings_of_each_storage() {
        use BitmapEncoding::{Auto, Raw, Srgb};
        for (encoding, srgb) in [(Auto, true), (Raw, false), (Srgb, true)] {
            let (bitmap, _) = to_bitmap(decoded(Texels::Rgba8(vec![[1, 2, 3, 4]])), encoding);
            assert_eq!(bitmap.pixels, BitmapPixels::Rgba8 { data: vec![[1, 2, 3, 4]], srgb });
            let (bitmap, _) = to_bitmap(decoded(Texels::Rgba16(vec![[65535, 32768, 0, 65535]])), encoding);
            let half = if srgb { srgb_to_linear(32768.0 / 65535.0) } else { 32768.0 / 65535.0 };
            assert_eq!(bitmap.pixels, BitmapPixels::RgbaF32(vec![[1.0, half, 0.0, 1.0]]));
        }
        let wild = || decoded(Texels::RgbaF32(vec![[f32::NAN, f32::INFINITY, -1.0, 1.0]]));
        let (bitmap, replaced) = to_bitmap(wild(), Auto);
        assert_eq!((bitmap.pixels, replaced), (BitmapPixels::RgbaF32(vec![[0.0, LARGEST, 0.0, 1.0]]), 2));
        let (bitmap, _) = to_bitmap(wild(), Raw);
        assert_eq!(bitmap.pixels, BitmapPixels::RgbaF32(vec![[0.0, LARGEST, -1.0, 1.0]]));
    }

    #[test]
    fn tints_multiply_linear_values() {
        let data = (0..=255).map(|c| [c, c, c, 77]).collect::<Vec<[u8; 4]>>();
        let bitmap = Arc::new(Bitmap { width: 256, height: 1, pixels: BitmapPixels::Rgba8 { data, srgb: true } });
        assert!(Arc::ptr_eq(&tinted(&bitmap, Vec3::ONE), &bitmap));
        let BitmapPixels::Rgba8 { data, srgb: true } = &tinted(&bitmap, Vec3::new(0.5, 1.0, 0.0)).pixels else {
            panic!("stays 8 bits")
        };
        for (code, p) in data.iter().enumerate() {
            let expected = 0.5 * srgb_to_linear(code as f32 / 255.0);
            assert!((srgb_to_linear(f32::from(p[0]) / 255.0) - expected).abs() < 0.005);
            assert_eq!((p[1], p[2], p[3]), (code as u8, 0, 77));
        }
        let BitmapPixels::RgbaF32(data) = &tinted(&bitmap, Vec3::splat(2.0)).pixels else { panic!("needs floats") };
        assert_eq!(data[255][0], 2.0);
    }
}
