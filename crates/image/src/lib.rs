//! Image files in and out, colour, tone curves and image metrics.
//!
//! Pictures are linear RGB (Rec. 709 primaries, D65 white), 32-bit floats, the top row first.
//!
//! * Reading: [`read_image`] for pictures, [`decode`] for textures as stored, [`read_layers`] for EXR with AOVs. The
//!   content decides the format; [`Limits`] are checked before anything is allocated; a damaged file is an [`ImageError`].
//! * Writing: [`write_exr`] and [`write_png`], whole or not at all, the same bytes for the same image.
//! * [`tonemap`], [`colour`] and [`metrics`] hold tone curves, spectra and comparisons.

pub mod colour;
mod error;
mod image;
mod limits;
pub mod metrics;
mod read;
pub mod tonemap;
mod write;

pub use error::{ImageError, ImageErrorKind, Result};
pub use image::{Channel, Image, Layer, Layers};
pub use limits::Limits;
pub use read::{
    DecodedImage, Texels, decode, decode_bytes, image_from_bytes, is_decoding, layers_from_bytes, read_image,
    read_layers,
};
pub use write::{
    encode_exr, encode_png, remove_abandoned, temporary_in, write_atomic, write_exr, write_layers_png, write_png,
    write_png8, write_png8_rgba,
};
