//! The Beckmann-Spizzichino distribution.

use photinus_geometry::Vec3;
use std::f32::consts::PI;

const INV_SQRT_PI: f32 = 0.564_189_6;

/// Walter et al. 2007, equation 25, stretched by two roughnesses.
#[inline]
pub fn d(m: Vec3, alpha: [f32; 2]) -> f32 {
    let z_sq = m.z * m.z;
    let (x, y) = (m.x / alpha[0], m.y / alpha[1]);
    let exponent = (x * x + y * y) / z_sq;
    if exponent > 80.0 {
        return 0.0;
    }
    libm::expf(-exponent) / (PI * alpha[0] * alpha[1] * (z_sq * z_sq))
}

/// Smith's exact masking (Walter et al. 2007, equation 26) over the cosine: with a = z / sqrt(xy_sq),
/// 1 / (z + z Lambda), z Lambda = z (erf(a) - 1) / 2 + sqrt(xy_sq) exp(-a^2) / (2 sqrt(pi)).
#[inline]
pub fn g1_over_cos(z: f32, xy_sq: f32) -> f32 {
    let xy = xy_sq.sqrt();
    let lambda_z = if z >= 4.0 * xy {
        0.0
    } else {
        let a = z / xy;
        (0.5 * INV_SQRT_PI * xy * libm::expf(-a * a) - 0.5 * z * libm::erfcf(a)).max(0.0)
    };
    1.0 / (z + lambda_z).max(1e-12)
}

/// Inverse of the error function on (-1, 1): M. Giles, "Approximating the erfinv function", GPU Computing Gems 2, 2011,
/// single precision (relative error about 3e-7).
fn erf_inv(x: f32) -> f32 {
    const CENTRAL: [f32; 9] = [
        2.810_226_4e-8,
        3.432_739_4e-7,
        -3.523_387_7e-6,
        -4.391_506_5e-6,
        2.185_808_7e-4,
        -1.253_725e-3,
        -4.177_681_6e-3,
        0.246_640_73,
        1.501_409_4,
    ];
    const TAIL: [f32; 9] = [
        -2.002_142_6e-4,
        1.009_505_6e-4,
        1.349_343_2e-3,
        -3.673_428_4e-3,
        5.739_507_7e-3,
        -7.622_461_3e-3,
        9.438_870_5e-3,
        1.001_674,
        2.832_976_8,
    ];
    let w = -libm::logf(((1.0 - x) * (1.0 + x)).max(f32::MIN_POSITIVE));
    let (w, coefficients) = if w < 5.0 { (w - 2.5, &CENTRAL) } else { (w.sqrt() - 3.0, &TAIL) };
    coefficients.iter().fold(0.0, |p, &c| c + p * w) * x
}

/// Visible slopes are sampled one after the other for unit roughness (Heitz and d'Eon, "Importance Sampling
/// Microfacet-Based BSDFs using the Distribution of Visible Normals", EGSR 2014); the one along the view by inverting its
/// distribution in the error function's domain (Jakob, "An Improved Visible Normal Sampling Routine for the Beckmann
/// Distribution", 2014), here by Newton's method kept inside a bracket.
pub fn sample_visible(v: Vec3, alpha: [f32; 2], u: [f32; 2]) -> Vec3 {
    let stretched = Vec3::new(alpha[0] * v.x, alpha[1] * v.y, v.z.max(0.0)).normalize_or(Vec3::Z);
    let sin = (stretched.x * stretched.x + stretched.y * stretched.y).sqrt();
    let (cos_phi, sin_phi) = if sin > 0.0 { (stretched.x / sin, stretched.y / sin) } else { (1.0, 0.0) };
    let across = erf_inv(2.0 * u[1].clamp(1e-6, 1.0 - 1e-6) - 1.0);
    let along = visible_slope(sin, stretched.z, u[0].clamp(1e-6, 1.0 - 1e-6));
    let slope_x = (cos_phi * along - sin_phi * across) * alpha[0];
    let slope_y = (sin_phi * along + cos_phi * across) * alpha[1];
    Vec3::new(-slope_x, -slope_y, 1.0).normalize()
}

/// The slope along a view of the given sine and cosine: solves, for b = erf(slope) between -1 and erf(cot),
/// 1 + b + tan / sqrt(pi) exp(-slope^2) = u times its value at the upper end.
fn visible_slope(sin: f32, cos: f32, u: f32) -> f32 {
    if sin < 1e-4 * cos {
        return erf_inv(2.0 * u - 1.0);
    }
    // Multiplied through by the cosine, nothing diverges at grazing views.
    let cot = cos / sin;
    let (mut low, mut high) = (-1.0f32, libm::erff(cot));
    let value = |b: f32, slope: f32| (1.0 + b) * cos + INV_SQRT_PI * sin * libm::expf(-slope * slope);
    let target = u * value(high, cot);
    let mut b = low + (high - low) * u;
    let mut slope = erf_inv(b);
    for _ in 0..16 {
        let error = value(b, slope) - target;
        if error.abs() <= 1e-6 * target {
            break;
        }
        if error > 0.0 {
            high = b;
        } else {
            low = b;
        }
        let derivative = cos - slope * sin;
        let newton = b - error / derivative;
        // False for NaN too: then bisect.
        b = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        slope = erf_inv(b);
    }
    slope
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn erf_inv_inverts_erf() {
        for i in -299..300 {
            let x = i as f32 / 100.0;
            let b = libm::erff(x);
            if b.abs() < 0.999 {
                assert!((erf_inv(b) - x).abs() < 2e-4, "{x}: {}", erf_inv(b));
            }
        }
    }

    #[test]
    fn masking_at_the_ends() {
        assert!((g1_over_cos(1.0, 0.0) - 1.0).abs() < 1e-6);
        assert!(g1_over_cos(0.0, 0.25).is_finite());
        assert!(g1_over_cos(0.0, 0.0).is_finite());
    }
}
