//! A surface's scattering at one point, seen from one direction: a sum of lobes.

use super::fresnel::fresnel_dielectric;
use super::lobe::{Lobe, LobeKind};
use super::microfacet::refract;
use super::{LobeSet, TransportMode};
use arrayvec::ArrayVec;
use photinus_geometry::{Frame, Vec3};

/// Lobes that a sum may have; what a material has beyond them is folded into a diffuse lobe of the same albedo.
pub(super) const MAX_LOBES: usize = 8;

/// Different shading normals that a sum may have (blends of bump maps, bent normals of mirrors); further ones share the
/// last.
pub(super) const MAX_FRAMES: usize = 4;

/// Bound on the ratio of cosines by which shading normals correct photons: without one a single photon at grazing
/// incidence on a coarse mesh could outshine an estimate. Where diffuse light meets a surface at the horizon of its
/// geometric normal and at a shading cosine c, the bound cuts off the cosines below c / 256: about c^2 / 256 of the
/// irradiance.
const MAX_NORMAL_CORRECTION: f32 = 256.0;

/// A shading frame on the side of `wo`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ShadingFrame {
    /// x, y and z in world space; left-handed on the back.
    pub axes: Frame,
    /// `wo` in it.
    pub wo: Vec3,
    /// Squared roughness of the shadowing term of bump maps; 0: no term.
    pub bump_alpha_sq: f32,
    /// Its normal is the geometric one, and there are no bumps.
    pub is_flat: bool,
}

impl ShadingFrame {
    /// Part of the light from the local direction `v` that the bumps let through (Estevez, Lecocq and Stein, "A
    /// Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem", Ray Tracing Gems, 2019); `cos` is
    /// measured from the normal without bumps.
    #[inline]
    fn bump_shadow(&self, cos: f32) -> f32 {
        if self.bump_alpha_sq == 0.0 {
            return 1.0;
        }
        let cos_sq = (cos * cos).clamp(1e-8, 1.0);
        2.0 / (1.0 + (1.0 + self.bump_alpha_sq * (1.0 - cos_sq) / cos_sq).sqrt())
    }
}

/// A direction drawn from a [`Bsdf`].
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// Unit direction in world space.
    pub wi: Vec3,
    /// f |cos theta_i| / density, the choice of lobe included.
    pub weight: Vec3,
    /// Density over solid angle of the whole set that was asked for; for a single direction the probability of its
    /// lobe.
    pub pdf: f32,
    /// The kind of lobe, one of [`LobeSet::KINDS`].
    pub kind: LobeSet,
    /// Index on the side of `wi` over index on the side of `wo`; 1 where no interface is crossed.
    pub eta: f32,
}

/// Scattering at a point for one `wo`: made by [`Materials::resolve`](super::Materials::resolve).
#[derive(Clone, Debug)]
pub struct Bsdf {
    /// World direction that it was resolved for.
    pub(super) wo: Vec3,
    /// Geometric normal on the side of `wo`.
    pub(super) ng: Vec3,
    /// Shading normal before bump maps on the side of `wo`.
    pub(super) ns: Vec3,
    /// Shading normal after the last bump map.
    pub(super) shading_normal: Vec3,
    pub(super) frames: ArrayVec<ShadingFrame, MAX_FRAMES>,
    pub(super) lobes: ArrayVec<Lobe, MAX_LOBES>,
    /// Union of the lobes' kinds.
    pub(super) kinds: LobeSet,
}

/// A surface that absorbs all light: what [`resolve_into`](super::Materials::resolve_into) starts with.
impl Default for Bsdf {
    fn default() -> Self {
        Self {
            wo: Vec3::Z,
            ng: Vec3::Z,
            ns: Vec3::Z,
            shading_normal: Vec3::Z,
            frames: ArrayVec::new(),
            lobes: ArrayVec::new(),
            kinds: LobeSet::NONE,
        }
    }
}

impl Bsdf {
    /// Whether there is a lobe of one of these kinds.
    #[inline]
    pub fn has(&self, set: LobeSet) -> bool {
        self.kinds.intersects(set)
    }

    /// All kinds of lobes that there are.
    #[inline]
    pub fn kinds(&self) -> LobeSet {
        self.kinds
    }

    /// Unit shading normal on the side of `wo`, bump and normal maps included.
    #[inline]
    pub fn shading_normal(&self) -> Vec3 {
        self.shading_normal
    }

    /// Unit geometric normal on the side of `wo`.
    #[inline]
    pub fn geometric_normal(&self) -> Vec3 {
        self.ng
    }

    #[inline]
    pub(super) fn lobes(&self) -> &[Lobe] {
        &self.lobes
    }

    /// The halves of lobes that `wi` can belong to: none where shading and geometric normal disagree on its side, so that
    /// no light leaks through a surface.
    #[inline]
    fn side_of(&self, local: Vec3, wi: Vec3) -> LobeSet {
        let geometric = self.ng.dot(wi);
        if local.z > 0.0 && geometric > 0.0 {
            LobeSet::REFLECTION
        } else if local.z < 0.0 && geometric < 0.0 {
            LobeSet::TRANSMISSION
        } else {
            LobeSet::NONE
        }
    }

    /// What turns a lobe's value into radiance or importance: the scaling of radiance by refraction, the shadowing of
    /// bumps, and Veach's correction of importance for shading normals ("Robust Monte Carlo Methods for Light Transport
    /// Simulation", 1997, section 5.3): |wo.ns| |wi.ng| / (|wo.ng| |wi.ns|).
    #[inline]
    fn mode_factor(&self, frame: &ShadingFrame, local: Vec3, wi: Vec3, eta: f32, mode: TransportMode) -> f32 {
        match mode {
            TransportMode::Radiance => {
                let scale = if local.z < 0.0 { 1.0 / (eta * eta) } else { 1.0 };
                if frame.bump_alpha_sq == 0.0 { scale } else { scale * frame.bump_shadow(self.ns.dot(wi)) }
            }
            TransportMode::Importance if frame.is_flat => 1.0,
            TransportMode::Importance => {
                let above = frame.wo.z * self.ng.dot(wi).abs();
                let below = self.ng.dot(self.wo).abs() * local.z.abs();
                bounded_ratio(above, below) * frame.bump_shadow(self.ns.dot(self.wo))
            }
        }
    }

    /// Sum of the lobes in `set` that have a density: f |cos theta_i| for the unit world direction `wi`.
    pub fn eval(&self, set: LobeSet, wi: Vec3, mode: TransportMode) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for lobe in self.lobes() {
            let wanted = lobe.set & set & LobeSet::NON_DELTA;
            if wanted.is_empty() {
                continue;
            }
            let frame = &self.frames[usize::from(lobe.frame)];
            let local = frame.axes.to_local(wi);
            let parts = wanted & self.side_of(local, wi);
            if !parts.is_empty() {
                sum += lobe.eval(parts, frame.wo, local) * self.mode_factor(frame, local, wi, lobe.eta, mode);
            }
        }
        sum
    }

    /// Value without the cosine, where no lobe of `set` depends on direction: what a photon estimate may take out of
    /// its sum. None where some lobe does, or where there is none.
    pub fn constant(&self, set: LobeSet) -> Option<Vec3> {
        let mut sum = None;
        for lobe in self.lobes().iter().filter(|lobe| lobe.set.intersects(set)) {
            match lobe.kind {
                LobeKind::Lambert if self.frames[usize::from(lobe.frame)].bump_alpha_sq == 0.0 => {
                    sum = Some(sum.unwrap_or(Vec3::ZERO) + lobe.weight * std::f32::consts::FRAC_1_PI);
                }
                _ => return None,
            }
        }
        sum
    }

    /// What irradiance is multiplied by, 1/sr, where all gather lobes are diffuse: exact where none depends on direction, and else,
    /// under a coat, the share that they scatter over pi, right for light that comes from everywhere alike. None where there is
    /// a rough lobe, or no gather lobe.
    pub fn diffuse_factor(&self) -> Option<Vec3> {
        let gather = self.kinds & LobeSet::GATHER;
        if gather.is_empty() || gather.intersects(LobeSet::ROUGH_REFLECTION) {
            return None;
        }
        Some(self.constant(gather).unwrap_or_else(|| self.albedo(gather) * std::f32::consts::FRAC_1_PI))
    }

    /// Density over solid angle of [`sample`](Self::sample) with the same set, single directions left out.
    pub fn pdf(&self, set: LobeSet, wi: Vec3) -> f32 {
        let (mut sum, mut total) = (0.0, 0.0);
        for lobe in self.lobes() {
            let importance = lobe.importance(set);
            if importance <= 0.0 {
                continue;
            }
            total += importance;
            let wanted = lobe.set & set & LobeSet::NON_DELTA;
            let frame = &self.frames[usize::from(lobe.frame)];
            let local = frame.axes.to_local(wi);
            if (wanted & self.side_of(local, wi)).is_empty() {
                continue;
            }
            sum += importance * lobe.pdf(wanted, frame.wo, local);
        }
        if total > 0.0 { sum / total } else { 0.0 }
    }

    /// Draws a direction from the lobes in `set`: a lobe in proportion to its estimated albedo, then a direction in
    /// proportion to the lobe as far as possible. None where the surface absorbs or the draw is lost to masking.
    pub fn sample(&self, set: LobeSet, u_lobe: f32, u: [f32; 2], mode: TransportMode) -> Option<BsdfSample> {
        if let Some(lobe) = self.only(set)
            && LobeSet::DELTA.contains(lobe.set)
        {
            let (wi, weight, eta) = self.delta_child(lobe, mode);
            return (lobe.importance(set) > 0.0).then_some(BsdfSample { wi, weight, pdf: 1.0, kind: lobe.set, eta });
        }
        let (lobe, probability, u_lobe) = self.choose(set, u_lobe)?;
        let frame = &self.frames[usize::from(lobe.frame)];
        if LobeSet::DELTA.intersects(lobe.set) {
            let (wi, weight, eta) = self.delta_child(lobe, mode);
            return Some(BsdfSample { wi, weight: weight / probability, pdf: probability, kind: lobe.set, eta });
        }
        let wanted = lobe.set & set;
        let drawn = lobe.sample(wanted, frame.wo, u_lobe, u)?;
        let wi = frame.axes.to_world(drawn.wi).normalize();
        if !self.side_of(drawn.wi, wi).intersects(drawn.kind) {
            return None;
        }
        let eta = if drawn.wi.z < 0.0 { lobe.eta } else { 1.0 };
        let drawable = |lobe: &&Lobe| lobe.set.intersects(set & LobeSet::NON_DELTA);
        let alone = self.lobes().len() == 1 || self.lobes().iter().filter(drawable).count() == 1;
        let (weight, pdf) = if alone {
            let factor = self.mode_factor(frame, drawn.wi, wi, lobe.eta, mode);
            (drawn.weight * (factor / probability), drawn.pdf * probability)
        } else {
            let pdf = self.pdf(set, wi);
            (self.eval(set, wi, mode) / pdf, pdf)
        };
        (pdf > 0.0 && pdf.is_finite() && weight.is_finite()).then_some(BsdfSample {
            wi,
            weight,
            pdf,
            kind: drawn.kind,
            eta,
        })
    }

    /// Whether [`sample`](Self::sample) with this set reads no random number: there is one direction, or none.
    #[inline]
    pub fn is_certain(&self, set: LobeSet) -> bool {
        !self.has(set) || self.only(set).is_some_and(|lobe| LobeSet::DELTA.contains(lobe.set))
    }

    /// The lobe that alone has a part in the set.
    #[inline]
    fn only(&self, set: LobeSet) -> Option<&Lobe> {
        let mut lobes = self.lobes().iter().filter(|lobe| lobe.set.intersects(set));
        let first = lobes.next();
        first.filter(|_| lobes.next().is_none())
    }

    /// Chooses a lobe; also its probability and the random number stretched back to 0..1.
    #[inline]
    fn choose(&self, set: LobeSet, u: f32) -> Option<(&Lobe, f32, f32)> {
        if let [lobe] = self.lobes() {
            return (lobe.importance(set) > 0.0).then_some((lobe, 1.0, u));
        }
        let total: f32 = self.lobes().iter().map(|lobe| lobe.importance(set)).sum();
        if !(total > 0.0) {
            return None;
        }
        let mut rest = u * total;
        let mut chosen = None;
        for lobe in self.lobes() {
            let importance = lobe.importance(set);
            if importance <= 0.0 {
                continue;
            }
            // The last lobe with a share takes what rounding leaves over.
            chosen = Some((lobe, importance / total, (rest / importance).clamp(0.0, 1.0 - f32::EPSILON / 2.0)));
            if rest < importance {
                break;
            }
            rest -= importance;
        }
        chosen
    }

    /// The one direction of a delta lobe, its weight, and the index on its side over that on the side of `wo`.
    fn delta_child(&self, lobe: &Lobe, mode: TransportMode) -> (Vec3, Vec3, f32) {
        let frame = &self.frames[usize::from(lobe.frame)];
        let wo = frame.wo;
        let is_transmission = matches!(lobe.kind, LobeKind::DeltaTransmission);
        let (local, wi) = if !is_transmission {
            let local = Vec3::new(-wo.x, -wo.y, wo.z);
            (local, self.pushed_to_side(frame.axes.to_world(local), 1.0))
        } else if lobe.eta == 1.0 {
            (-wo, -self.wo)
        } else {
            let (_, cos_t) = fresnel_dielectric(wo.z, lobe.eta);
            let local = refract(wo, Vec3::Z, lobe.eta, cos_t);
            (local, self.pushed_to_side(frame.axes.to_world(local), -1.0))
        };
        let eta = if is_transmission { lobe.eta } else { 1.0 };
        (wi, lobe.weight * self.mode_factor(frame, local, wi, lobe.eta, mode), eta)
    }

    /// A single direction cannot be drawn anew: where interpolated normals bend it to the wrong side of the surface it is
    /// moved just past the horizon, instead of leaving a black edge.
    fn pushed_to_side(&self, wi: Vec3, sign: f32) -> Vec3 {
        const LEAST_COSINE: f32 = 1e-4;
        let cos = self.ng.dot(wi) * sign;
        if cos >= LEAST_COSINE {
            return wi;
        }
        (wi + self.ng * (sign * (LEAST_COSINE - cos))).normalize()
    }

    /// Estimate of the share of light from `wo` that the lobes in `set` scatter, per channel, 0 to 1.
    pub fn albedo(&self, set: LobeSet) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for lobe in self.lobes() {
            let shared = lobe.set & set;
            if shared.intersects(LobeSet::REFLECTION) {
                sum += lobe.albedo[0];
            }
            if shared.intersects(LobeSet::TRANSMISSION) {
                sum += lobe.albedo[1];
            }
        }
        sum.clamp(Vec3::ZERO, Vec3::ONE)
    }
}

/// `a / b`, bounded.
#[inline]
fn bounded_ratio(a: f32, b: f32) -> f32 {
    if a < MAX_NORMAL_CORRECTION * b { a / b } else { MAX_NORMAL_CORRECTION }
}
