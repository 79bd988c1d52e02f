//! The Disney principled model: metal, glass, diffuse base, sheen and clear coat from one set of parameters.

use super::dielectric::normal_reflectance;
use super::{rough_conductor, rough_dielectric};
use crate::bsdf::builder::{Builder, Place};
use crate::bsdf::fresnel::{fresnel_dielectric, schlick_weight};
use crate::bsdf::lobe::LobeKind;
use crate::bsdf::lobes::{
    Clearcoat, FacetFresnel, InterfaceTint, MicrofacetReflection, PrincipledDiffuse, RoughInterface,
};
use crate::bsdf::microfacet::{Microfacets, is_mirror};
use crate::bsdf::{GATHER_ALPHA, LobeSet, SurfaceModel};
use crate::texture::luminance;
use photinus_geometry::Vec3;
use photinus_scene::{Material, MicrofacetModel};

/// The index, kept off 1, which leaves facets nothing to refract at.
pub fn relative_index(eta: f32) -> f32 {
    if eta.is_finite() && eta > 1.001 { eta } else { 1.001 }
}

/// The colour with its luminance divided out, white where it is black.
fn tint_of(color: Vec3) -> Vec3 {
    let l = luminance(color);
    if l > 0.0 { color / l } else { Vec3::ONE }
}

/// Burley 2012, section 5.4: roughness squared, stretched by the anisotropy's aspect.
fn alphas(roughness: f32, anisotropic: f32) -> [f32; 2] {
    let aspect = (1.0 - 0.9 * anisotropic).sqrt();
    let alpha = roughness * roughness;
    [alpha / aspect, alpha * aspect]
}

/// Lobes as Mitsuba 3's plug-in weighs them: the base by (1 - metallic)(1 - spec_trans), glass by
/// (1 - metallic) spec_trans, the highlight by its mixed reflectance, the coat by a quarter of its strength.
pub fn add(builder: &mut Builder, place: Place, material: &Material) {
    let Material::Principled {
        base_color,
        roughness,
        anisotropic,
        metallic,
        spec_trans,
        eta,
        spec_tint,
        sheen,
        sheen_tint,
        flatness,
        clearcoat,
        clearcoat_gloss,
    } = *material
    else {
        return;
    };
    let color = builder.factor(place, base_color).min(Vec3::ONE);
    let roughness = builder.share(roughness);
    let metallic = builder.share(metallic);
    let spec_trans = builder.share(spec_trans);
    let glass = (1.0 - metallic) * spec_trans;
    let base = (1.0 - metallic) * (1.0 - spec_trans);
    let index = relative_index(eta);
    let alpha = alphas(roughness, builder.share(anisotropic));
    let facets = Microfacets::new(MicrofacetModel::Ggx, alpha);
    let fixed = builder.model() == SurfaceModel::Fixed;

    if !place.front {
        if glass > 0.0 {
            let mirror = is_mirror(alpha) || (fixed && facets.mean_alpha() < GATHER_ALPHA);
            let place = builder.specular(place);
            let side = Specular { facets, mirror, fixed, eta: 1.0 / index, tint: InterfaceTint::PLAIN };
            side.add(builder, place, Vec3::splat(glass), color.map_sqrt() * glass);
        }
        return;
    }

    let spec_tint = builder.share(spec_tint);
    let tinted = tint_of(color) * normal_reflectance(index);
    let (metal, tinted_share) = (metallic, (1.0 - metallic) * spec_tint);
    let tint = InterfaceTint {
        plain: (1.0 - metallic) * (1.0 - spec_tint),
        f0: color * metal + tinted * tinted_share,
        f90_minus_f0: (Vec3::ONE - color) * metal + (Vec3::ONE - tinted) * tinted_share,
    };
    let mirror = is_mirror(alpha) || (fixed && facets.mean_alpha() < GATHER_ALPHA);
    let specular = Specular { facets, mirror, fixed, eta: index, tint };
    let specular_place = builder.specular(place);
    specular.add(builder, specular_place, Vec3::ONE, color.map_sqrt() * glass);

    let sheen = builder.share(sheen) * (1.0 - metallic);
    let sheen_color = Vec3::ONE + (tint_of(color) - Vec3::ONE) * builder.share(sheen_tint);
    let flatness = builder.share(flatness);
    let coat = builder.share(clearcoat);
    let gloss = builder.share(clearcoat_gloss);
    if fixed {
        let rest = 1.0 - normal_reflectance(index);
        return builder.lambert(place, color * (base * rest));
    }
    if base > 0.0 || sheen > 0.0 {
        let shape = PrincipledDiffuse { color: color * base, sheen: sheen_color * sheen, roughness, flatness };
        let albedo = diffuse_albedo(&shape, builder.wo(place).z);
        let kind = LobeKind::Principled(shape);
        builder.push(place, kind, LobeSet::DIFFUSE_REFLECTION, Vec3::ONE, [albedo, Vec3::ZERO], 1.0);
    }
    if coat > 0.0 {
        let shape = Clearcoat { alpha: 0.1 + (0.001 - 0.1) * gloss };
        let cos = builder.wo(specular_place).z;
        let weight = Vec3::splat(0.25 * coat);
        let albedo = weight * (0.04 + 0.96 * schlick_weight(cos));
        let kind = LobeKind::Clearcoat(shape);
        builder.push(specular_place, kind, LobeSet::GLOSSY_REFLECTION, weight, [albedo, Vec3::ZERO], 1.0);
    }
}

/// The main highlight and what it lets through.
struct Specular {
    facets: Microfacets,
    mirror: bool,
    fixed: bool,
    /// Index on the other side over index on this side.
    eta: f32,
    tint: InterfaceTint,
}

impl Specular {
    fn add(self, builder: &mut Builder, place: Place, reflectance: Vec3, transmittance: Vec3) {
        let cos = builder.wo(place).z;
        let transmits = transmittance.max_element() > 0.0;
        if self.mirror || self.fixed {
            let exact = fresnel_dielectric(cos, self.eta).0;
            let f = if self.fixed && exact < 1.0 { normal_reflectance(self.eta) } else { exact };
            let at = if self.fixed { 1.0 } else { cos };
            let reflected = self.tint.reflectance(f, at) * reflectance;
            let transmitted = transmittance * (1.0 - f);
            if self.mirror {
                builder.delta_reflection(place, reflected);
                builder.delta_transmission(place, transmitted, self.eta);
            } else {
                builder.lambert(place, reflected);
                builder.lambert_transmission(place, transmitted, self.eta);
            }
        } else if transmits {
            let (facets, eta, tint) = (self.facets, self.eta, self.tint);
            let shape = RoughInterface { facets, eta, reflectance, transmittance, tint };
            rough_dielectric::push(builder, place, shape, Vec3::ONE);
        } else {
            let fresnel = FacetFresnel::Principled { eta: self.eta, tint: self.tint };
            let f0 = self.tint.reflectance(normal_reflectance(self.eta), 1.0);
            let shape = MicrofacetReflection { facets: self.facets, fresnel };
            rough_conductor::push(builder, place, shape, f0, reflectance);
        }
    }
}

/// Estimate of the base's directional albedo, to share out samples among the lobes: the cosine of the difference angle is
/// replaced by its mean square, 1/2 + cos / 3, and the mean of Schlick's weight under a cosine is 1 / 21.
fn diffuse_albedo(shape: &PrincipledDiffuse, cos: f32) -> Vec3 {
    const MEAN_WEIGHT: f32 = 1.0 / 21.0;
    let f = schlick_weight(cos);
    let retro = 2.0 * shape.roughness * (0.5 + cos / 3.0);
    let diffuse =
        (1.0 - 0.5 * f) * (1.0 - 0.5 * MEAN_WEIGHT) + retro * (f + MEAN_WEIGHT + f * MEAN_WEIGHT * (retro - 1.0));
    // The mean of 1 / (cos + cos_i) under a cosine is 2 (1 - cos ln(1 + 1 / cos)).
    let inverse = 2.0 * (1.0 - cos * libm::logf(1.0 + 1.0 / cos.max(1e-3)));
    let fss = (1.0 + (0.5 * retro - 1.0) * f) * (1.0 + (0.5 * retro - 1.0) * MEAN_WEIGHT);
    let flat = 1.25 * (fss * (inverse - 0.5) + 0.5);
    // The sheen's albedo, 0.088 at grazing and next to nothing head on, fitted to quadrature within 0.004.
    let sheen = 0.088 * libm::powf(1.0 - cos, 2.6);
    shape.color * (diffuse + (flat - diffuse) * shape.flatness) + shape.sheen * sheen
}

/// Square root per channel.
trait MapSqrt {
    fn map_sqrt(self) -> Self;
}

impl MapSqrt for Vec3 {
    fn map_sqrt(self) -> Self {
        Self::new(self.x.sqrt(), self.y.sqrt(), self.z.sqrt())
    }
}
