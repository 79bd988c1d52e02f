//! Polished metal: a mirror with Fresnel's reflectance of a complex index.

use crate::bsdf::SurfaceModel;
use crate::bsdf::builder::{Builder, Place};
use crate::bsdf::fresnel::fresnel_conductor;
use photinus_scene::ColorInput;

pub fn add(builder: &mut Builder, place: Place, eta: ColorInput, k: ColorInput, reflectance: ColorInput) {
    if !place.front {
        return;
    }
    let place = builder.specular(place);
    let cos = match builder.model() {
        SurfaceModel::Physical => builder.wo(place).z,
        SurfaceModel::Fixed => 1.0,
    };
    let f = fresnel_conductor(cos, builder.positive(eta), builder.positive(k));
    builder.delta_reflection(place, builder.factor(place, reflectance) * f);
}
