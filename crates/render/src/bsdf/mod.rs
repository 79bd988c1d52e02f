//! Surface scattering: materials resolved at a point into a sum of lobes that can be evaluated and sampled.
//!
//! Directions are unit vectors in world space, all pointing away from the surface; `wo` is where the path comes from,
//! `wi` where it goes. Values include |cos theta_i|. A [`Bsdf`] is made for one `wo` by [`Materials::resolve`] and
//! keeps it: which side of the surface is seen decides which lobes there are.
//!
//! Inside, every lobe works in a local frame whose z axis is the shading normal on the side of `wo`, so that `wo.z` is
//! never negative and a relative index of refraction is always (other side) / (this side).

mod builder;
mod fresnel;
mod lobe;
mod lobe_set;
mod lobes;
mod materials;
mod members;
mod microfacet;
mod recipe;
mod scattering;
mod transport;

pub use fresnel::{fresnel_conductor, fresnel_dielectric, fresnel_diffuse_reflectance};
pub use lobe_set::LobeSet;
pub use materials::Materials;
pub use members::{MATERIAL_KINDS, MaterialKind, Reads, material_kind};
pub use scattering::{Bsdf, BsdfSample};
pub use transport::{SurfaceModel, TransportMode};

/// Microfacet roughness (alpha) up to which a surface counts as a perfect mirror or pane.
pub const MIRROR_ALPHA: f32 = 1e-3;

/// Microfacet roughness (alpha) from which photons are stored at a reflecting lobe and gathered there.
pub const GATHER_ALPHA: f32 = 0.25;

#[cfg(test)]
mod tests;
