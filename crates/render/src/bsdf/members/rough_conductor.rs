//! Brushed metal: reflection by microfacets of a complex index.

use super::conductor::add as add_smooth;
use crate::bsdf::builder::{Builder, Place, reflection_kind};
use crate::bsdf::fresnel::fresnel_conductor;
use crate::bsdf::lobe::LobeKind;
use crate::bsdf::lobes::{FacetFresnel, MicrofacetReflection};
use crate::bsdf::microfacet::{Microfacets, is_mirror};
use crate::bsdf::{GATHER_ALPHA, SurfaceModel};
use photinus_geometry::Vec3;
use photinus_scene::Material;

pub fn add(builder: &mut Builder, place: Place, material: &Material) {
    let Material::RoughConductor { model, alpha, eta, k, specular_reflectance } = *material else { return };
    if !place.front {
        return;
    }
    let alpha = alpha.map(|a| builder.number(a));
    let facets = Microfacets::new(model, alpha);
    let fixed = builder.model() == SurfaceModel::Fixed;
    if is_mirror(alpha) || (fixed && facets.mean_alpha() < GATHER_ALPHA) {
        return add_smooth(builder, place, eta, k, specular_reflectance);
    }
    let (eta, k) = (builder.positive(eta), builder.positive(k));
    let f0 = fresnel_conductor(1.0, eta, k);
    let color = builder.factor(place, specular_reflectance);
    if fixed {
        return builder.lambert(place, color * f0);
    }
    let shape = MicrofacetReflection { facets, fresnel: FacetFresnel::Conductor { eta, k } };
    push(builder, place, shape, f0, color);
}

/// Adds a reflecting lobe whose reflectance at normal incidence is `f0`.
pub fn push(builder: &mut Builder, place: Place, shape: MicrofacetReflection, f0: Vec3, weight: Vec3) {
    let alpha = shape.facets.mean_alpha();
    let place = builder.specular(place);
    let cos = builder.wo(place).z;
    let reflectance = builder
        .materials
        .split_sum(shape.facets.model)
        .map_or(f0, |table| table.reflectance(shape.facets.table_alpha(), cos, f0));
    let albedo = [reflectance * weight, Vec3::ZERO];
    builder.push(place, LobeKind::Reflection(shape), reflection_kind(alpha), weight, albedo, 1.0);
}
