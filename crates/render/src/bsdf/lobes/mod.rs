//! Shapes of lobes that have a density over directions.

mod clearcoat;
mod coated_diffuse;
mod microfacet_reflection;
mod principled_diffuse;
mod rough_interface;

pub(super) use clearcoat::Clearcoat;
pub(super) use coated_diffuse::{CoatTransmittance, CoatedDiffuse};
pub(super) use microfacet_reflection::{FacetFresnel, MicrofacetReflection};
pub(super) use principled_diffuse::PrincipledDiffuse;
pub(super) use rough_interface::{InterfaceTint, RoughInterface};
