//! Tone curves: from linear scene light of any brightness to linear display light in 0..1.

mod aces;
mod agx;
mod filmic;
mod list;
mod reinhard;
mod srgb;

pub use list::{TONEMAPS, Tonemap};
