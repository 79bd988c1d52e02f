//! Normals read from a texture.

use crate::bsdf::builder::{Builder, Place};
use photinus_geometry::{Frame, Vec3};
use photinus_scene::{ColorInput, MaterialId, TextureId};

/// (r, g, b) = (n + 1) / 2 in the frame of dp/du and the shading normal.
pub fn add(builder: &mut Builder, place: Place, normals: TextureId, nested: MaterialId) {
    let c = builder.materials.textures().color(ColorInput::Texture(normals), &builder.lookup);
    let local = c * 2.0 - Vec3::ONE;
    let length_sq = local.length_squared();
    if !(length_sq > 1e-6) || !length_sq.is_finite() {
        return builder.nest(nested, place);
    }
    let frame = Frame::from_normal_and_tangent(builder.axes(place).n * builder.side, builder.point.dp_du);
    let n = frame.to_world(local / length_sq.sqrt());
    let place = builder.tilted(place, n * builder.side);
    builder.nest(nested, place);
}
