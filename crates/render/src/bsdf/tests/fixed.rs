//! The surface model that bypasses Fresnel and microfacets.

use super::subjects::{glass, subjects, thesis};
use super::{direction, flat_point, prepare, rgb, sampler};
use crate::bsdf::{LobeSet, SurfaceModel, TransportMode};
use photinus_geometry::Vec3;

/// Only mirrors, panes and Lambertian lobes, of the same strength from everywhere, and never more than 1 in all.
#[test]
fn coefficients_do_not_depend_on_direction() {
    for subject in subjects() {
        // Shading frames are bent near grazing views, and bumps have their own.
        if subject.name.contains("map") {
            continue;
        }
        let (materials, id) = prepare(subject.materials.clone(), subject.textures.clone(), SurfaceModel::Fixed);
        let strengths = |z: f32| {
            let bsdf = materials.resolve(id, &flat_point(), direction(z, 1.0));
            assert!((bsdf.kinds() & LobeSet::GLOSSY).is_empty(), "{}", subject.name);
            (bsdf.albedo(LobeSet::REFLECTION), bsdf.albedo(LobeSet::TRANSMISSION))
        };
        let head_on = strengths(0.99);
        for z in [0.7, 0.3, 0.1] {
            let (r, t) = strengths(z);
            let off = (r - head_on.0).abs().max_element().max((t - head_on.1).abs().max_element());
            assert!(off < 1e-5, "{} {z}: {r} {t} against {head_on:?}", subject.name);
            assert!((r + t).max_element() <= 1.0 + 1e-5, "{}: {r} {t}", subject.name);
        }
        for k in 0..40 {
            let bsdf = materials.resolve(id, &flat_point(), direction(0.5, 1.0));
            let mut s = sampler(3, k);
            let u = s.next_2d();
            if let Some(sample) = bsdf.sample(LobeSet::ALL, s.next_1d(), u, TransportMode::Importance) {
                assert!(sample.weight.max_element() < 4.0, "{}", subject.name);
            }
        }
    }
}

#[test]
fn inputs_become_coefficients() {
    let (materials, id) =
        prepare(vec![thesis(0.1, rgb(0.3, 0.2, 0.1), rgb(0.5, 0.6, 0.7))], vec![], SurfaceModel::Fixed);
    let bsdf = materials.resolve(id, &flat_point(), direction(0.3, 0.0));
    assert!((bsdf.albedo(LobeSet::DELTA_REFLECTION) - Vec3::new(0.3, 0.2, 0.1)).length() < 1e-6);
    assert!((bsdf.albedo(LobeSet::DELTA_TRANSMISSION) - Vec3::new(0.5, 0.6, 0.7)).length() < 1e-6);
    let (materials, id) = prepare(vec![glass()], vec![], SurfaceModel::Fixed);
    let bsdf = materials.resolve(id, &flat_point(), direction(0.05, 0.0));
    assert!((bsdf.albedo(LobeSet::REFLECTION).x - 0.04).abs() < 1e-6);
    // Beyond the critical angle all of it is reflected: there is nowhere else to go.
    let bsdf = materials.resolve(id, &flat_point(), direction(-0.3, 0.0));
    assert_eq!(bsdf.albedo(LobeSet::REFLECTION), Vec3::ONE);
}
