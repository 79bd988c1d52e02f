//! One lobe of a surface's scattering, in the local frame.

use super::LobeSet;
use super::lobes::{Clearcoat, CoatedDiffuse, MicrofacetReflection, PrincipledDiffuse, RoughInterface};
use photinus_geometry::Vec3;
use std::f32::consts::PI;

/// Shapes of lobes. A new one is a file in `lobes/` and a line here.
#[derive(Clone, Copy, Debug)]
pub(super) enum LobeKind {
    /// 1 / pi on the side of `wo`.
    Lambert,
    /// 1 / pi on the other side.
    LambertTransmission,
    /// The mirror direction.
    DeltaReflection,
    /// The refracted direction; straight on where the lobe's index is 1.
    DeltaTransmission,
    Reflection(MicrofacetReflection),
    Interface(RoughInterface),
    Coated(CoatedDiffuse),
    Principled(PrincipledDiffuse),
    Clearcoat(Clearcoat),
}

/// A lobe: its shape, colour, and share in the choice of lobes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lobe {
    pub kind: LobeKind,
    /// One kind of lobe, or two where one shape reflects and transmits.
    pub set: LobeSet,
    /// Factor on the shape's value.
    pub weight: Vec3,
    /// Estimated reflectance and transmittance for the resolved `wo`, weight included.
    pub albedo: [Vec3; 2],
    /// Index on the other side over index on this side, for what is transmitted.
    pub eta: f32,
    /// Which of the shading frames.
    pub frame: u8,
}

/// A direction drawn from one lobe.
pub(super) struct LobeSample {
    /// Local direction.
    pub wi: Vec3,
    /// Shape's value times |cos| over density.
    pub weight: Vec3,
    /// Density over solid angle.
    pub pdf: f32,
    /// The kind of lobe, one bit.
    pub kind: LobeSet,
}

/// What a shape with a density must answer. `parts` says whether reflection, transmission or both are asked for;
/// values hold for importance (no 1 / eta^2) and include |cos theta_i|.
pub(super) trait LobeShape {
    /// Value for a pair of directions; `wi` is on a side that `parts` holds.
    fn eval(&self, parts: LobeSet, wo: Vec3, wi: Vec3) -> Vec3;
    /// Density of `sample` with the same `parts`.
    fn pdf(&self, parts: LobeSet, wo: Vec3, wi: Vec3) -> f32;
    /// A direction; none where the draw is lost to masking.
    fn sample(&self, parts: LobeSet, wo: Vec3, u_lobe: f32, u: [f32; 2]) -> Option<LobeSample>;
}

/// The concentric map of the square to the disc lifted to the hemisphere: density cos / pi.
#[inline]
pub(super) fn sample_cosine(u: [f32; 2]) -> Vec3 {
    let [x, y] = crate::camera::uniform_disk(u);
    Vec3::new(x, y, (1.0 - x * x - y * y).max(1e-12).sqrt())
}

impl Lobe {
    /// Probability weight of this lobe among those in `set`.
    #[inline]
    pub fn importance(&self, set: LobeSet) -> f32 {
        let shared = self.set & set;
        let mut sum = Vec3::ZERO;
        if shared.intersects(LobeSet::REFLECTION) {
            sum += self.albedo[0];
        }
        if shared.intersects(LobeSet::TRANSMISSION) {
            sum += self.albedo[1];
        }
        crate::texture::luminance(sum)
    }

    /// Value times weight; 0 for single directions.
    pub fn eval(&self, parts: LobeSet, wo: Vec3, wi: Vec3) -> Vec3 {
        let value = match &self.kind {
            LobeKind::Lambert | LobeKind::LambertTransmission => Vec3::splat(wi.z.abs() * (1.0 / PI)),
            LobeKind::DeltaReflection | LobeKind::DeltaTransmission => Vec3::ZERO,
            LobeKind::Reflection(shape) => shape.eval(parts, wo, wi),
            LobeKind::Interface(shape) => shape.eval(parts, wo, wi),
            LobeKind::Coated(shape) => shape.eval(parts, wo, wi),
            LobeKind::Principled(shape) => shape.eval(parts, wo, wi),
            LobeKind::Clearcoat(shape) => shape.eval(parts, wo, wi),
        };
        value * self.weight
    }

    /// Density of [`sample`](Self::sample) over solid angle; 0 for single directions.
    pub fn pdf(&self, parts: LobeSet, wo: Vec3, wi: Vec3) -> f32 {
        match &self.kind {
            LobeKind::Lambert | LobeKind::LambertTransmission => wi.z.abs() * (1.0 / PI),
            LobeKind::DeltaReflection | LobeKind::DeltaTransmission => 0.0,
            LobeKind::Reflection(shape) => shape.pdf(parts, wo, wi),
            LobeKind::Interface(shape) => shape.pdf(parts, wo, wi),
            LobeKind::Coated(shape) => shape.pdf(parts, wo, wi),
            LobeKind::Principled(shape) => shape.pdf(parts, wo, wi),
            LobeKind::Clearcoat(shape) => shape.pdf(parts, wo, wi),
        }
    }

    /// A direction from a lobe that has a density; weight included.
    pub fn sample(&self, parts: LobeSet, wo: Vec3, u_lobe: f32, u: [f32; 2]) -> Option<LobeSample> {
        let lambert = |sign: f32| {
            let v = sample_cosine(u);
            let wi = Vec3::new(v.x, v.y, v.z * sign);
            Some(LobeSample { wi, weight: Vec3::ONE, pdf: v.z * (1.0 / PI), kind: self.set })
        };
        let mut sample = match &self.kind {
            LobeKind::Lambert => lambert(1.0),
            LobeKind::LambertTransmission => lambert(-1.0),
            LobeKind::DeltaReflection | LobeKind::DeltaTransmission => None,
            LobeKind::Reflection(shape) => shape.sample(parts, wo, u_lobe, u),
            LobeKind::Interface(shape) => shape.sample(parts, wo, u_lobe, u),
            LobeKind::Coated(shape) => shape.sample(parts, wo, u_lobe, u),
            LobeKind::Principled(shape) => shape.sample(parts, wo, u_lobe, u),
            LobeKind::Clearcoat(shape) => shape.sample(parts, wo, u_lobe, u),
        }?;
        sample.weight *= self.weight;
        sample.kind = self.set & if sample.wi.z > 0.0 { LobeSet::REFLECTION } else { LobeSet::TRANSMISSION };
        Some(sample)
    }
}
