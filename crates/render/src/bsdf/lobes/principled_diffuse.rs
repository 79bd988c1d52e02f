//! The principled model's base: diffuse with retro-reflection, flattened towards subsurface scattering, and sheen.

use super::microfacet_reflection::half_vector;
use crate::bsdf::LobeSet;
use crate::bsdf::fresnel::schlick_weight;
use crate::bsdf::lobe::{LobeSample, LobeShape, sample_cosine};
use photinus_geometry::Vec3;
use std::f32::consts::PI;

/// Burley, "Physically Based Shading at Disney", 2012, section 5.3, and "Extending the Disney BRDF to a BSDF", 2015,
/// section 4.
#[derive(Clone, Copy, Debug)]
pub struct PrincipledDiffuse {
    /// Base colour times the share that is neither metal nor glass.
    pub color: Vec3,
    /// Sheen colour times its strength.
    pub sheen: Vec3,
    /// Roughness, not squared.
    pub roughness: f32,
    /// 0 diffuse, 1 flat.
    pub flatness: f32,
}

impl LobeShape for PrincipledDiffuse {
    fn eval(&self, _parts: LobeSet, wo: Vec3, wi: Vec3) -> Vec3 {
        let Some(m) = half_vector(wo, wi) else { return Vec3::ZERO };
        let (fo, fi) = (schlick_weight(wo.z), schlick_weight(wi.z));
        let cos_d = wi.dot(m);
        let retro = 2.0 * self.roughness * cos_d * cos_d;
        let diffuse = (1.0 - 0.5 * fo) * (1.0 - 0.5 * fi) + retro * (fo + fi + fo * fi * (retro - 1.0));
        // Hanrahan and Krueger's flat lobe, with half the retro-reflection as its grazing value.
        let fss90 = 0.5 * retro;
        let fss = (1.0 + (fss90 - 1.0) * fo) * (1.0 + (fss90 - 1.0) * fi);
        let flat = 1.25 * (fss * (1.0 / (wo.z + wi.z).max(1e-6) - 0.5) + 0.5);
        let base = diffuse + (flat - diffuse) * self.flatness;
        (self.color * (base * (1.0 / PI)) + self.sheen * schlick_weight(cos_d)) * wi.z
    }

    fn pdf(&self, _parts: LobeSet, _wo: Vec3, wi: Vec3) -> f32 {
        wi.z * (1.0 / PI)
    }

    fn sample(&self, parts: LobeSet, wo: Vec3, _u_lobe: f32, u: [f32; 2]) -> Option<LobeSample> {
        let wi = sample_cosine(u);
        let pdf = wi.z * (1.0 / PI);
        Some(LobeSample { wi, weight: self.eval(parts, wo, wi) / pdf, pdf, kind: parts })
    }
}
