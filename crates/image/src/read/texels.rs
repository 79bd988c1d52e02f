//! A decoded texture: samples as stored, always four to a pixel.

use crate::colour::srgb_to_linear;
use crate::image::Image;

/// Samples of a texture, RGBA, the top row first; images without alpha have it opaque, grey has three equal channels.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// 8-bit samples as stored (usually sRGB-encoded).
    Rgba8(Vec<[u8; 4]>),
    /// 16-bit samples as stored (usually sRGB-encoded).
    Rgba16(Vec<[u16; 4]>),
    /// Linear floating-point samples (EXR, HDR).
    RgbaF32(Vec<[f32; 4]>),
}

/// A texture as stored in its file.
#[derive(Clone, Debug, PartialEq)]
pub struct DecodedImage {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Whether the file has an alpha channel.
    pub has_alpha: bool,
    /// Whether the file has only one colour channel.
    pub is_grey: bool,
    /// `width * height` pixels.
    pub texels: Texels,
}

impl DecodedImage {
    /// The picture in linear RGB: integer samples are taken as sRGB, alpha is dropped.
    pub fn into_linear_image(self) -> Image {
        let pixels = match self.texels {
            Texels::Rgba8(texels) => {
                let table: Vec<f32> = (0..=255u16).map(|code| srgb_to_linear(f32::from(code) / 255.0)).collect();
                texels.iter().map(|t| [0, 1, 2].map(|c| table[usize::from(t[c])])).collect()
            }
            Texels::Rgba16(texels) => {
                texels.iter().map(|t| [0, 1, 2].map(|c| srgb_to_linear(f32::from(t[c]) / 65535.0))).collect()
            }
            Texels::RgbaF32(texels) => texels.iter().map(|t| [t[0], t[1], t[2]]).collect(),
        };
        Image { width: self.width, height: self.height, pixels }
    }
}
