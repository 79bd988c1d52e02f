//! The principled model's clear coat: a long-tailed highlight of fixed index.

use super::microfacet_reflection::half_vector;
use crate::bsdf::LobeSet;
use crate::bsdf::fresnel::schlick_weight;
use crate::bsdf::lobe::{LobeSample, LobeShape};
use crate::bsdf::microfacet::reflect;
use photinus_geometry::Vec3;
use std::f32::consts::PI;

/// GTR with exponent 1 (Burley 2012, section 5.4 and appendix B), Schlick's reflectance from 0.04, and masking of fixed
/// roughness 0.25.
#[derive(Clone, Copy, Debug)]
pub struct Clearcoat {
    /// Roughness, below 1.
    pub alpha: f32,
}

impl Clearcoat {
    /// Roughness of its masking, whatever the gloss.
    const MASKING_ALPHA: f32 = 0.25;

    fn d(&self, m: Vec3) -> f32 {
        if m.z <= 0.0 {
            return 0.0;
        }
        let a_sq = self.alpha * self.alpha;
        // 1 + (a^2 - 1) z^2, written so that it keeps its digits near the pole.
        let e = m.x * m.x + m.y * m.y + a_sq * (m.z * m.z);
        (a_sq - 1.0) / (PI * libm::logf(a_sq) * e)
    }

    fn g1(v: Vec3) -> f32 {
        let xy_sq = Self::MASKING_ALPHA * Self::MASKING_ALPHA * (v.x * v.x + v.y * v.y);
        2.0 * v.z / (v.z + (v.z * v.z + xy_sq).sqrt()).max(1e-12)
    }
}

impl LobeShape for Clearcoat {
    fn eval(&self, _parts: LobeSet, wo: Vec3, wi: Vec3) -> Vec3 {
        let Some(m) = half_vector(wo, wi) else { return Vec3::ZERO };
        let f = 0.04 + 0.96 * schlick_weight(wo.dot(m));
        Vec3::splat(f * self.d(m) * Self::g1(wo) * Self::g1(wi) * wi.z)
    }

    fn pdf(&self, _parts: LobeSet, wo: Vec3, wi: Vec3) -> f32 {
        let Some(m) = half_vector(wo, wi) else { return 0.0 };
        self.d(m) * m.z / (4.0 * wo.dot(m)).max(1e-12)
    }

    fn sample(&self, parts: LobeSet, wo: Vec3, _u_lobe: f32, u: [f32; 2]) -> Option<LobeSample> {
        let a_sq = self.alpha * self.alpha;
        let cos_sq = (1.0 - libm::powf(a_sq, 1.0 - u[0])) / (1.0 - a_sq);
        let (cos, sin) = (cos_sq.clamp(0.0, 1.0).sqrt(), (1.0 - cos_sq).clamp(0.0, 1.0).sqrt());
        let phi = 2.0 * PI * u[1];
        let m = Vec3::new(sin * libm::cosf(phi), sin * libm::sinf(phi), cos);
        let wi = reflect(wo, m);
        if wi.z <= 0.0 || wo.dot(m) <= 0.0 {
            return None;
        }
        let pdf = self.pdf(parts, wo, wi);
        (pdf > 0.0).then(|| LobeSample { wi, weight: self.eval(parts, wo, wi) / pdf, pdf, kind: parts })
    }
}
