//! Parts that built-in scenes are put together from.

mod stage;

pub use stage::{Stage, camera, film, quads, rgb};
