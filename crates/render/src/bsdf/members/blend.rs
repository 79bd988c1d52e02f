//! A mixture of two materials.

use crate::bsdf::builder::{Builder, Place};
use photinus_scene::{FloatInput, MaterialId};

pub fn add(builder: &mut Builder, place: Place, weight: FloatInput, a: MaterialId, b: MaterialId) {
    let weight = builder.share(weight);
    for (material, share) in [(a, 1.0 - weight), (b, weight)] {
        if share > 0.0 {
            builder.nest(material, Place { share: place.share * share, ..place });
        }
    }
}
