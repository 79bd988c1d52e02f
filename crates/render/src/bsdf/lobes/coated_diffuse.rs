//! A diffuse base seen through a dielectric coat, smooth or rough.

use crate::bsdf::LobeSet;
use crate::bsdf::fresnel::fresnel_dielectric;
use crate::bsdf::lobe::{LobeSample, LobeShape, sample_cosine};
use crate::bsdf::microfacet::CosTable;
use photinus_geometry::Vec3;
use std::f32::consts::PI;

/// Transmittance of the coat from outside, over the cosine.
#[derive(Clone, Copy, Debug)]
pub enum CoatTransmittance {
    /// Fresnel's, for this relative index.
    Smooth {
        /// Index of the coat over index outside.
        eta: f32,
    },
    /// Tabulated over the facets.
    Rough(CosTable),
}

/// T(wo) T(wi) cos / (pi eta^2), to be weighted by albedo / (1 - internal reflectance * albedo): the light enters, is
/// scattered by the base any number of times, and leaves.
#[derive(Clone, Copy, Debug)]
pub struct CoatedDiffuse {
    /// T.
    pub transmittance: CoatTransmittance,
    /// 1 / eta^2.
    pub inv_eta_sq: f32,
}

impl CoatedDiffuse {
    /// T(cos).
    #[inline]
    pub fn transmittance(&self, cos: f32) -> f32 {
        match &self.transmittance {
            CoatTransmittance::Smooth { eta } => 1.0 - fresnel_dielectric(cos, *eta).0,
            CoatTransmittance::Rough(table) => table.at(cos),
        }
    }
}

impl LobeShape for CoatedDiffuse {
    fn eval(&self, _parts: LobeSet, wo: Vec3, wi: Vec3) -> Vec3 {
        let t = self.transmittance(wo.z) * self.transmittance(wi.z);
        Vec3::splat(t * self.inv_eta_sq * wi.z * (1.0 / PI))
    }

    fn pdf(&self, _parts: LobeSet, _wo: Vec3, wi: Vec3) -> f32 {
        wi.z * (1.0 / PI)
    }

    fn sample(&self, parts: LobeSet, wo: Vec3, _u_lobe: f32, u: [f32; 2]) -> Option<LobeSample> {
        let wi = sample_cosine(u);
        let weight = Vec3::splat(self.transmittance(wo.z) * self.transmittance(wi.z) * self.inv_eta_sq);
        Some(LobeSample { wi, weight, pdf: wi.z * (1.0 / PI), kind: parts })
    }
}
