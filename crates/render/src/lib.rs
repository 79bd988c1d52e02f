//! Rendering: photon pass, eye pass, radiance estimates, surface scattering, film, progressive passes, and a path
//! tracer as ground truth.

pub mod bsdf;
mod surface;
pub mod texture;

pub use surface::SurfacePoint;
