//! Lambertian reflection: f = albedo / pi on the outside.

use crate::bsdf::builder::{Builder, Place};
use photinus_scene::ColorInput;

pub fn add(builder: &mut Builder, place: Place, reflectance: ColorInput) {
    if place.front {
        builder.lambert(place, builder.factor(place, reflectance));
    }
}
