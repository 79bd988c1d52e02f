//! A thin pane: both interfaces and all inter-reflections between them, no bending.

use super::dielectric::{normal_reflectance, relative_index};
use crate::bsdf::SurfaceModel;
use crate::bsdf::builder::{Builder, Place};
use crate::bsdf::fresnel::fresnel_dielectric;
use photinus_scene::ColorInput;

/// With R of one interface, the geometric series R + T R T + T R^3 T + ... is 2 R / (1 + R); the rest, 2 n / (n^2 + 1) at
/// normal incidence, goes straight on.
pub fn add(builder: &mut Builder, place: Place, iors: [f32; 2], reflectance: ColorInput, transmittance: ColorInput) {
    let place = builder.specular(place);
    let eta = relative_index(iors);
    let one = match builder.model() {
        SurfaceModel::Physical => fresnel_dielectric(builder.wo(place).z, eta).0,
        SurfaceModel::Fixed => normal_reflectance(eta),
    };
    let pane = 2.0 * one / (1.0 + one);
    let reflected = builder.factor(place, reflectance) * pane;
    let transmitted = builder.factor(place, transmittance) * (1.0 - pane);
    builder.delta_reflection(place, reflected);
    builder.delta_transmission(place, transmitted, 1.0);
}
