//! The Trowbridge-Reitz (GGX) distribution.

use photinus_geometry::Vec3;
use std::f32::consts::PI;

/// Walter et al. 2007, equation 33, stretched by two roughnesses (Burley 2012, equation 13).
#[inline]
pub fn d(m: Vec3, alpha: [f32; 2]) -> f32 {
    let (x, y) = (m.x / alpha[0], m.y / alpha[1]);
    let e = x * x + y * y + m.z * m.z;
    1.0 / (PI * alpha[0] * alpha[1] * (e * e))
}

/// Walter et al. 2007, equation 34, divided by the cosine: 2 / (z + sqrt(z^2 + alpha^2 sin^2)).
#[inline]
pub fn g1_over_cos(z: f32, xy_sq: f32) -> f32 {
    2.0 / (z + (z * z + xy_sq).sqrt()).max(1e-12)
}

/// Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018: a point on the half disk and the squeezed
/// half disk that the stretched hemisphere shows to the viewer.
pub fn sample_visible(v: Vec3, alpha: [f32; 2], u: [f32; 2]) -> Vec3 {
    let stretched = Vec3::new(alpha[0] * v.x, alpha[1] * v.y, v.z.max(0.0)).normalize_or(Vec3::Z);
    let across_sq = stretched.x * stretched.x + stretched.y * stretched.y;
    let t1 = if across_sq > 0.0 { Vec3::new(-stretched.y, stretched.x, 0.0) / across_sq.sqrt() } else { Vec3::X };
    let t2 = stretched.cross(t1);
    let r = u[0].sqrt();
    let phi = 2.0 * PI * u[1];
    let a = r * libm::cosf(phi);
    let half = 0.5 * (1.0 + stretched.z);
    let b = (1.0 - half) * (1.0 - a * a).max(0.0).sqrt() + half * (r * libm::sinf(phi));
    let c = (1.0 - a * a - b * b).max(0.0).sqrt();
    let n = t1 * a + t2 * b + stretched * c;
    Vec3::new(alpha[0] * n.x, alpha[1] * n.y, n.z.max(1e-6)).normalize()
}
