//! Textures and the inputs that may be a constant or a texture.

use photinus_geometry::{Affine3A, Vec3};
use std::sync::Arc;

/// Index into [`Scene::textures`](super::Scene::textures).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureId(pub u32);

/// A colour: the same everywhere, or from a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorInput {
    /// Linear RGB.
    Constant(Vec3),
    /// Looked up at the surface's texture coordinates.
    Texture(TextureId),
}

/// A number: the same everywhere, or the luminance (or single channel) of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloatInput {
    /// The number.
    Constant(f32),
    /// Looked up at the surface's texture coordinates.
    Texture(TextureId),
}

/// How a bitmap is read between its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureFilter {
    /// The nearest pixel.
    Nearest,
    /// Weighted mean of four.
    Bilinear,
}

/// What lies outside the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrapMode {
    /// The picture again.
    Repeat,
    /// The picture mirrored.
    Mirror,
    /// The border pixel.
    Clamp,
}

/// Pixels of a picture, already linear, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct Bitmap {
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// `width * height` RGBA values, linear, alpha 1 where the file has none.
    pub pixels: BitmapPixels,
}

/// Storage of a [`Bitmap`].
#[derive(Clone, Debug, PartialEq)]
pub enum BitmapPixels {
    /// 8 bits a channel; `srgb`: RGB is sRGB-encoded and decoded on reading.
    Rgba8 {
        /// Four bytes a pixel.
        data: Vec<[u8; 4]>,
        /// Whether RGB is to be decoded.
        srgb: bool,
    },
    /// Linear floating point.
    RgbaF32(Vec<[f32; 4]>),
}

impl Bitmap {
    /// Whether any pixel is not fully opaque.
    pub fn has_holes(&self) -> bool {
        match &self.pixels {
            BitmapPixels::Rgba8 { data, .. } => data.iter().any(|p| p[3] < 255),
            BitmapPixels::RgbaF32(data) => data.iter().any(|p| p[3] < 1.0),
        }
    }

    /// Bytes of the pixels.
    pub fn bytes(&self) -> usize {
        match &self.pixels {
            BitmapPixels::Rgba8 { data, .. } => data.len() * 4,
            BitmapPixels::RgbaF32(data) => data.len() * 16,
        }
    }
}

/// Where a texture's values come from. Texture coordinates are (u, v) with v up: v = 0 is the bottom row.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureKind {
    /// A picture. Shared: the same file read twice is held once.
    Bitmap {
        /// The pixels.
        bitmap: Arc<Bitmap>,
        /// Interpolation.
        filter: TextureFilter,
        /// Outside the unit square.
        wrap: WrapMode,
        /// Use the alpha channel as the value (opacity read from the mask of a picture).
        alpha: bool,
    },
    /// Squares of half a unit in (u, v), after `to_uv`: `a` on the square at the origin and its diagonal neighbours.
    Checkerboard {
        /// Colour of the squares at the origin.
        a: ColorInput,
        /// Colour of the others.
        b: ColorInput,
    },
    /// Another input times a number.
    Scale {
        /// What is scaled.
        input: ColorInput,
        /// By how much.
        factor: f32,
    },
    /// The mesh's vertex colours; white where there are none.
    VertexColor,
}

/// A texture: its values and how texture coordinates reach them. A texture that another one reads comes before it: no
/// cycles.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// File name or id, for messages.
    pub name: String,
    /// The values.
    pub kind: TextureKind,
    /// Applied to (u, v, 0) before the look-up.
    pub to_uv: Affine3A,
}
