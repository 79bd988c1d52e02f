//! Lights: what they send to a point, what they send out as photons, and how likely each choice is.

mod alias;
mod area;
mod emission;
mod emission_guide;
mod environment;
mod lights;
mod sky_view;
mod sphere;

pub(crate) use area::cosine_hemisphere;
pub(crate) use area::uniform_cone;
pub(crate) use emission::EmissionPoint;
pub(crate) use emission_guide::{Arrival, EmissionGuide};
pub use lights::{LightSample, Lights, PhotonStart, VisibleRegion};
pub(crate) use sky_view::SkyView;
pub(crate) use sphere::cone as sphere_cone;
