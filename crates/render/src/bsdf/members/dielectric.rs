//! Smooth glass: Fresnel's reflection and refraction, total reflection included.

use crate::bsdf::SurfaceModel;
use crate::bsdf::builder::{Builder, Place};
use crate::bsdf::fresnel::fresnel_dielectric;
use photinus_scene::ColorInput;

/// Relative indices nearer to 1 than this bend nothing that single precision could tell from straight on.
const INDEX_MATCHED: f32 = 1e-4;

/// Index inside over index outside; 1 where either is not a positive number.
pub fn relative_index([int_ior, ext_ior]: [f32; 2]) -> f32 {
    let eta = int_ior / ext_ior;
    if !(eta.is_finite() && eta > 1e-3 && int_ior > 0.0) || (eta - 1.0).abs() < INDEX_MATCHED { 1.0 } else { eta }
}

/// Index on the other side over index on the side of `wo`.
pub fn eta_from_side(place: Place, iors: [f32; 2]) -> f32 {
    let eta = relative_index(iors);
    if place.front { eta } else { 1.0 / eta }
}

/// Reflectance at normal incidence, the fixed coefficient where Fresnel's equations are bypassed.
pub fn normal_reflectance(eta: f32) -> f32 {
    let r = (eta - 1.0) / (eta + 1.0);
    r * r
}

pub fn add(builder: &mut Builder, place: Place, iors: [f32; 2], reflectance: ColorInput, transmittance: ColorInput) {
    let place = builder.specular(place);
    let eta = eta_from_side(place, iors);
    let (exact, _) = fresnel_dielectric(builder.wo(place).z, eta);
    let f = match builder.model() {
        SurfaceModel::Physical => exact,
        // Beyond the critical angle there is no refracted direction to send light to.
        SurfaceModel::Fixed => {
            if exact < 1.0 {
                normal_reflectance(eta)
            } else {
                1.0
            }
        }
    };
    let reflected = builder.factor(place, reflectance) * f;
    let transmitted = builder.factor(place, transmittance) * (1.0 - f);
    builder.delta_reflection(place, reflected);
    builder.delta_transmission(place, transmitted, eta);
}
