//! Holes: the solid part's lobes at its share.

use crate::bsdf::builder::{Builder, Place};
use photinus_scene::{FloatInput, MaterialId};

pub fn add(builder: &mut Builder, place: Place, opacity: FloatInput, nested: MaterialId) {
    let share = place.share * builder.share(opacity);
    if share > 0.0 {
        builder.nest(nested, Place { share, ..place });
    }
}
