//! No surface sends out more than it gets, samples agree with values, and estimates of the albedo with both.

use super::subjects::{Subject, glass, metal, plastic, principled, rough_glass, rough_plastic, subjects, thesis};
use super::{direction, flat_point, grey, prepare, sampler, tilted_point};
use crate::bsdf::{Bsdf, LobeSet, SurfaceModel, TransportMode};
use photinus_geometry::Vec3;
use photinus_scene::{Material, MaterialId, MicrofacetModel};

/// Mean weight of `n` samples and its standard error, per the first channel's spread; lost samples weigh nothing.
fn furnace(bsdf: &Bsdf, set: LobeSet, mode: TransportMode, test: u32, n: u64) -> (Vec3, f32) {
    let (mut sum, mut sum_sq) = (Vec3::ZERO, Vec3::ZERO);
    for k in 0..n {
        let mut s = sampler(test, k);
        let u = s.next_2d();
        if let Some(sample) = bsdf.sample(set, s.next_1d(), u, mode) {
            sum += sample.weight;
            sum_sq += sample.weight * sample.weight;
        }
    }
    let mean = sum / n as f32;
    let variance = (sum_sq / n as f32 - mean * mean).max(Vec3::ZERO).max_element();
    (mean, (variance / n as f32).sqrt())
}

const VIEWS: [(f32, f32); 6] = [(0.999, 0.0), (0.8, 1.0), (0.4, 2.0), (0.1, 3.0), (-0.3, 4.0), (-0.9, 5.0)];

fn white_materials() -> Vec<Subject> {
    use MicrofacetModel::{Beckmann, Ggx};
    let white = grey(1.0);
    let pane = Material::ThinDielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: white,
        specular_transmittance: white,
    };
    let mut list = vec![
        ("diffuse".to_string(), Material::Diffuse { reflectance: white }),
        ("dielectric".into(), glass()),
        ("pane".into(), pane),
        ("mirror".into(), Material::Conductor { eta: grey(0.0), k: grey(0.0), specular_reflectance: white }),
        ("plastic".into(), plastic(white, false)),
        ("plastic nonlinear".into(), plastic(white, true)),
        ("null".into(), Material::Null),
    ];
    for model in [Ggx, Beckmann] {
        for alpha in [0.1, 0.5, 1.0] {
            list.push((format!("glass {model:?} {alpha}"), rough_glass(model, [alpha; 2], 1.5)));
            list.push((format!("dense glass {model:?} {alpha}"), rough_glass(model, [alpha, 0.3], 2.4)));
            list.push((format!("metal {model:?} {alpha}"), metal(model, [alpha; 2], true)));
            list.push((format!("plastic {model:?} {alpha}"), rough_plastic(model, alpha, white, true)));
            list.push((format!("linear plastic {model:?} {alpha}"), rough_plastic(model, alpha, white, false)));
        }
    }
    for roughness in [0.0, 0.2, 0.5, 0.8, 0.95, 1.0] {
        list.push((format!("thesis opaque {roughness}"), thesis(roughness, white, grey(0.0))));
        list.push((format!("thesis half {roughness}"), thesis(roughness, white, grey(0.5))));
        list.push((format!("thesis clear {roughness}"), thesis(roughness, white, white)));
    }
    list.into_iter().map(|(name, material)| Subject::new(&name, vec![material], vec![])).collect()
}

#[test]
fn white_surfaces_return_at_most_what_they_get() {
    for (t, subject) in white_materials().iter().enumerate() {
        let &(ref materials, id) = subject.prepare();
        for (z, phi) in VIEWS {
            let bsdf = materials.resolve(id, &flat_point(), direction(z, phi));
            let (mean, error) = furnace(&bsdf, LobeSet::ALL, TransportMode::Importance, t as u32, 4000);
            // 0.004: the interpolation error of the coats' tables.
            let limit = 1.004 + 4.0 * error;
            assert!(mean.max_element() <= limit, "{} z {z}: {mean} +- {error}", subject.name);
        }
    }
}

/// Burley's base is not normalised: with full roughness, sheen and a white colour it returns more than it gets. This pins
/// down how much, so that the documented bound stays true.
#[test]
fn the_principled_model_stays_within_its_documented_bound() {
    let mut worst = 0.0f32;
    for roughness in [0.1, 0.5, 1.0] {
        for rest in
            [[0.0; 9], [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.5], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]]
        {
            let (materials, id) = prepare(vec![principled(grey(1.0), roughness, rest)], vec![], SurfaceModel::Physical);
            for (z, phi) in VIEWS {
                let bsdf = materials.resolve(id, &flat_point(), direction(z, phi));
                let (mean, error) = furnace(&bsdf, LobeSet::ALL, TransportMode::Importance, 7, 4000);
                worst = worst.max(mean.max_element() - 4.0 * error);
                assert!(mean.is_finite());
            }
        }
    }
    assert!(worst > 1.0 && worst < 1.8, "{worst}");
}

#[test]
fn what_absorbs_nothing_returns_everything() {
    let white = grey(1.0);
    let lossless = [
        ("diffuse", Material::Diffuse { reflectance: white }, true),
        ("glass", glass(), false),
        ("mirror", Material::Conductor { eta: grey(0.0), k: grey(0.0), specular_reflectance: white }, true),
        ("thesis mirror or pane", thesis(0.0, white, white), false),
        ("thesis Lambertian, clear", thesis(1.0, white, white), false),
        ("thesis Lambertian, opaque", thesis(1.0, white, grey(0.0)), false),
        ("null", Material::Null, false),
    ];
    for (name, material, one_sided) in lossless {
        let (materials, id) = prepare(vec![material], vec![], SurfaceModel::Physical);
        for (z, phi) in VIEWS {
            if one_sided && z < 0.0 {
                continue;
            }
            let bsdf = materials.resolve(id, &flat_point(), direction(z, phi));
            let (mean, _) = furnace(&bsdf, LobeSet::ALL, TransportMode::Importance, 3, 500);
            assert!((mean - Vec3::ONE).abs().max_element() < 1e-4, "{name} z {z}: {mean}");
        }
    }
}

#[test]
fn weight_times_density_is_the_value() {
    for (t, subject) in subjects().iter().enumerate() {
        let &(ref materials, id) = subject.prepare();
        for (i, (z, phi)) in VIEWS.into_iter().enumerate() {
            let point = if i % 2 == 0 { flat_point() } else { tilted_point(Vec3::new(-0.2, 0.4, 1.0).normalize()) };
            let bsdf = materials.resolve(id, &point, direction(z, phi));
            for mode in [TransportMode::Radiance, TransportMode::Importance] {
                for set in [LobeSet::NON_DELTA, LobeSet::GATHER, LobeSet::REFLECTION, LobeSet::TRANSMISSION] {
                    for k in 0..60 {
                        let mut s = sampler(t as u32, k);
                        let u = s.next_2d();
                        let Some(sample) = bsdf.sample(set, s.next_1d(), u, mode) else { continue };
                        if sample.kind.intersects(LobeSet::DELTA) {
                            continue;
                        }
                        let (value, pdf) = (bsdf.eval(set, sample.wi, mode), bsdf.pdf(set, sample.wi));
                        let got = sample.weight * sample.pdf;
                        let scale = value.max_element().max(1e-3);
                        assert!((got - value).abs().max_element() < 4e-3 * scale, "{}: {got} {value}", subject.name);
                        assert!(
                            (sample.pdf - pdf).abs() < 4e-3 * pdf.max(1e-3),
                            "{}: {} {pdf}",
                            subject.name,
                            sample.pdf
                        );
                        assert!(set.contains(sample.kind), "{}: {:?}", subject.name, sample.kind);
                        let crossed = sample.kind.intersects(LobeSet::TRANSMISSION);
                        assert!(crossed || sample.eta == 1.0);
                    }
                }
            }
        }
    }
}

/// The sum over the two halves of every partition is the whole.
#[test]
fn parts_add_up() {
    for subject in subjects() {
        let &(ref materials, id) = subject.prepare();
        for (z, phi) in VIEWS {
            let bsdf = materials.resolve(id, &flat_point(), direction(z, phi));
            for k in 0..50 {
                let wi = super::sphere(sampler(5, k).next_2d());
                let mode = TransportMode::Radiance;
                let all = bsdf.eval(LobeSet::ALL, wi, mode);
                for (a, b) in [(LobeSet::GATHER, LobeSet::CONTINUE), (LobeSet::REFLECTION, LobeSet::TRANSMISSION)] {
                    let sum = bsdf.eval(a, wi, mode) + bsdf.eval(b, wi, mode);
                    assert!((sum - all).abs().max_element() <= 1e-5 * all.max_element(), "{}", subject.name);
                }
                assert_eq!(bsdf.eval(LobeSet::DELTA, wi, mode), Vec3::ZERO);
            }
            let parts: Vec3 = LobeSet::KINDS.iter().map(|&k| bsdf.albedo(k)).sum();
            assert!((parts - bsdf.albedo(LobeSet::ALL)).abs().max_element() < 1e-4 || parts.max_element() > 1.0);
            for kind in LobeSet::KINDS {
                assert_eq!(bsdf.has(kind), bsdf.kinds().intersects(kind));
            }
        }
    }
}

/// The estimate is what lobes are chosen by and what the albedo picture shows: within 0.06 of the truth for every
/// material, and within 0.01 for those whose albedo is known or tabulated. Bumps lose light that no estimate follows.
#[test]
fn albedo_estimates_are_close() {
    for (t, subject) in subjects().iter().enumerate() {
        if subject.name.contains("map") {
            continue;
        }
        let &(ref materials, id) = subject.prepare();
        for (z, phi) in [(0.95, 0.3), (0.5, 1.0), (0.25, 2.0), (-0.6, 1.0)] {
            let bsdf = materials.resolve(id, &flat_point(), direction(z, phi));
            let exact = ["diffuse", "dielectric", "thin", "conductor", "plastic", "rough-plastic", "null"];
            // Tables know one roughness, not two.
            let inexact = if subject.name.contains("[0.1, 0.6]") { 0.12 } else { 0.06 };
            let exact = exact.iter().any(|name| subject.name.starts_with(name));
            for set in [LobeSet::REFLECTION, LobeSet::TRANSMISSION] {
                let (mean, error) = furnace(&bsdf, set, TransportMode::Importance, t as u32, 2000);
                let off = (bsdf.albedo(set) - mean).abs().max_element();
                let bound = if exact { 0.01 } else { inexact } + 4.0 * error;
                assert!(off < bound, "{} z {z} {set:?}: {} against {mean}", subject.name, bsdf.albedo(set));
            }
        }
    }
}

#[test]
fn masks_and_blends_scale_what_they_hold() {
    let base = vec![
        Material::Diffuse { reflectance: grey(0.5) },
        Material::Mask { opacity: super::num(0.25), nested: MaterialId(0) },
        Material::Blend { weight: super::num(0.5), a: MaterialId(1), b: MaterialId(0) },
        Material::Null,
        Material::Blend { weight: super::num(0.5), a: MaterialId(1), b: MaterialId(3) },
    ];
    let (materials, _) = prepare(base, vec![], SurfaceModel::Physical);
    let at = flat_point().lookup();
    let opacities: Vec<f32> = (0..5).map(|i| materials.opacity(MaterialId(i), &at)).collect();
    assert_eq!(opacities, [1.0, 0.25, 0.625, 0.0, 0.125]);
    let flags: Vec<bool> = (0..5).map(|i| materials.has_opacity(MaterialId(i))).collect();
    assert_eq!(flags, [false, true, true, true, true]);
    for i in [1, 2, 4] {
        // What is met behind the mask is the same diffuse surface, whatever the share of holes.
        let bsdf = materials.resolve(MaterialId(i), &flat_point(), direction(0.7, 0.0));
        let value = bsdf.eval(LobeSet::ALL, direction(0.5, 1.0), TransportMode::Radiance);
        assert!((value.x - 0.25 / std::f32::consts::PI).abs() < 1e-6, "{i}: {value}");
    }
}
