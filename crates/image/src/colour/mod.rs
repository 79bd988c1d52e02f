//! Colour: the sRGB curve, luminance, XYZ, spectra and black bodies.

mod observer;
mod spectrum;
mod srgb;
mod xyz;

pub use spectrum::{SpectrumError, SpectrumKind, blackbody_radiance, blackbody_to_rgb, spectrum_to_rgb};
pub(crate) use srgb::SrgbCodes;
pub use srgb::{linear_to_srgb, luminance, srgb_to_linear};
pub use xyz::{rgb_to_xyz, xyz_to_rgb};
