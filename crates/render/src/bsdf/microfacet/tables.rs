//! Directional reflectances of rough surfaces, tabulated once per scene.

use super::{Microfacets, reflect, refract};
use crate::bsdf::fresnel::{fresnel_dielectric, schlick_weight};
use photinus_geometry::Vec3;
use photinus_scene::MicrofacetModel;
use rayon::prelude::*;

/// Nodes over the cosine, at (i / 15)^2: reflectance bends most towards grazing directions.
const COSINES: usize = 16;

/// Nodes over the roughness, at (i / 15)^2.
const ALPHAS: usize = 16;

/// Points a side of the grid over the random square for one table entry.
const POINTS: u32 = 20;

/// Values over the cosine, linear in its square root between nodes. Small enough to be part of a lobe.
#[derive(Clone, Copy, Debug)]
pub struct CosTable([f32; COSINES]);

impl CosTable {
    /// The value at `cos` in 0..=1.
    #[inline]
    pub fn at(&self, cos: f32) -> f32 {
        let x = cos.clamp(0.0, 1.0).sqrt() * (COSINES - 1) as f32;
        let i = (x as usize).min(COSINES - 2);
        self.0[i] + (self.0[i + 1] - self.0[i]) * (x - i as f32)
    }

    fn node(i: usize) -> f32 {
        let x = i as f32 / (COSINES - 1) as f32;
        (x * x).max(1e-4)
    }

    fn blend(a: &Self, b: &Self, t: f32) -> Self {
        Self(std::array::from_fn(|i| a.0[i] + (b.0[i] - a.0[i]) * t))
    }
}

/// Index and fraction of a roughness among the nodes.
fn alpha_place(alpha: f32) -> (usize, f32) {
    let x = alpha.clamp(0.0, 1.0).sqrt() * (ALPHAS - 1) as f32;
    let i = (x as usize).min(ALPHAS - 2);
    (i, x - i as f32)
}

fn alpha_node(i: usize) -> f32 {
    let x = i as f32 / (ALPHAS - 1) as f32;
    x * x
}

/// Means of `f(wo, m)` over the facets that are visible from a direction `wo` of the given cosine, by a grid of
/// `points` squared.
fn mean_over_facets<const N: usize>(
    facets: &Microfacets,
    cos: f32,
    points: u32,
    f: impl Fn(Vec3, Vec3) -> [f32; N],
) -> [f32; N] {
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let mut sum = [0.0f64; N];
    for i in 0..points {
        for j in 0..points {
            let u = [(i as f32 + 0.5) / points as f32, (j as f32 + 0.5) / points as f32];
            let m = facets.sample_visible(wo, u);
            for (s, v) in sum.iter_mut().zip(f(wo, m)) {
                *s += f64::from(v);
            }
        }
    }
    sum.map(|s| (s / f64::from(points * points)) as f32)
}

/// Shadowing of the direction into which the facet `m` mirrors `wo`.
fn mirrored_shadow(facets: &Microfacets, wo: Vec3, m: Vec3) -> f32 {
    let wi = reflect(wo, m);
    if wi.z > 0.0 { facets.g1(wi) } else { 0.0 }
}

/// Shares of light that the facet `m` reflects and transmits.
fn interface_shares(facets: &Microfacets, wo: Vec3, m: Vec3, eta: f32) -> [f32; 2] {
    let (f, cos_t) = fresnel_dielectric(wo.dot(m), eta);
    let wi = refract(wo, m, eta, cos_t);
    let passed = if f < 1.0 && wi.z < 0.0 { facets.g1(wi) } else { 0.0 };
    [f * mirrored_shadow(facets, wo, m), (1.0 - f) * passed]
}

/// A rough dielectric coat, seen from outside.
#[derive(Clone, Copy, Debug)]
pub struct Coat {
    /// What passes without scattering twice, over the cosine.
    pub transmittance: CosTable,
    /// Its mean under diffuse light, 2 * integral of T(mu) mu.
    pub mean_transmittance: f32,
    /// Reflectance of the inside under diffuse light: all that does not leave. Of diffuse light inside the share
    /// mean_transmittance / eta^2 leaves, as radiance that comes in is eta^2 times as strong there; what single scattering
    /// loses between the facets stays inside.
    pub internal_reflectance: f32,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    /// Reflectance and transmittance seen from outside, then from inside.
    sides: [[CosTable; 2]; 2],
    mean_transmittance: f32,
}

/// Directional reflectance and transmittance of a rough interface between dielectrics, from both sides, for all
/// roughnesses. Only single scattering counts, so they add up to less than 1.
#[derive(Clone, Debug)]
pub struct InterfaceTable {
    /// What it was made for.
    pub model: MicrofacetModel,
    /// Index inside over index outside.
    pub eta: f32,
    rows: Vec<Row>,
}

impl InterfaceTable {
    /// Some 20 ms of one core for GGX, 50 ms for Beckmann.
    pub fn new(model: MicrofacetModel, eta: f32) -> Self {
        let row = |a: usize| {
            let facets = Microfacets::new(model, [alpha_node(a); 2]);
            let shares: [[f32; 4]; COSINES] = std::array::from_fn(|i| {
                mean_over_facets(&facets, CosTable::node(i), POINTS, |wo, m| {
                    let [r, t] = interface_shares(&facets, wo, m, eta);
                    let [inner_r, inner_t] = interface_shares(&facets, wo, m, 1.0 / eta);
                    [r, t, inner_r, inner_t]
                })
            });
            let column = |k: usize| CosTable(shares.map(|s| s[k]));
            let sides = [[column(0), column(1)], [column(2), column(3)]];
            // 2 * integral of f(mu) mu dmu = integral of f over mu^2: midpoints.
            let mean = |steps: u32, f: &dyn Fn(f32) -> f32| {
                (0..steps).map(|i| f(((i as f32 + 0.5) / steps as f32).sqrt())).sum::<f32>() / steps as f32
            };
            Row { sides, mean_transmittance: mean(1024, &|cos| sides[0][1].at(cos)) }
        };
        Self { model, eta, rows: (0..ALPHAS).into_par_iter().map(row).collect() }
    }

    /// Memory of the table.
    pub fn bytes(&self) -> usize {
        self.rows.len() * size_of::<Row>()
    }

    /// Reflectance and transmittance from outside or inside.
    pub fn at(&self, alpha: f32, cos: f32, inside: bool) -> [f32; 2] {
        let (i, t) = alpha_place(alpha);
        let side = usize::from(inside);
        [0, 1].map(|k| {
            let (a, b) = (self.rows[i].sides[side][k].at(cos), self.rows[i + 1].sides[side][k].at(cos));
            a + (b - a) * t
        })
    }

    /// The interface as a coat.
    pub fn coat(&self, alpha: f32) -> Coat {
        let (i, t) = alpha_place(alpha);
        let (a, b) = (&self.rows[i], &self.rows[i + 1]);
        let mean_transmittance = a.mean_transmittance + (b.mean_transmittance - a.mean_transmittance) * t;
        Coat {
            transmittance: CosTable::blend(&a.sides[0][1], &b.sides[0][1], t),
            mean_transmittance,
            internal_reflectance: 1.0 - mean_transmittance / (self.eta * self.eta),
        }
    }
}

/// Directional reflectance of a rough surface for any Fresnel reflectance of Schlick's form, as a sum of two terms
/// (B. Karis, "Real Shading in Unreal Engine 4", 2013).
#[derive(Clone, Debug)]
pub struct SplitSumTable {
    base: Vec<CosTable>,
    grazing: Vec<CosTable>,
}

impl SplitSumTable {
    /// Some 5 ms of one core for GGX, 25 ms for Beckmann.
    pub fn new(model: MicrofacetModel) -> Self {
        let row = |a: usize| {
            let facets = Microfacets::new(model, [alpha_node(a); 2]);
            let terms: [[f32; 2]; COSINES] = std::array::from_fn(|i| {
                mean_over_facets(&facets, CosTable::node(i), POINTS, |wo, m| {
                    let w = schlick_weight(wo.dot(m));
                    let shadow = mirrored_shadow(&facets, wo, m);
                    [(1.0 - w) * shadow, w * shadow]
                })
            });
            (CosTable(terms.map(|t| t[0])), CosTable(terms.map(|t| t[1])))
        };
        let (base, grazing) = (0..ALPHAS).into_par_iter().map(row).unzip();
        Self { base, grazing }
    }

    /// Memory of the table.
    pub fn bytes(&self) -> usize {
        (self.base.len() + self.grazing.len()) * size_of::<CosTable>()
    }

    /// Reflectance for the Fresnel reflectance `f0` at normal incidence and 1 at grazing.
    pub fn reflectance(&self, alpha: f32, cos: f32, f0: Vec3) -> Vec3 {
        let (i, t) = alpha_place(alpha);
        let at = |tables: &[CosTable]| {
            let (a, b) = (tables[i].at(cos), tables[i + 1].at(cos));
            a + (b - a) * t
        };
        (f0 * at(&self.base) + Vec3::splat(at(&self.grazing))).clamp(Vec3::ZERO, Vec3::ONE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::fresnel_diffuse_reflectance;

    #[test]
    fn smooth_plastic_has_fresnels_values() {
        let table = InterfaceTable::new(MicrofacetModel::Ggx, 1.5);
        let Coat { transmittance, internal_reflectance: inside, mean_transmittance } = table.coat(0.0);
        assert!((mean_transmittance - (1.0 - fresnel_diffuse_reflectance(1.5))).abs() < 0.01, "{mean_transmittance}");
        assert!((transmittance.at(1.0) - 0.96).abs() < 1e-4);
        assert!((inside - fresnel_diffuse_reflectance(1.0 / 1.5)).abs() < 0.01, "{inside}");
        for i in 1..20 {
            let cos = i as f32 / 20.0;
            let exact = 1.0 - fresnel_dielectric(cos, 1.5).0;
            assert!((transmittance.at(cos) - exact).abs() < 0.012, "{cos}: {} against {exact}", transmittance.at(cos));
        }
    }

    /// Light that enters a coat over a white base comes out again, whatever the roughness.
    #[test]
    fn a_white_base_sends_back_what_enters() {
        for model in [MicrofacetModel::Ggx, MicrofacetModel::Beckmann] {
            let table = InterfaceTable::new(model, 1.5);
            for alpha in [0.0, 0.1, 0.3, 0.7] {
                let Coat { internal_reflectance, mean_transmittance, .. } = table.coat(alpha);
                // What leaves in one pass is T / eta^2 under diffuse light; the rest comes back any number of times.
                let out = mean_transmittance / (1.5 * 1.5) / (1.0 - internal_reflectance);
                assert!((out - 1.0).abs() < 1e-4, "{model:?} {alpha}: {out}");
                let smooth = fresnel_diffuse_reflectance(1.0 / 1.5);
                assert!(internal_reflectance > smooth - 0.01, "{model:?} {alpha}: {internal_reflectance}");
                assert!(internal_reflectance < smooth + 0.1, "{model:?} {alpha}: {internal_reflectance}");
            }
        }
    }

    #[test]
    fn a_white_smooth_surface_reflects_all_and_a_rough_one_less() {
        for model in [MicrofacetModel::Ggx, MicrofacetModel::Beckmann] {
            let table = SplitSumTable::new(model);
            for cos in [0.1, 0.5, 1.0] {
                let smooth = table.reflectance(0.0, cos, Vec3::ONE).x;
                let rough = table.reflectance(1.0, cos, Vec3::ONE).x;
                assert!((smooth - 1.0).abs() < 0.01, "{model:?} {cos}: {smooth}");
                assert!(rough < 0.95 && rough > 0.3, "{model:?} {cos}: {rough}");
            }
        }
    }
}
