//! Ground glass: reflection and refraction by microfacets.

use super::dielectric::{add as add_smooth, eta_from_side, normal_reflectance};
use crate::bsdf::builder::{Builder, Place, reflection_kind, transmission_kind};
use crate::bsdf::fresnel::fresnel_dielectric;
use crate::bsdf::lobe::LobeKind;
use crate::bsdf::lobes::{InterfaceTint, RoughInterface};
use crate::bsdf::microfacet::{Microfacets, is_mirror};
use crate::bsdf::{GATHER_ALPHA, SurfaceModel};
use photinus_geometry::Vec3;
use photinus_scene::Material;

pub fn add(builder: &mut Builder, place: Place, material: &Material) {
    let Material::RoughDielectric { model, alpha, int_ior, ext_ior, specular_reflectance, specular_transmittance } =
        *material
    else {
        return;
    };
    let alpha = alpha.map(|a| builder.number(a));
    let facets = Microfacets::new(model, alpha);
    let eta = eta_from_side(place, [int_ior, ext_ior]);
    let fixed = builder.model() == SurfaceModel::Fixed;
    // Facets between equal media turn no ray, however rough.
    if is_mirror(alpha) || eta == 1.0 || (fixed && facets.mean_alpha() < GATHER_ALPHA) {
        return add_smooth(builder, place, [int_ior, ext_ior], specular_reflectance, specular_transmittance);
    }
    let reflectance = builder.factor(specular_reflectance);
    let transmittance = builder.factor(specular_transmittance);
    if fixed {
        let f = normal_reflectance(eta);
        builder.lambert(place, reflectance * f);
        builder.lambert_transmission(place, transmittance * (1.0 - f), eta);
        return;
    }
    let shape = RoughInterface { facets, eta, reflectance, transmittance, tint: InterfaceTint::PLAIN };
    push(builder, place, shape, Vec3::ONE);
}

/// Adds a rough interface; its albedo is estimated by the smooth one's.
pub fn push(builder: &mut Builder, place: Place, shape: RoughInterface, weight: Vec3) {
    let cos = builder.wo(place).z;
    let f = fresnel_dielectric(cos, shape.eta).0;
    let albedo =
        [shape.tint.reflectance(f, cos) * shape.reflectance * weight, shape.transmittance * (1.0 - f) * weight];
    let alpha = shape.facets.mean_alpha();
    let set = reflection_kind(alpha) | transmission_kind(alpha);
    builder.push(place, LobeKind::Interface(shape), set, weight, albedo, shape.eta);
}
