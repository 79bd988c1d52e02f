//! Microfacet distributions: facet density, Smith masking, sampling of the facets that are visible.
//!
//! Facet normals `m` and directions are in the local frame, `m.z > 0`. The density of visible normals is
//! D(m) G1(v) |v.m| / |v.z| (Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT
//! 3(2), 2014, equation 17). Masking and shadowing are independent: G = G1(wo) G1(wi) (Walter et al., "Microfacet
//! Models for Refraction through Rough Surfaces", EGSR 2007, equation 23).

mod beckmann;
mod ggx;
mod tables;

pub(super) use tables::{CosTable, InterfaceTable, SplitSumTable};

use photinus_geometry::Vec3;
use photinus_scene::MicrofacetModel;

/// A distribution with roughness along x and y of the local frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Microfacets {
    pub model: MicrofacetModel,
    pub alpha: [f32; 2],
}

impl Microfacets {
    /// Roughness outside the sound range is brought back into it: at most 1 (Smith's model has no use for more), at
    /// least the roughness that counts as a mirror; NaN is 1.
    pub fn new(model: MicrofacetModel, alpha: [f32; 2]) -> Self {
        Self { model, alpha: alpha.map(clamp_alpha) }
    }

    /// Squared length of v's xy part after scaling by the roughness: z^2 times the squared tangent of Smith's theory.
    #[inline]
    fn xy_sq(&self, v: Vec3) -> f32 {
        let (x, y) = (self.alpha[0] * v.x, self.alpha[1] * v.y);
        x * x + y * y
    }

    /// Density of facets with normal `m` over solid angle, per projected area.
    #[inline]
    pub fn d(&self, m: Vec3) -> f32 {
        if m.z <= 0.0 {
            return 0.0;
        }
        match self.model {
            MicrofacetModel::Ggx => ggx::d(m, self.alpha),
            MicrofacetModel::Beckmann => beckmann::d(m, self.alpha),
        }
    }

    /// G1(v) / |v.z|, finite down to grazing v.
    #[inline]
    pub fn g1_over_cos(&self, v: Vec3) -> f32 {
        match self.model {
            MicrofacetModel::Ggx => ggx::g1_over_cos(v.z.abs(), self.xy_sq(v)),
            MicrofacetModel::Beckmann => beckmann::g1_over_cos(v.z.abs(), self.xy_sq(v)),
        }
    }

    /// Share of facets seen from `v` that other facets do not hide.
    #[inline]
    pub fn g1(&self, v: Vec3) -> f32 {
        (self.g1_over_cos(v) * v.z.abs()).min(1.0)
    }

    /// Solid angle density of [`sample_visible`](Self::sample_visible) at `m`.
    #[inline]
    pub fn visible_pdf(&self, v: Vec3, m: Vec3) -> f32 {
        self.d(m) * self.g1_over_cos(v) * v.dot(m).max(0.0)
    }

    /// A facet normal as seen from `v` (v.z >= 0).
    #[inline]
    pub fn sample_visible(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        match self.model {
            MicrofacetModel::Ggx => ggx::sample_visible(v, self.alpha, u),
            MicrofacetModel::Beckmann => beckmann::sample_visible(v, self.alpha, u),
        }
    }

    /// One roughness to class a lobe by: the geometric mean, as one narrow side makes a narrow lobe.
    pub fn mean_alpha(&self) -> f32 {
        (self.alpha[0] * self.alpha[1]).sqrt()
    }

    /// One roughness to look up tables made for equal ones: the quadratic mean, as masking grows with the square.
    pub fn table_alpha(&self) -> f32 {
        (0.5 * (self.alpha[0] * self.alpha[0] + self.alpha[1] * self.alpha[1])).sqrt()
    }
}

fn clamp_alpha(alpha: f32) -> f32 {
    if alpha.is_nan() { 1.0 } else { alpha.clamp(super::MIRROR_ALPHA, 1.0) }
}

/// Whether a surface of this roughness is a perfect mirror or pane.
pub(super) fn is_mirror(alpha: [f32; 2]) -> bool {
    alpha.iter().all(|&a| a <= super::MIRROR_ALPHA)
}

/// `v` mirrored about the unit vector `m`.
#[inline]
pub(super) fn reflect(v: Vec3, m: Vec3) -> Vec3 {
    m * (2.0 * v.dot(m)) - v
}

/// `v` bent through the facet `m` (v.m >= 0) into a medium of relative index `eta`, given the cosine inside.
#[inline]
pub(super) fn refract(v: Vec3, m: Vec3, eta: f32, cos_t: f32) -> Vec3 {
    m * (v.dot(m) / eta - cos_t) - v / eta
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_num::{Sampler, StreamKind};

    pub(crate) fn all() -> impl Iterator<Item = Microfacets> {
        [MicrofacetModel::Ggx, MicrofacetModel::Beckmann].into_iter().flat_map(|model| {
            [[0.05, 0.05], [0.3, 0.3], [1.0, 1.0], [0.1, 0.5], [0.8, 0.02]]
                .into_iter()
                .map(move |alpha| Microfacets::new(model, alpha))
        })
    }

    fn views() -> impl Iterator<Item = Vec3> {
        [0.999_999f32, 0.8, 0.4, 0.1].into_iter().flat_map(|z| {
            [0.3f32, 2.0].into_iter().map(move |phi| {
                let s = (1.0 - z * z).sqrt();
                Vec3::new(s * phi.cos(), s * phi.sin(), z)
            })
        })
    }

    /// The projected area of the facets is that of the surface, and that of the visible ones the projected surface:
    /// both integrals, by importance sampling that knows neither D nor G1 too well (uniform in the slope's angle).
    #[test]
    fn densities_are_normalised() {
        const N: u32 = 400;
        for facets in all() {
            let (mut area, mut visible) = (0.0f64, vec![0.0f64; views().count()]);
            for i in 0..N {
                for j in 0..N {
                    // Slopes (alpha_x, alpha_y) * r (cos, sin) with r = u / (1 - u): every distribution is smooth in it.
                    let u = (f64::from(i) + 0.5) / f64::from(N);
                    let phi = (f64::from(j) + 0.5) / f64::from(N) * std::f64::consts::TAU;
                    let r = u / (1.0 - u);
                    let jacobian = r / ((1.0 - u) * (1.0 - u)) * std::f64::consts::TAU / f64::from(N * N);
                    let (ax, ay) = (f64::from(facets.alpha[0]), f64::from(facets.alpha[1]));
                    let (sx, sy) = (ax * r * phi.cos(), ay * r * phi.sin());
                    let z = 1.0 / (1.0 + sx * sx + sy * sy).sqrt();
                    let m = Vec3::new((-sx * z) as f32, (-sy * z) as f32, z as f32);
                    // d(slope) = d(omega) / z^3.
                    let solid_angle = jacobian * ax * ay * z * z * z;
                    area += f64::from(facets.d(m)) * z * solid_angle;
                    for (sum, v) in visible.iter_mut().zip(views()) {
                        *sum += f64::from(facets.visible_pdf(v, m)) * solid_angle;
                    }
                }
            }
            assert!((area - 1.0).abs() < 2e-3, "{facets:?}: {area}");
            for (sum, v) in visible.iter().zip(views()) {
                assert!((sum - 1.0).abs() < 5e-3, "{facets:?} from {v}: {sum}");
            }
        }
    }

    /// Means of functions of the sampled normal against the same integrals over the density.
    #[test]
    fn sampled_normals_have_the_density_of_visible_ones() {
        const N: u32 = 20_000;
        for (k, facets) in all().enumerate() {
            for v in views() {
                let mut sampler = Sampler::new(7, StreamKind::Test, k as u64, 0);
                let (mut sum, mut sum_sq) = (0.0f64, 0.0f64);
                for _ in 0..N {
                    let m = facets.sample_visible(v, sampler.next_2d());
                    assert!((m.length() - 1.0).abs() < 1e-4 && m.z > 0.0 && v.dot(m) > -1e-4, "{facets:?} {v} {m}");
                    // 1 / (v.m) averages to |surface seen head on| = integral of D G1 / v.z = needs no oracle: with the
                    // visible density it is G1(v) / v.z times the integral of D over m, so test v.m * z instead below.
                    let x = f64::from(m.z);
                    sum += x;
                    sum_sq += x * x;
                }
                let mean = sum / f64::from(N);
                let sigma = ((sum_sq / f64::from(N) - mean * mean).max(0.0) / f64::from(N)).sqrt();
                let expected = expected_z(&facets, v);
                assert!((mean - expected).abs() < 5.0 * sigma + 1e-3, "{facets:?} from {v}: {mean} against {expected}");
            }
        }
    }

    /// Mean of m.z under the visible density, by quadrature over slopes.
    fn expected_z(facets: &Microfacets, v: Vec3) -> f64 {
        const N: u32 = 300;
        let mut total = 0.0;
        for i in 0..N {
            for j in 0..N {
                let u = (f64::from(i) + 0.5) / f64::from(N);
                let phi = (f64::from(j) + 0.5) / f64::from(N) * std::f64::consts::TAU;
                let r = u / (1.0 - u);
                let jacobian = r / ((1.0 - u) * (1.0 - u)) * std::f64::consts::TAU / f64::from(N * N);
                let (ax, ay) = (f64::from(facets.alpha[0]), f64::from(facets.alpha[1]));
                let (sx, sy) = (ax * r * phi.cos(), ay * r * phi.sin());
                let z = 1.0 / (1.0 + sx * sx + sy * sy).sqrt();
                let m = Vec3::new((-sx * z) as f32, (-sy * z) as f32, z as f32);
                total += f64::from(facets.visible_pdf(v, m)) * z * jacobian * ax * ay * z * z * z;
            }
        }
        total
    }

    #[test]
    fn mirrored_and_bent_directions() {
        let v = Vec3::new(0.6, 0.0, 0.8);
        assert!((reflect(v, Vec3::Z) - Vec3::new(-0.6, 0.0, 0.8)).length() < 1e-6);
        let (_, cos_t) = super::super::fresnel_dielectric(0.8, 1.5);
        let t = refract(v, Vec3::Z, 1.5, cos_t);
        assert!((t.x + 0.4).abs() < 1e-6 && t.z < 0.0 && (t.length() - 1.0).abs() < 1e-6, "{t}");
    }
}
