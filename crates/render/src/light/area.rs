//! Points on emitting triangles, uniform in area.

use photinus_geometry::Vec3;

/// Barycentrics (alpha, beta) uniform over a triangle, by folding the square over its diagonal.
#[inline]
pub(crate) fn uniform_triangle(u: [f32; 2]) -> [f32; 2] {
    if u[0] + u[1] > 1.0 { [1.0 - u[0], 1.0 - u[1]] } else { u }
}

/// A cosine-weighted direction around local z and its density over solid angle.
#[inline]
pub(crate) fn cosine_hemisphere(u: [f32; 2]) -> (Vec3, f32) {
    let [x, y] = crate::camera::uniform_disk(u);
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    (Vec3::new(x, y, z), z * std::f32::consts::FRAC_1_PI)
}

/// A direction uniform over the sphere.
#[inline]
pub(crate) fn uniform_sphere(u: [f32; 2]) -> Vec3 {
    let z = 1.0 - 2.0 * u[0];
    let r = (1.0 - z * z).max(0.0).sqrt();
    let phi = std::f32::consts::TAU * u[1];
    Vec3::new(r * libm::cosf(phi), r * libm::sinf(phi), z)
}

/// A direction uniform over the cone around local z with this `1 - cos` of its half angle.
#[inline]
pub(crate) fn uniform_cone(u: [f32; 2], one_minus_cos: f32) -> Vec3 {
    let drop = u[0] * one_minus_cos;
    let r = (drop * (2.0 - drop)).max(0.0).sqrt();
    let phi = std::f32::consts::TAU * u[1];
    Vec3::new(r * libm::cosf(phi), r * libm::sinf(phi), 1.0 - drop)
}
