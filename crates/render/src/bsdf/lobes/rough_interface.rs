//! A rough interface between two dielectrics: reflection and refraction by the same facets.

use super::microfacet_reflection::half_vector;
use crate::bsdf::LobeSet;
use crate::bsdf::fresnel::{fresnel_dielectric, schlick_weight};
use crate::bsdf::lobe::{LobeSample, LobeShape};
use crate::bsdf::microfacet::{Microfacets, reflect, refract};
use crate::texture::luminance;
use photinus_geometry::Vec3;

/// What the principled model makes of a dielectric's reflectance: plain + metal (Schlick, base colour) + tinted
/// (Schlick, tint colour).
#[derive(Clone, Copy, Debug)]
pub struct InterfaceTint {
    /// Factor on the exact reflectance.
    pub plain: f32,
    /// Sum over Schlick's terms of weight * colour at normal incidence.
    pub f0: Vec3,
    /// Sum over Schlick's terms of weight * (1 - colour at normal incidence).
    pub f90_minus_f0: Vec3,
}

impl InterfaceTint {
    /// The exact reflectance and nothing else.
    pub const PLAIN: Self = Self { plain: 1.0, f0: Vec3::ZERO, f90_minus_f0: Vec3::ZERO };

    /// Reflectance at a facet whose exact dielectric reflectance is `f`.
    #[inline]
    pub fn reflectance(&self, f: f32, cos: f32) -> Vec3 {
        Vec3::splat(self.plain * f) + self.f0 + self.f90_minus_f0 * schlick_weight(cos)
    }
}

/// Walter et al. 2007, equations 20 and 21, for importance: radiance is scaled by the caller.
#[derive(Clone, Copy, Debug)]
pub struct RoughInterface {
    /// The facets.
    pub facets: Microfacets,
    /// Index on the other side over index on this side, not 1.
    pub eta: f32,
    /// Colour of what is reflected.
    pub reflectance: Vec3,
    /// Colour of what is transmitted.
    pub transmittance: Vec3,
    /// How the reflectance departs from Fresnel's.
    pub tint: InterfaceTint,
}

impl RoughInterface {
    /// The facet that sends `wo` to `wi`, pointing to the side of `wo`.
    #[inline]
    fn facet(&self, wo: Vec3, wi: Vec3) -> Option<Vec3> {
        if wi.z > 0.0 {
            return half_vector(wo, wi).filter(|m| wo.dot(*m) > 0.0);
        }
        let m = (wo + wi * self.eta).normalize_or_zero();
        let m = if m.z < 0.0 { -m } else { m };
        (m != Vec3::ZERO && wo.dot(m) > 0.0 && wi.dot(m) < 0.0).then_some(m)
    }

    /// Probability of reflection at a facet, when `parts` may hold both.
    #[inline]
    fn reflect_probability(&self, parts: LobeSet, f: f32, cos: f32) -> f32 {
        match (parts.intersects(LobeSet::REFLECTION), parts.intersects(LobeSet::TRANSMISSION)) {
            (true, false) => 1.0,
            (false, _) => 0.0,
            (true, true) => {
                let r = luminance(self.tint.reflectance(f, cos) * self.reflectance);
                let t = (1.0 - f) * luminance(self.transmittance);
                if r + t > 0.0 { r / (r + t) } else { f }
            }
        }
    }

    /// |d omega_m / d omega_i| of refraction: eta^2 |wi.m| / (wo.m + eta wi.m)^2.
    #[inline]
    fn refraction_jacobian(&self, wo_m: f32, wi_m: f32) -> f32 {
        let denominator = wo_m + self.eta * wi_m;
        self.eta * self.eta * wi_m.abs() / (denominator * denominator).max(1e-20)
    }
}

impl LobeShape for RoughInterface {
    fn eval(&self, _parts: LobeSet, wo: Vec3, wi: Vec3) -> Vec3 {
        let Some(m) = self.facet(wo, wi) else { return Vec3::ZERO };
        let (wo_m, wi_m) = (wo.dot(m), wi.dot(m));
        let f = fresnel_dielectric(wo_m, self.eta).0;
        let common = self.facets.d(m) * self.facets.g1_over_cos(wo) * self.facets.g1(wi);
        if wi.z > 0.0 {
            self.tint.reflectance(f, wo_m) * self.reflectance * (0.25 * common)
        } else {
            self.transmittance * ((1.0 - f) * common * wo_m * self.refraction_jacobian(wo_m, wi_m))
        }
    }

    fn pdf(&self, parts: LobeSet, wo: Vec3, wi: Vec3) -> f32 {
        let Some(m) = self.facet(wo, wi) else { return 0.0 };
        let (wo_m, wi_m) = (wo.dot(m), wi.dot(m));
        let f = fresnel_dielectric(wo_m, self.eta).0;
        let reflect = self.reflect_probability(parts, f, wo_m);
        if wi.z > 0.0 {
            0.25 * self.facets.d(m) * self.facets.g1_over_cos(wo) * reflect
        } else {
            let transmit = if f < 1.0 { 1.0 - reflect } else { 0.0 };
            self.facets.visible_pdf(wo, m) * self.refraction_jacobian(wo_m, wi_m) * transmit
        }
    }

    fn sample(&self, parts: LobeSet, wo: Vec3, u_lobe: f32, u: [f32; 2]) -> Option<LobeSample> {
        let m = self.facets.sample_visible(wo, u);
        let wo_m = wo.dot(m);
        if wo_m <= 0.0 {
            return None;
        }
        let (f, cos_t) = fresnel_dielectric(wo_m, self.eta);
        let probability = self.reflect_probability(parts, f, wo_m);
        let density = self.facets.visible_pdf(wo, m);
        let (wi, weight, pdf) = if u_lobe < probability {
            let wi = reflect(wo, m);
            let weight = self.tint.reflectance(f, wo_m) * self.reflectance / probability;
            (wi, weight, density * probability / (4.0 * wo_m))
        } else {
            if f >= 1.0 {
                return None;
            }
            let wi = refract(wo, m, self.eta, cos_t);
            let weight = self.transmittance * ((1.0 - f) / (1.0 - probability));
            (wi, weight, density * (1.0 - probability) * self.refraction_jacobian(wo_m, wi.dot(m)))
        };
        if (wi.z > 0.0) != (u_lobe < probability) || wi.z == 0.0 || !(pdf > 0.0) {
            return None;
        }
        Some(LobeSample { wi, weight: weight * self.facets.g1(wi), pdf, kind: parts })
    }
}
