//! Lights: what they send to a point, what they send out as photons, and how likely each choice is.

mod alias;
mod anchors;
mod area;
mod clusters;
mod effort;
mod emission;
mod emission_guide;
mod emitter;
mod environment;
mod far;
mod guide;
mod lights;
mod panel;
mod sky_pool;
mod sky_view;
mod sphere;
mod tally;

pub(crate) use anchors::{Anchor, anchors};
pub(crate) use area::cosine_hemisphere;
pub(crate) use area::uniform_cone;
pub(crate) use effort::shadow_rays;
pub(crate) use emission::EmissionPoint;
pub(crate) use emission_guide::{Arrival, EmissionGuide};
pub(crate) use guide::{LightGuide, Place};
pub use lights::{LightSample, Lights, PhotonStart, VisibleRegion};
pub(crate) use sky_view::SkyView;
pub(crate) use sphere::cone as sphere_cone;
