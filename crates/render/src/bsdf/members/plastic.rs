//! A diffuse base under a smooth dielectric coat.

use super::dielectric::{normal_reflectance, relative_index};
use crate::bsdf::builder::{Builder, Place};
use crate::bsdf::fresnel::fresnel_dielectric;
use crate::bsdf::lobe::LobeKind;
use crate::bsdf::lobes::{CoatTransmittance, CoatedDiffuse};
use crate::bsdf::{LobeSet, SurfaceModel};
use photinus_geometry::Vec3;
use photinus_scene::Material;

pub fn add(builder: &mut Builder, place: Place, material: &Material) {
    let Material::Plastic { int_ior, ext_ior, diffuse_reflectance, specular_reflectance, nonlinear } = *material else {
        return;
    };
    if !place.front {
        return;
    }
    let eta = relative_index([int_ior, ext_ior]);
    let base = builder.factor(diffuse_reflectance);
    let specular = builder.factor(specular_reflectance);
    if builder.model() == SurfaceModel::Fixed {
        let f = normal_reflectance(eta);
        builder.delta_reflection(place, specular * f);
        builder.lambert(place, base * (1.0 - f));
        return;
    }
    let f = fresnel_dielectric(builder.wo(place).z, eta).0;
    builder.delta_reflection(place, specular * f);
    let inside = builder.materials.diffuse_reflectance(1.0 / eta);
    let shape = CoatedDiffuse { transmittance: CoatTransmittance::Smooth { eta }, inv_eta_sq: 1.0 / (eta * eta) };
    push_base(builder, place, shape, base, inside, nonlinear);
}

/// Adds the base under a coat that reflects the share `inside` of diffuse light back to it: after all inter-reflections
/// the base sends out albedo / (1 - inside * albedo) of what first left it; the colour shift of the denominator is left
/// out where `nonlinear` is false.
pub fn push_base(builder: &mut Builder, place: Place, shape: CoatedDiffuse, base: Vec3, inside: f32, nonlinear: bool) {
    let lost = if nonlinear { base * inside } else { Vec3::splat(inside) };
    let weight = base / (Vec3::ONE - lost).max(Vec3::splat(1e-4));
    // Integrated over wi, T(wi) cos / (pi eta^2) is 1 - inside.
    let albedo = weight * ((1.0 - inside) * shape.transmittance(builder.wo(place).z));
    builder.push(place, LobeKind::Coated(shape), LobeSet::DIFFUSE_REFLECTION, weight, [albedo, Vec3::ZERO], 1.0);
}
