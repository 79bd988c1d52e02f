//! Image files in and out, colour and image metrics.

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
    DecodedImage, Texels, decode, decode_bytes, image_from_bytes, layers_from_bytes, read_image, read_layers,
};
pub use write::{encode_exr, encode_png, write_atomic, write_exr, write_png, write_png8};
