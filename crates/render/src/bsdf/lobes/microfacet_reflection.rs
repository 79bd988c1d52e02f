//! Reflection by microfacets.

use crate::bsdf::LobeSet;
use crate::bsdf::fresnel::{fresnel_conductor, fresnel_dielectric};
use crate::bsdf::lobe::{LobeSample, LobeShape};
use crate::bsdf::microfacet::{Microfacets, reflect};
use photinus_geometry::Vec3;

use super::rough_interface::InterfaceTint;

/// What a single facet reflects.
#[derive(Clone, Copy, Debug)]
pub enum FacetFresnel {
    /// A metal with this complex index, per channel.
    Conductor {
        /// Real part.
        eta: Vec3,
        /// Imaginary part.
        k: Vec3,
    },
    /// A dielectric of this relative index.
    Dielectric {
        /// Other side over this side.
        eta: f32,
    },
    /// The principled model's mix of metal, tinted and plain dielectric.
    Principled {
        /// Other side over this side.
        eta: f32,
        /// Weights and colours.
        tint: InterfaceTint,
    },
}

impl FacetFresnel {
    /// Reflectance at the facet's cosine.
    #[inline]
    pub fn reflectance(&self, cos: f32) -> Vec3 {
        match *self {
            Self::Conductor { eta, k } => fresnel_conductor(cos, eta, k),
            Self::Dielectric { eta } => Vec3::splat(fresnel_dielectric(cos, eta).0),
            Self::Principled { eta, tint } => tint.reflectance(fresnel_dielectric(cos, eta).0, cos),
        }
    }
}

/// D F G / (4 |wo.z|) (Torrance and Sparrow; Walter et al. 2007, equation 20), |cos theta_i| included.
#[derive(Clone, Copy, Debug)]
pub struct MicrofacetReflection {
    /// The facets.
    pub facets: Microfacets,
    /// What each reflects.
    pub fresnel: FacetFresnel,
}

/// The facet that mirrors `wo` into `wi`, if there is one.
#[inline]
pub fn half_vector(wo: Vec3, wi: Vec3) -> Option<Vec3> {
    let h = wo + wi;
    let length_sq = h.length_squared();
    (length_sq > 1e-12).then(|| h / length_sq.sqrt())
}

impl LobeShape for MicrofacetReflection {
    fn eval(&self, _parts: LobeSet, wo: Vec3, wi: Vec3) -> Vec3 {
        let Some(m) = half_vector(wo, wi) else { return Vec3::ZERO };
        let f = self.fresnel.reflectance(wo.dot(m));
        f * (0.25 * self.facets.d(m) * self.facets.g1_over_cos(wo) * self.facets.g1(wi))
    }

    fn pdf(&self, _parts: LobeSet, wo: Vec3, wi: Vec3) -> f32 {
        let Some(m) = half_vector(wo, wi) else { return 0.0 };
        0.25 * self.facets.d(m) * self.facets.g1_over_cos(wo)
    }

    fn sample(&self, parts: LobeSet, wo: Vec3, _u_lobe: f32, u: [f32; 2]) -> Option<LobeSample> {
        let m = self.facets.sample_visible(wo, u);
        let wi = reflect(wo, m);
        if wi.z <= 0.0 {
            return None;
        }
        let weight = self.fresnel.reflectance(wo.dot(m)) * self.facets.g1(wi);
        let pdf = self.pdf(parts, wo, wi);
        (pdf > 0.0).then_some(LobeSample { wi, weight, pdf, kind: parts })
    }
}
