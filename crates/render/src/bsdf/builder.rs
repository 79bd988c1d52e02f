//! Collects the lobes of a material and of what it is made of.

use super::lobe::{Lobe, LobeKind};
use super::materials::Materials;
use super::microfacet::reflect;
use super::recipe::Recipe;
use super::scattering::{Bsdf, MAX_FRAMES, MAX_LOBES, ShadingFrame};
use super::{GATHER_ALPHA, LobeSet, SurfaceModel};
use crate::SurfacePoint;
use crate::texture::TextureLookup;
use photinus_geometry::{Frame, Vec3};
use photinus_scene::{ColorInput, FloatInput, MaterialId};

/// Materials nested deeper than this are mid-grey: a file may nest without end, and blends double at every level.
const MAX_DEPTH: u8 = 8;

/// Least cosine between `wo` and a shading normal.
const LEAST_COSINE: f32 = 1e-3;

/// Where in the tree of nested materials a member is asked for its lobes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Share of the surface that is made of it.
    pub share: f32,
    /// Whether `wo` is on its outside.
    pub front: bool,
    /// Index of its shading frame.
    pub frame: u8,
    /// Materials around it.
    pub depth: u8,
}

/// What members put their lobes into.
pub(super) struct Builder<'a> {
    pub materials: &'a Materials,
    pub point: &'a SurfacePoint,
    pub lookup: TextureLookup,
    /// 1 where `wo` is on the side of the outward normal, -1 otherwise.
    pub side: f32,
    bsdf: &'a mut Bsdf,
    /// Share of the surface that is there at all: masks lower it.
    solid: f32,
}

impl<'a> Builder<'a> {
    /// Resolves `material` at `point` for `wo` in place of what `bsdf` was.
    pub fn resolve(
        materials: &'a Materials,
        material: MaterialId,
        point: &'a SurfacePoint,
        wo: Vec3,
        bsdf: &'a mut Bsdf,
    ) {
        let side = if point.geometric_normal.dot(wo) < 0.0 { -1.0 } else { 1.0 };
        let ng = point.geometric_normal * side;
        let ns = usable_normal(point.normal * side, ng, wo);
        let axes = sided_frame(ns, point.dp_du, side);
        let frame = ShadingFrame { axes, wo: local_wo(&axes, wo), bump_alpha_sq: 0.0, is_flat: ns == ng };
        (bsdf.wo, bsdf.ng, bsdf.ns, bsdf.shading_normal) = (wo, ng, ns, ns);
        bsdf.frames.clear();
        bsdf.frames.push(frame);
        bsdf.lobes.clear();
        bsdf.kinds = LobeSet::NONE;
        let mut builder = Builder { materials, point, lookup: point.lookup(), side, bsdf, solid: 0.0 };
        let place = Place { share: 1.0, front: side > 0.0, frame: 0, depth: 0 };
        match materials.recipe(material, place.front) {
            Some(recipe) => builder.follow(recipe, place),
            None => {
                builder.add(material, place);
                builder.finish();
            }
        }
    }

    /// Copies the lobes of a recipe.
    #[inline]
    fn follow(&mut self, recipe: &Recipe, place: Place) {
        self.bsdf.lobes.extend(recipe.lobes.iter().copied());
        self.bsdf.kinds = recipe.kinds;
        if recipe.kinds.intersects(LobeSet::DELTA) {
            let frame = self.specular(place).frame;
            let single = self.bsdf.lobes.iter_mut().filter(|lobe| LobeSet::DELTA.contains(lobe.set));
            single.for_each(|lobe| lobe.frame = frame);
        }
    }

    /// Adds the lobes of a nested material.
    pub fn nest(&mut self, material: MaterialId, place: Place) {
        let place = Place { depth: place.depth + 1, ..place };
        if place.depth > MAX_DEPTH {
            self.occupy(place);
            self.lambert(place, Vec3::splat(0.5));
        } else {
            self.add(material, place);
        }
    }

    fn add(&mut self, material: MaterialId, place: Place) {
        if place.share > 0.0 {
            super::members::add(self, self.materials.material(material), place);
        }
    }

    /// Says that the share at `place` is solid; every material without further nesting does.
    pub fn occupy(&mut self, place: Place) {
        self.solid += place.share;
    }

    /// Scales to what is there: callers meet a surface only after its mask let them.
    fn finish(mut self) {
        if self.solid <= 0.0 {
            let place = Place { share: 1.0, front: true, frame: 0, depth: 0 };
            self.delta_transmission(place, Vec3::ONE, 1.0);
        } else if self.solid < 1.0 {
            for lobe in &mut self.bsdf.lobes {
                lobe.weight /= self.solid;
                lobe.albedo[0] /= self.solid;
                lobe.albedo[1] /= self.solid;
            }
        }
    }

    /// How faithfully to model.
    pub fn model(&self) -> SurfaceModel {
        self.materials.model()
    }

    /// A factor on light, 0 where it is negative or not a number. It may exceed 1 as far as the place's share makes up for
    /// it (blends that stand for sums), so that no lobe sends out more than it gets.
    pub fn factor(&self, place: Place, input: ColorInput) -> Vec3 {
        let c = self.materials.textures().color(input, &self.lookup);
        let most = 1.0 / place.share;
        let sane = |x: f32| if x > 0.0 { x.min(most) } else { 0.0 };
        Vec3::new(sane(c.x), sane(c.y), sane(c.z))
    }

    /// A colour without upper bound (indices of refraction): 0 where it is negative or not finite.
    pub fn positive(&self, input: ColorInput) -> Vec3 {
        let c = self.materials.textures().color(input, &self.lookup);
        let sane = |x: f32| if x.is_finite() { x.max(0.0) } else { 0.0 };
        Vec3::new(sane(c.x), sane(c.y), sane(c.z))
    }

    /// A share within 0..1, 0 where it is not a number.
    pub fn share(&self, input: FloatInput) -> f32 {
        unit(self.materials.textures().float(input, &self.lookup))
    }

    /// A roughness as given.
    pub fn number(&self, input: FloatInput) -> f32 {
        self.materials.textures().float(input, &self.lookup)
    }

    /// `wo` in the frame of `place`.
    pub fn wo(&self, place: Place) -> Vec3 {
        self.bsdf.frames[usize::from(place.frame)].wo
    }

    /// Shading axes of `place`, z on the side of `wo`.
    pub fn axes(&self, place: Place) -> Frame {
        self.bsdf.frames[usize::from(place.frame)].axes
    }

    /// The place below a bump or normal map: `n` is the new unit normal on the side of `wo`.
    ///
    /// A normal that turns away from `wo` belongs to the hidden side of a bump; as in Mitsuba the opposite slope stands in
    /// for it, which `wo` does see.
    pub fn tilted(&mut self, place: Place, n: Vec3) -> Place {
        let smooth = self.axes(place).n;
        let n = if n.dot(self.bsdf.wo) > 0.0 { n } else { reflect(n, smooth) };
        let bent = usable_normal(n, self.bsdf.ng, self.bsdf.wo);
        let axes = sided_frame(bent, self.point.dp_du, self.side);
        let cos = self.bsdf.ns.dot(bent).clamp(1e-3, 1.0);
        let tan_sq = (1.0 - cos * cos) / (cos * cos);
        // Estevez et al. 2019: an eighth of the squared slope is the roughness of the bumps, at most 1.
        let bump_alpha_sq = (0.125 * tan_sq).min(1.0);
        let frame = ShadingFrame { axes, wo: local_wo(&axes, self.bsdf.wo), bump_alpha_sq, is_flat: false };
        self.bsdf.shading_normal = axes.n;
        self.add_frame(place, frame)
    }

    /// The same place for mirrors and microfacets: where the normal would mirror `wo` to below the geometric surface,
    /// which leaves black edges on coarse meshes, the normal that mirrors it just above takes over.
    pub fn specular(&mut self, place: Place) -> Place {
        let (ng, wo) = (self.bsdf.ng, self.bsdf.wo);
        let frame = self.bsdf.frames[usize::from(place.frame)];
        let mirrored = reflect(wo, frame.axes.n);
        let least = LEAST_COSINE.min(0.5 * ng.dot(wo));
        let cos = ng.dot(mirrored);
        if cos >= least {
            return place;
        }
        let lifted = mirrored + ng * (least - cos);
        let n = (wo + lifted.normalize_or(ng)).normalize_or(ng);
        let axes = sided_frame(n, frame.axes.s, self.side);
        self.add_frame(place, ShadingFrame { axes, wo: local_wo(&axes, wo), is_flat: false, ..frame })
    }

    /// The place with a frame of its own, or with an equal one that is there; the last one takes all where they run out.
    fn add_frame(&mut self, place: Place, frame: ShadingFrame) -> Place {
        let frames = &mut self.bsdf.frames;
        let known = frames.iter().position(|other| *other == frame);
        let index = known.unwrap_or(frames.len().min(MAX_FRAMES - 1));
        if index == frames.len() {
            frames.push(frame);
        }
        Place { frame: index as u8, ..place }
    }

    /// Lambertian reflection.
    #[inline]
    pub fn lambert(&mut self, place: Place, albedo: Vec3) {
        self.push(place, LobeKind::Lambert, LobeSet::DIFFUSE_REFLECTION, albedo, [albedo, Vec3::ZERO], 1.0);
    }

    /// Lambertian transmission into a medium of relative index `eta`.
    pub fn lambert_transmission(&mut self, place: Place, albedo: Vec3, eta: f32) {
        let albedos = [Vec3::ZERO, albedo];
        self.push(place, LobeKind::LambertTransmission, LobeSet::DIFFUSE_TRANSMISSION, albedo, albedos, eta);
    }

    /// A mirror.
    pub fn delta_reflection(&mut self, place: Place, weight: Vec3) {
        self.push(place, LobeKind::DeltaReflection, LobeSet::DELTA_REFLECTION, weight, [weight, Vec3::ZERO], 1.0);
    }

    /// A smooth interface to a medium of relative index `eta`, crossed.
    pub fn delta_transmission(&mut self, place: Place, weight: Vec3, eta: f32) {
        self.push(place, LobeKind::DeltaTransmission, LobeSet::DELTA_TRANSMISSION, weight, [Vec3::ZERO, weight], eta);
    }

    /// Any lobe; `weight` and `albedo` are still to be scaled by the place's share.
    #[inline]
    pub fn push(&mut self, place: Place, kind: LobeKind, set: LobeSet, weight: Vec3, albedo: [Vec3; 2], eta: f32) {
        if weight.max_element() <= 0.0 || !weight.is_finite() {
            return;
        }
        let albedo = albedo.map(|a| (a * place.share).clamp(Vec3::ZERO, Vec3::ONE));
        let lobe = Lobe { kind, set, weight: weight * place.share, albedo, eta, frame: place.frame };
        if !self.bsdf.lobes.is_empty() && self.merge(&lobe) {
            return;
        }
        if self.bsdf.lobes.is_full() {
            return self.fold(albedo);
        }
        self.bsdf.lobes.push(lobe);
        self.bsdf.kinds |= set;
    }

    /// Makes room where there is none: keeps the energy of one more lobe, gives up the shape. The last lobe becomes the
    /// diffuse one.
    #[cold]
    fn fold(&mut self, albedo: [Vec3; 2]) {
        let last = &mut self.bsdf.lobes[MAX_LOBES - 1];
        let sum = last.albedo[0] + last.albedo[1] + albedo[0] + albedo[1];
        last.kind = LobeKind::Lambert;
        last.set = LobeSet::DIFFUSE_REFLECTION;
        (last.weight, last.albedo, last.eta) = (sum, [sum, Vec3::ZERO], 1.0);
        self.bsdf.kinds = self.bsdf.lobes.iter().fold(LobeSet::NONE, |kinds, lobe| kinds | lobe.set);
    }

    /// Adds shapes without parameters to an equal one that is already there.
    fn merge(&mut self, lobe: &Lobe) -> bool {
        let same = |other: &&mut Lobe| {
            let shape = matches!(
                (&other.kind, &lobe.kind),
                (LobeKind::Lambert, LobeKind::Lambert)
                    | (LobeKind::LambertTransmission, LobeKind::LambertTransmission)
                    | (LobeKind::DeltaReflection, LobeKind::DeltaReflection)
                    | (LobeKind::DeltaTransmission, LobeKind::DeltaTransmission)
            );
            shape && other.frame == lobe.frame && other.eta == lobe.eta
        };
        let Some(other) = self.bsdf.lobes.iter_mut().find(same) else { return false };
        other.weight += lobe.weight;
        other.albedo[0] += lobe.albedo[0];
        other.albedo[1] += lobe.albedo[1];
        true
    }
}

/// Kind of a reflecting lobe of this roughness.
pub(super) fn reflection_kind(alpha: f32) -> LobeSet {
    if alpha >= GATHER_ALPHA { LobeSet::ROUGH_REFLECTION } else { LobeSet::GLOSSY_REFLECTION }
}

/// Kind of a transmitting lobe of this roughness.
pub(super) fn transmission_kind(alpha: f32) -> LobeSet {
    if alpha >= GATHER_ALPHA { LobeSet::ROUGH_TRANSMISSION } else { LobeSet::GLOSSY_TRANSMISSION }
}

fn unit(x: f32) -> f32 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

/// `wo` in local coordinates, kept off the horizon and of unit length.
#[inline]
fn local_wo(axes: &Frame, wo: Vec3) -> Vec3 {
    let v = axes.to_local(wo);
    if v.z > 0.5 * LEAST_COSINE { v } else { Vec3::new(v.x, v.y, 0.5 * LEAST_COSINE).normalize_or(Vec3::Z) }
}

/// Axes around `n`, which is on the side of `wo`; the outward frame is right-handed. Where nothing reads tangents there is
/// none, and any axes will do.
#[inline]
fn sided_frame(n: Vec3, tangent: Vec3, side: f32) -> Frame {
    let outward = if tangent == Vec3::ZERO {
        Frame::from_normal(n * side)
    } else {
        Frame::from_normal_and_tangent(n * side, tangent)
    };
    Frame { s: outward.s, t: outward.t, n }
}

/// A shading normal that agrees with the geometric one on the side and lets `wo` see its front: interpolated and bumped
/// normals turn away from the viewer near silhouettes, where they would be black. Bent as little as needed. Both normals
/// are on the side of `wo`.
#[inline]
fn usable_normal(n: Vec3, ng: Vec3, wo: Vec3) -> Vec3 {
    let mut n = n;
    let geometric = n.dot(ng);
    // What is not finite is outside too, and becomes the geometric normal.
    if !(LEAST_COSINE..2.0).contains(&geometric) {
        n = (n + ng * (LEAST_COSINE - geometric)).normalize_or(ng);
    }
    let cos = n.dot(wo);
    if cos < LEAST_COSINE {
        n = (n + wo * (LEAST_COSINE - cos)).normalize_or(ng);
    }
    n
}
