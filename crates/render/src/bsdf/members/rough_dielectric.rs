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
    let reflectance = builder.factor(place, specular_reflectance);
    let transmittance = builder.factor(place, specular_transmittance);
    if fixed {
        let f = normal_reflectance(eta);
        builder.lambert(place, reflectance * f);
        builder.lambert_transmission(place, transmittance * (1.0 - f), eta);
        return;
    }
    let shape = RoughInterface { facets, eta, reflectance, transmittance, tint: InterfaceTint::PLAIN };
    push(builder, place, shape, Vec3::ONE);
}

/// Adds a rough interface. Its albedo comes from the table of plain interfaces, or from the smooth one's where there is
/// none; tinted reflection keeps its ratio to the plain one.
pub fn push(builder: &mut Builder, place: Place, shape: RoughInterface, weight: Vec3) {
    let place = builder.specular(place);
    let cos = builder.wo(place).z;
    let model = shape.facets.model;
    let plain = fresnel_dielectric(cos, shape.eta).0;
    let inside = !place.front;
    let relative = if inside { 1.0 / shape.eta } else { shape.eta };
    let table = builder.materials.interface_table(model, relative);
    let [r, t] = table.map_or([plain, 1.0 - plain], |table| table.at(shape.facets.table_alpha(), cos, inside));
    let tinted = shape.tint.reflectance(plain, cos) * (r / plain.max(1e-6));
    let albedo = [tinted * shape.reflectance * weight, shape.transmittance * t * weight];
    let set = {
        let alpha = shape.facets.mean_alpha();
        reflection_kind(alpha) | transmission_kind(alpha)
    };
    builder.push(place, LobeKind::Interface(shape), set, weight, albedo, shape.eta);
}
