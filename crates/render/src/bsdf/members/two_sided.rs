//! One material on either side, each seen from its own outside.

use crate::bsdf::builder::{Builder, Place};
use photinus_scene::MaterialId;

pub fn add(builder: &mut Builder, place: Place, front: MaterialId, back: MaterialId) {
    let side = if place.front { front } else { back };
    builder.nest(side, Place { front: true, ..place });
}
