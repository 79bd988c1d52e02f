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
    let base = builder.factor(place, diffuse_reflectance);
    let specular = builder.factor(place, specular_reflectance);
    if builder.model() == SurfaceModel::Fixed {
        let f = normal_reflectance(eta);
        let mirror = builder.specular(place);
        builder.delta_reflection(mirror, specular * f);
        builder.lambert(place, base * (1.0 - f));
        return;
    }
    let mirror = builder.specular(place);
    let f = fresnel_dielectric(builder.wo(mirror).z, eta).0;
    builder.delta_reflection(mirror, specular * f);
    let means = CoatMeans {
        transmittance: 1.0 - builder.materials.diffuse_reflectance(eta),
        internal_reflectance: builder.materials.diffuse_reflectance(1.0 / eta),
    };
    let shape = CoatedDiffuse { transmittance: CoatTransmittance::Smooth { eta }, inv_eta_sq: 1.0 / (eta * eta) };
    push_base(builder, place, shape, means, base, nonlinear);
}

/// A coat under diffuse light.
pub struct CoatMeans {
    /// What passes from outside.
    pub transmittance: f32,
    /// What is reflected back inside.
    pub internal_reflectance: f32,
}

/// Adds the base under a coat: after all inter-reflections with the coat's inside the base sends out
/// albedo / (1 - internal reflectance * albedo) of what first left it; the colour shift of the denominator is left out
/// where `nonlinear` is false.
pub fn push_base(
    builder: &mut Builder,
    place: Place,
    shape: CoatedDiffuse,
    means: CoatMeans,
    base: Vec3,
    nonlinear: bool,
) {
    let inside = means.internal_reflectance;
    let kept = if nonlinear { base.min(Vec3::ONE) * inside } else { Vec3::splat(inside) };
    let weight = base / (Vec3::ONE - kept).max(Vec3::splat(1e-4));
    let albedo = weight * (means.transmittance * shape.inv_eta_sq * shape.transmittance(builder.wo(place).z));
    builder.push(place, LobeKind::Coated(shape), LobeSet::DIFFUSE_REFLECTION, weight, [albedo, Vec3::ZERO], 1.0);
}
