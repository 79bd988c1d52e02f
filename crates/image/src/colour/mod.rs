//! Colour: the sRGB curve, luminance, spectra and black bodies.

mod srgb;

pub use srgb::{linear_to_srgb, luminance, srgb_to_linear};
