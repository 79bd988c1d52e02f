//! Normals tilted by the slope of a height texture.

use crate::bsdf::builder::{Builder, Place};
use photinus_scene::{MaterialId, TextureId};

/// Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978: the tangents of the displaced surface, to first order
/// dp/du + n dh/du, taken in the tangent plane of the shading normal so that they tilt the interpolated normal.
pub fn add(builder: &mut Builder, place: Place, height: TextureId, scale: f32, nested: MaterialId) {
    let slope = builder.materials.textures().gradient(height, &builder.lookup) * scale;
    let n = builder.axes(place).n * builder.side;
    let tangent = |d: photinus_geometry::Vec3, slope: f32| d + n * (slope - n.dot(d));
    let tilted = tangent(builder.point.dp_du, slope.x).cross(tangent(builder.point.dp_dv, slope.y));
    let length_sq = tilted.length_squared();
    if !(length_sq > 0.0) || !length_sq.is_finite() || slope == photinus_geometry::Vec2::ZERO {
        return builder.nest(nested, place);
    }
    let tilted = tilted / length_sq.sqrt();
    // Mirrored texture coordinates turn the product of the tangents inwards.
    let outward = if tilted.dot(n) < 0.0 { -tilted } else { tilted };
    let place = builder.tilted(place, outward * builder.side);
    builder.nest(nested, place);
}
