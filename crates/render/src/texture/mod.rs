//! Textures: prepared look-ups of the colours and numbers that materials and lights take from pictures.

mod bitmap;
mod checkerboard;
mod srgb;
mod textures;

pub use bitmap::MipMap;
pub use srgb::{linear_to_srgb8, srgb8_to_linear, unit8_to_linear};
pub use textures::{TextureLookup, Textures};

/// Rec. 709 luminance of a linear RGB colour.
#[inline]
pub fn luminance(c: photinus_geometry::Vec3) -> f32 {
    0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z
}
