//! Fresnel's equations for unpolarised light, and their integrals.

use photinus_geometry::Vec3;

/// Reflectance of the interface between two dielectrics, and the cosine of the refracted ray (0 on total reflection).
///
/// `cos_i` in 0..=1 is measured on the side of the incident ray; `eta` is (index on the other side) / (index on this
/// side). Born and Wolf, "Principles of Optics", section 1.5.2, averaged over both polarisations.
#[inline]
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> (f32, f32) {
    let cos_i = cos_i.clamp(0.0, 1.0);
    let sin_t_sq = (1.0 - cos_i * cos_i) / (eta * eta);
    if !(sin_t_sq < 1.0) {
        return (1.0, 0.0);
    }
    if eta == 1.0 {
        return (0.0, cos_i);
    }
    let cos_t = (1.0 - sin_t_sq).sqrt();
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    (0.5 * (parallel * parallel + perpendicular * perpendicular), cos_t)
}

/// Reflectance of a conductor with the complex index `eta` + i `k` relative to the medium around it, per channel.
///
/// Exact for real and imaginary parts of any size: Born and Wolf, "Principles of Optics", section 14.2, in the real
/// form with a^2 + b^2 = |sqrt((eta + i k)^2 - sin^2)|^2. Both zero: a perfect mirror.
#[inline]
pub fn fresnel_conductor(cos_i: f32, eta: Vec3, k: Vec3) -> Vec3 {
    Vec3::new(
        conductor_channel(cos_i, eta.x, k.x),
        conductor_channel(cos_i, eta.y, k.y),
        conductor_channel(cos_i, eta.z, k.z),
    )
}

#[inline]
fn conductor_channel(cos_i: f32, eta: f32, k: f32) -> f32 {
    if eta == 0.0 && k == 0.0 {
        return 1.0;
    }
    let cos_i = cos_i.clamp(0.0, 1.0);
    let cos_sq = cos_i * cos_i;
    let sin_sq = 1.0 - cos_sq;
    let real = eta * eta - k * k - sin_sq;
    let modulus = (real * real + 4.0 * eta * eta * k * k).sqrt();
    let a = (0.5 * (modulus + real)).max(0.0).sqrt();
    let perpendicular = ratio(modulus + cos_sq - 2.0 * a * cos_i, modulus + cos_sq + 2.0 * a * cos_i);
    let base = cos_sq * modulus + sin_sq * sin_sq;
    let cross = 2.0 * a * cos_i * sin_sq;
    let parallel = perpendicular * ratio(base - cross, base + cross);
    (0.5 * (perpendicular + parallel)).clamp(0.0, 1.0)
}

/// `a / b`, 1 where both vanish (grazing incidence on a medium of index 1).
#[inline]
fn ratio(a: f32, b: f32) -> f32 {
    if b > 0.0 { a / b } else { 1.0 }
}

/// Mean reflectance of a smooth dielectric interface under diffuse light, 2 * integral of F(mu) mu over mu in 0..1, for
/// light that comes from the side to which `eta` is relative.
pub fn fresnel_diffuse_reflectance(eta: f32) -> f32 {
    // Gauss-Legendre converges badly at the kink of total reflection: the midpoint rule in mu^2 needs no weights, and
    // 4096 points leave an error below 1e-5 for indices between 1/3 and 3.
    const POINTS: u32 = 4096;
    let sum: f64 = (0..POINTS)
        .map(|i| {
            let mu_sq = (f64::from(i) + 0.5) / f64::from(POINTS);
            f64::from(fresnel_dielectric(mu_sq.sqrt() as f32, eta).0)
        })
        .sum();
    (sum / f64::from(POINTS)) as f32
}

/// Schlick's weight (1 - cos)^5.
#[inline]
pub(super) fn schlick_weight(cos: f32) -> f32 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    let m_sq = m * m;
    m_sq * m_sq * m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_at_normal_incidence_and_total_reflection() {
        let (f, cos_t) = fresnel_dielectric(1.0, 1.5);
        assert!((f - 0.04).abs() < 1e-6 && cos_t == 1.0);
        assert!((fresnel_dielectric(1.0, 1.0 / 1.5).0 - 0.04).abs() < 1e-6);
        // asin(1 / 1.5) = 41.8103 degrees.
        let at = |degrees: f64| fresnel_dielectric(degrees.to_radians().cos() as f32, 1.0 / 1.5).0;
        assert!(at(41.80) < 1.0, "{}", at(41.80));
        assert_eq!(at(41.82), 1.0);
        assert_eq!(fresnel_dielectric(0.0, 1.5), (1.0, (1.0f32 - 1.0 / 2.25).sqrt()));
    }

    #[test]
    fn snell_and_brewster() {
        for degrees in [10.0f64, 30.0, 60.0, 85.0] {
            let (_, cos_t) = fresnel_dielectric(degrees.to_radians().cos() as f32, 1.33);
            let sin_t = degrees.to_radians().sin() / 1.33;
            assert!((f64::from(cos_t) - (1.0 - sin_t * sin_t).sqrt()).abs() < 1e-5);
        }
        // At Brewster's angle atan(n) only the perpendicular part is left: ((n^2 - 1) / (n^2 + 1))^2 / 2.
        let n = 1.5f64;
        let expected = 0.5 * ((n * n - 1.0) / (n * n + 1.0)).powi(2);
        let (f, _) = fresnel_dielectric(n.atan().cos() as f32, 1.5);
        assert!((f64::from(f) - expected).abs() < 1e-6);
    }

    /// The textbook form with complex numbers written out in f64.
    fn conductor_oracle(cos_i: f64, eta: f64, k: f64) -> f64 {
        // sqrt of z = (eta + i k)^2 - sin^2, then r_s = (c - w) / (c + w), r_p = (n^2 c - w) / (n^2 c + w).
        let (re, im) = (eta * eta - k * k - (1.0 - cos_i * cos_i), 2.0 * eta * k);
        let m = re.hypot(im);
        let w = (((m + re) / 2.0).max(0.0).sqrt(), ((m - re) / 2.0).max(0.0).sqrt());
        let n2 = (eta * eta - k * k, 2.0 * eta * k);
        let abs_sq = |z: (f64, f64)| z.0 * z.0 + z.1 * z.1;
        let rs = abs_sq((cos_i - w.0, -w.1)) / abs_sq((cos_i + w.0, w.1));
        let p = (n2.0 * cos_i, n2.1 * cos_i);
        let rp = abs_sq((p.0 - w.0, p.1 - w.1)) / abs_sq((p.0 + w.0, p.1 + w.1));
        0.5 * (rs + rp)
    }

    #[test]
    fn conductors_agree_with_complex_arithmetic_and_hand_values() {
        for (eta, k) in [(0.143, 3.983), (0.2, 3.91), (1.5, 0.0), (2.0, 0.5), (0.05, 9.0), (3.0, 3.0)] {
            for i in 1..=20 {
                let cos = f64::from(i) / 20.0;
                let f = conductor_channel(cos as f32, eta as f32, k as f32);
                assert!((f64::from(f) - conductor_oracle(cos, eta, k)).abs() < 2e-5, "{eta} {k} {cos}: {f}");
            }
        }
        // Normal incidence by hand: ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2); copper-like red 0.2004, 3.9129: 0.9524.
        let f = fresnel_conductor(1.0, Vec3::splat(0.2004), Vec3::splat(3.9129)).x;
        assert!((f - 0.95125).abs() < 2e-3, "{f}");
        let by_hand = ((0.2004f64 - 1.0).powi(2) + 3.9129f64.powi(2)) / ((0.2004f64 + 1.0).powi(2) + 3.9129f64.powi(2));
        assert!((f64::from(f) - by_hand).abs() < 1e-5);
        assert_eq!(fresnel_conductor(0.3, Vec3::ZERO, Vec3::ZERO), Vec3::ONE);
        assert!(fresnel_conductor(0.0, Vec3::ONE, Vec3::ZERO).is_finite());
    }

    #[test]
    fn a_conductor_without_extinction_is_a_dielectric() {
        for i in 0..=20 {
            let cos = i as f32 / 20.0;
            let (f, _) = fresnel_dielectric(cos, 1.7);
            assert!((conductor_channel(cos, 1.7, 0.0) - f).abs() < 1e-5, "{cos}");
        }
    }

    #[test]
    fn diffuse_reflectance_known_values() {
        // Published for n = 1.5: 0.0918 outside and 0.5963 inside (d'Eon and Irving 2011, and older tables); both sides
        // are tied by n^2 (1 - inside) = 1 - outside.
        let (outside, inside) = (fresnel_diffuse_reflectance(1.5), fresnel_diffuse_reflectance(1.0 / 1.5));
        assert!((outside - 0.0918).abs() < 2e-4, "{outside}");
        assert!((inside - 0.5963).abs() < 3e-4, "{inside}");
        assert!((2.25 * (1.0 - inside) - (1.0 - outside)).abs() < 1e-3);
        assert_eq!(fresnel_diffuse_reflectance(1.0), 0.0);
    }
}
