//! Rendering: photon pass, eye pass, radiance estimates, surface scattering, film, progressive passes, and a path
//! tracer as ground truth.

// Expected values may come from any mathematics library: they are compared within tolerances.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod answers;
pub mod bsdf;
mod camera;
mod caustic_plan;
mod companions;
mod control;
mod counters;
mod cut_pixels;
mod direct;
mod eye_pass;
mod facet;
mod film;
mod film_filter;
mod footprint;
mod indirect;
mod light;
mod maps;
mod memory;
mod photon_pass;
mod photon_window;
mod pilot;
mod pool;
mod pooled;
mod recording;
mod renderer;
mod runs;
mod settings;
mod shadow;
mod shadow_photons;
mod sort;
mod support;
mod surface;
pub mod texture;
mod tile;
mod trace;
mod twin;
mod usefulness;
mod waves;
mod world;

pub use camera::{CameraModel, CameraRay};
pub use control::{Cancelled, Observer, Phase, Silent};
pub use counters::{Counters, IrradianceCounts, PhotonCounts, PhotonPower, RayCounts, ShadowPhotonCounts, Spent};
pub use film::{Aov, Film, FilmLayout};
pub use indirect::{INDIRECT, Indirect, IndirectMember};
pub use light::{LightSample, Lights, PhotonStart, VisibleRegion};
pub use memory::RenderMemory;
pub use renderer::{RenderError, Renderer};
pub use settings::{Mode, Settings};
pub use surface::SurfacePoint;
pub use world::{Compiled, World};
