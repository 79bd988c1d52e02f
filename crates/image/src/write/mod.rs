//! Writing image files: whole or not at all, the same bytes for the same image.

mod atomic;
mod exr;
mod png;

pub use atomic::{remove_abandoned, temporary_in, write_atomic};
pub use exr::{encode_exr, write_exr};
pub use png::{encode_png, write_layers_png, write_png, write_png8, write_png8_rgba};
