//! Directions towards an emitting sphere, uniform over the solid angle that it covers.

use super::area::uniform_cone;
use photinus_geometry::{Frame, Sphere, Vec3};

/// `1 - cos` of the half angle that `sphere` covers from `point`; none where the point is not outside.
pub(crate) fn cone(sphere: &Sphere, point: Vec3) -> Option<f32> {
    let distance_sq = (sphere.center - point).length_squared();
    let radius_sq = sphere.radius * sphere.radius;
    if distance_sq <= radius_sq * 1.0001 {
        return None;
    }
    let sin_sq = radius_sq / distance_sq;
    // 1 - sqrt(1 - s) loses all digits for far spheres; s / (1 + sqrt(1 - s)) does not.
    Some(sin_sq / (1.0 + (1.0 - sin_sq).max(0.0).sqrt()))
}

/// A direction towards the sphere, the nearest point on it along that direction, and the density over solid angle.
pub(crate) fn sample(sphere: &Sphere, point: Vec3, u: [f32; 2]) -> Option<(Vec3, Vec3, f32)> {
    let one_minus_cos = cone(sphere, point)?;
    let to_center = sphere.center - point;
    let frame = Frame::from_normal(to_center.normalize());
    let dir = frame.to_world(uniform_cone(u, one_minus_cos));
    let along = dir.dot(to_center);
    let off_sq = (to_center - dir * along).length_squared();
    let half_chord = (sphere.radius * sphere.radius - off_sq).max(0.0).sqrt();
    Some((dir, point + dir * (along - half_chord), 1.0 / (std::f32::consts::TAU * one_minus_cos)))
}
