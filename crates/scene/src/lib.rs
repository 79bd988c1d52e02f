//! Scenes: what is in them ([`model`]), where they come from (importers, built-in scenes) and how they are written.
//!
//! A [`Scene`] is plain data in world space: importers resolve transforms, instances and defaults, so that a renderer
//! reads it without knowing any file format.

pub mod builtin;
pub mod load;
pub mod model;
pub mod shapes;
pub mod tessellate;
pub mod write;

pub use load::{LoadError, LoadOptions, load};
pub use model::*;
pub use write::{WriteError, write_mitsuba};
