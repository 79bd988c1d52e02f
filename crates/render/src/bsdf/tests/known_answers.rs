//! Numbers that can be worked out by hand.

use super::subjects::{glass, metal, plastic, principled, rough_glass, rough_plastic, thesis};
use super::{direction, flat_point, grey, prepare, resolve, rgb};
use crate::bsdf::{Bsdf, LobeSet, SurfaceModel, TransportMode};
use photinus_geometry::Vec3;
use photinus_scene::{Material, MaterialId, MicrofacetModel};

const RADIANCE: TransportMode = TransportMode::Radiance;
const IMPORTANCE: TransportMode = TransportMode::Importance;

/// Direction and weight of a child, where there is one.
type Child = Option<(Vec3, Vec3)>;

fn children(bsdf: &Bsdf, mode: TransportMode) -> (Child, Child) {
    // With one lobe in the set its probability is 1, so that weights are its own.
    let only = |set| bsdf.sample(set, 0.5, [0.5; 2], mode).map(|s| (s.wi, s.weight * s.pdf));
    (only(LobeSet::DELTA_REFLECTION), only(LobeSet::DELTA_TRANSMISSION))
}

#[test]
fn glass_at_normal_incidence() {
    for (z, eta) in [(1.0, 1.5f32), (-1.0, 1.0 / 1.5)] {
        let bsdf = resolve(glass(), direction(z, 0.0));
        let (reflected, transmitted) = children(&bsdf, IMPORTANCE);
        assert!((reflected.expect("reflection").1.x - 0.04).abs() < 1e-6);
        let (wi, weight) = transmitted.expect("refraction");
        assert!((weight.x - 0.96).abs() < 1e-6 && (wi + direction(z, 0.0)).length() < 1e-6);
        let (_, transmitted) = children(&bsdf, RADIANCE);
        assert!((transmitted.expect("refraction").1.x - 0.96 / (eta * eta)).abs() < 1e-5);
    }
}

#[test]
fn snell_and_total_reflection() {
    for degrees in [5.0f32, 30.0, 60.0, 85.0] {
        let wo = direction(degrees.to_radians().cos(), 0.7);
        let (reflected, transmitted) = children(&resolve(glass(), wo), IMPORTANCE);
        assert!((reflected.expect("reflection").0 - Vec3::new(-wo.x, -wo.y, wo.z)).length() < 1e-5);
        let wi = transmitted.expect("refraction").0;
        let sine = |v: Vec3| (v.x * v.x + v.y * v.y).sqrt();
        assert!((sine(wi) * 1.5 - sine(wo)).abs() < 1e-5 && wi.z < 0.0, "{degrees}: {wi}");
        assert!(Vec3::new(wi.x, wi.y, 0.0).normalize().dot(Vec3::new(wo.x, wo.y, 0.0).normalize()) < -0.9999);
    }
    for (degrees, total) in [(41.7f32, false), (41.9, true)] {
        let wo = direction(-degrees.to_radians().cos(), 0.2);
        let (reflected, transmitted) = children(&resolve(glass(), wo), IMPORTANCE);
        assert_eq!(transmitted.is_none(), total, "{degrees}");
        assert!(!total || reflected.expect("reflection").1 == Vec3::ONE);
    }
}

#[test]
fn a_thin_pane_passes_two_n_over_n_squared_plus_one() {
    let pane = Material::ThinDielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: grey(1.0),
        specular_transmittance: grey(1.0),
    };
    for z in [1.0, -1.0] {
        let bsdf = resolve(pane.clone(), direction(z, 0.0));
        let (reflected, transmitted) = children(&bsdf, RADIANCE);
        let (wi, weight) = transmitted.expect("transmission");
        assert!((weight.x - 2.0 * 1.5 / (1.5 * 1.5 + 1.0)).abs() < 1e-5 && (weight.x - 0.923).abs() < 1e-3);
        assert_eq!(wi, -direction(z, 0.0));
        assert!((reflected.expect("reflection").1.x + weight.x - 1.0).abs() < 1e-6);
    }
}

#[test]
fn equal_media_pass_light_straight_on() {
    for alpha in [0.0, 0.5] {
        let bsdf = resolve(rough_glass(MicrofacetModel::Ggx, [alpha; 2], 1.0), direction(0.3, 1.0));
        let (reflected, transmitted) = children(&bsdf, RADIANCE);
        let (wi, weight) = transmitted.expect("transmission");
        assert!(reflected.is_none() && weight == Vec3::ONE && (wi + direction(0.3, 1.0)).length() < 1e-6);
        assert_eq!(bsdf.kinds(), LobeSet::DELTA_TRANSMISSION);
    }
}

/// Roughness 0 and all up to the mirror's: the same lobes as the smooth material.
#[test]
fn no_roughness_is_a_mirror() {
    let ggx = MicrofacetModel::Ggx;
    let (eta, k) = (rgb(0.143, 0.375, 1.442), rgb(3.983, 2.386, 1.603));
    for alpha in [0.0, 0.0005, 0.001] {
        let pairs = [
            (metal(ggx, [alpha; 2], false), Material::Conductor { eta, k, specular_reflectance: grey(1.0) }),
            (rough_glass(ggx, [alpha; 2], 1.5), glass()),
            (rough_plastic(ggx, alpha, grey(0.4), true), plastic(grey(0.4), true)),
            (thesis(alpha, grey(1.0), grey(1.0)), glass()),
        ];
        for (rough, smooth) in pairs {
            let (materials, last) = prepare(vec![rough.clone(), smooth], vec![], SurfaceModel::Physical);
            for z in [0.9, 0.3, -0.5] {
                let at = |id| materials.resolve(id, &flat_point(), direction(z, 0.5));
                let (a, b) = (at(MaterialId(0)), at(last));
                let (a_children, b_children) = (children(&a, RADIANCE), children(&b, RADIANCE));
                let close = |x: Option<(Vec3, Vec3)>, y: Option<(Vec3, Vec3)>| match (x, y) {
                    (Some(x), Some(y)) => x.0 == y.0 && (x.1 - y.1).abs().max_element() < 1e-5,
                    (None, None) => true,
                    _ => false,
                };
                assert!(close(a_children.0, b_children.0) && close(a_children.1, b_children.1), "{rough:?} {z}");
                let wi = direction(0.6, 2.0);
                let (x, y) = (a.eval(LobeSet::ALL, wi, RADIANCE), b.eval(LobeSet::ALL, wi, RADIANCE));
                assert!((x - y).abs().max_element() < 1e-6, "{rough:?} {z}: {x} {y}");
            }
        }
    }
    let smooth = resolve(principled(grey(0.5), 0.0, [0.0; 9]), direction(0.8, 0.0));
    assert!(smooth.has(LobeSet::DELTA_REFLECTION) && !smooth.has(LobeSet::GLOSSY));
}

#[test]
fn metal_at_normal_incidence_is_bright_in_the_mirror_direction() {
    // At normal incidence and wi = wo: F D G / (4 cos) with D = 1 / (pi alpha^2), G = 1, F by hand.
    let bsdf = resolve(metal(MicrofacetModel::Ggx, [0.2; 2], false), Vec3::Z);
    let f = ((0.143f32 - 1.0).powi(2) + 3.983f32.powi(2)) / ((0.143f32 + 1.0).powi(2) + 3.983f32.powi(2));
    let expected = f / (4.0 * std::f32::consts::PI * 0.04);
    let value = bsdf.eval(LobeSet::ALL, Vec3::Z, RADIANCE).x;
    assert!((value - expected).abs() < 1e-4 * expected, "{value} {expected}");
}

#[test]
fn the_thesis_model_ends_in_a_mirror_and_in_a_lambertian_surface() {
    let (reflectance, transmittance) = (rgb(0.9, 0.6, 0.3), rgb(0.2, 0.5, 0.8));
    let list = vec![
        thesis(0.0, reflectance, grey(0.0)),
        thesis(1.0, reflectance, grey(0.0)),
        thesis(1.0, reflectance, transmittance),
    ];
    let (materials, _) = prepare(list, vec![], SurfaceModel::Physical);
    for z in [0.9, 0.2, -0.4] {
        let [mirror, matte, clear] =
            [0, 1, 2].map(|id| materials.resolve(MaterialId(id), &flat_point(), direction(z, 0.4)));
        assert_eq!(mirror.kinds(), LobeSet::DELTA_REFLECTION);
        assert_eq!(matte.kinds(), LobeSet::DIFFUSE_REFLECTION);
        assert_eq!(clear.kinds(), LobeSet::DIFFUSE_REFLECTION | LobeSet::DIFFUSE_TRANSMISSION);
        for wi in [direction(0.9, 1.0), direction(0.1, 2.0), direction(-0.5, 3.0)] {
            // The same radiance factor from everywhere: the reflectance over pi for the opaque one.
            let same_side = wi.z * z > 0.0;
            let value = matte.eval(LobeSet::ALL, wi, IMPORTANCE) / wi.z.abs();
            let expected = if same_side { Vec3::new(0.9, 0.6, 0.3) / std::f32::consts::PI } else { Vec3::ZERO };
            assert!((value - expected).abs().max_element() < 1e-6, "{value}");
        }
        let (a, b) = (direction(0.9, 1.0), direction(0.1, 2.0));
        for (a, b) in [(a, b), (-a, -b)] {
            let factor = |wi: Vec3| clear.eval(LobeSet::ALL, wi, IMPORTANCE) / wi.z.abs();
            assert!((factor(a) - factor(b)).abs().max_element() < 1e-6);
        }
    }
}

#[test]
fn one_sided_materials_are_black_behind() {
    for material in [
        Material::Diffuse { reflectance: grey(1.0) },
        metal(MicrofacetModel::Ggx, [0.3; 2], false),
        plastic(grey(0.5), false),
    ] {
        let bsdf = resolve(material, direction(-0.5, 0.0));
        assert!(bsdf.kinds().is_empty());
        assert!(bsdf.sample(LobeSet::ALL, 0.5, [0.5; 2], RADIANCE).is_none());
        assert_eq!(bsdf.albedo(LobeSet::ALL), Vec3::ZERO);
    }
}

#[test]
fn rough_lobes_are_gathered_and_smooth_ones_followed() {
    for (alpha, kind) in
        [(0.2, LobeSet::GLOSSY_REFLECTION), (0.25, LobeSet::ROUGH_REFLECTION), (0.7, LobeSet::ROUGH_REFLECTION)]
    {
        let bsdf = resolve(metal(MicrofacetModel::Ggx, [alpha; 2], false), direction(0.5, 0.0));
        assert_eq!(bsdf.kinds(), kind);
        assert_eq!(bsdf.has(LobeSet::GATHER), alpha >= 0.25);
        assert_eq!(bsdf.has(LobeSet::CONTINUE), alpha < 0.25);
    }
    let (materials, id) =
        prepare(vec![rough_plastic(MicrofacetModel::Ggx, 0.1, grey(0.5), false)], vec![], SurfaceModel::Physical);
    let kinds = materials.resolve(id, &flat_point(), direction(0.5, 0.0)).kinds();
    assert_eq!(kinds, LobeSet::GLOSSY_REFLECTION | LobeSet::DIFFUSE_REFLECTION);
    assert!(materials.bytes() > 1000);
}
