//! Interpolated, bumped and degenerate normals: nothing leaks, nothing is NaN.

use super::subjects::{picture, subjects};
use super::{direction, flat_point, grey, prepare, sampler, sphere, tilted_point};
use crate::bsdf::{LobeSet, SurfaceModel, TransportMode};
use photinus_geometry::{Vec2, Vec3};
use photinus_scene::{Material, MaterialId, TextureId};

/// Random and degenerate points and directions for every material: values are finite, not negative, and never cross
/// the geometric surface the wrong way.
#[test]
fn nothing_leaks_and_nothing_is_nan() {
    let odd = [
        Vec3::Z,
        -Vec3::Z,
        Vec3::X,
        -Vec3::Y,
        Vec3::new(1.0, 0.0, 1e-7).normalize(),
        Vec3::new(0.6, 0.8, -1e-20),
        Vec3::new(0.999_999_9, 0.0, 4.5e-4).normalize(),
    ];
    for (t, subject) in subjects().iter().enumerate() {
        let &(ref materials, id) = subject.prepare();
        for k in 0..250u64 {
            let mut s = sampler(t as u32, k);
            let pick = |u: [f32; 2]| {
                if u[0] < 0.3 { odd[(u[1] * odd.len() as f32) as usize] } else { sphere([(u[0] - 0.3) / 0.7, u[1]]) }
            };
            let (ng, ns, wo, wi) = (pick(s.next_2d()), pick(s.next_2d()), pick(s.next_2d()), pick(s.next_2d()));
            let mut point = flat_point();
            point.geometric_normal = ng;
            point.normal = if k % 2 == 0 { ns } else { (ng + ns * 0.4).normalize_or(ng) };
            point.uv = Vec2::new(s.next_1d() * 4.0 - 2.0, if k % 17 == 0 { f32::NAN } else { s.next_1d() });
            point.dp_du = if k % 5 == 0 { Vec3::ZERO } else { wi * 3.0 };
            point.dp_dv = ns;
            let bsdf = materials.resolve(id, &point, wo);
            let context = || format!("{} {k} ng {ng} ns {ns} wo {wo} wi {wi}", subject.name);
            for mode in [TransportMode::Radiance, TransportMode::Importance] {
                let value = bsdf.eval(LobeSet::ALL, wi, mode);
                assert!(value.is_finite() && value.min_element() >= 0.0, "{}: {value}", context());
                let pdf = bsdf.pdf(LobeSet::ALL, wi);
                assert!(pdf.is_finite() && pdf >= 0.0, "{}: {pdf}", context());
                let same_side = wi.dot(ng) * bsdf.geometric_normal().dot(ng) > 0.0;
                let leak = if same_side { LobeSet::TRANSMISSION } else { LobeSet::REFLECTION };
                assert_eq!(bsdf.eval(leak, wi, mode), Vec3::ZERO, "{}", context());
                let u = s.next_2d();
                if let Some(sample) = bsdf.sample(LobeSet::ALL, s.next_1d(), u, mode) {
                    assert!(sample.weight.is_finite() && sample.weight.min_element() >= 0.0, "{}", context());
                    assert!(sample.pdf > 0.0 && sample.pdf.is_finite() && sample.eta > 0.0, "{}", context());
                    assert!((sample.wi.length() - 1.0).abs() < 1e-4, "{}: {}", context(), sample.wi);
                    let side = sample.wi.dot(bsdf.geometric_normal());
                    let crossed = sample.kind.intersects(LobeSet::TRANSMISSION);
                    let straight = sample.wi == -wo;
                    assert!(straight || (side < 0.0) == crossed, "{}: {side} {:?}", context(), sample.kind);
                }
                if let Some(child) = bsdf.sample(LobeSet::DELTA, s.next_1d(), u, mode) {
                    assert!(child.wi.is_finite() && child.weight.is_finite(), "{}", context());
                }
            }
            assert!(bsdf.albedo(LobeSet::ALL).is_finite() && bsdf.shading_normal().is_finite());
        }
    }
}

/// A viewer who sees the geometry but is behind the interpolated normal must not see black.
#[test]
fn silhouettes_are_not_black() {
    let n = Vec3::new(-0.8, 0.0, 0.6);
    let wo = direction(0.2, 0.0);
    assert!(n.dot(wo) < 0.0);
    for subject in subjects() {
        let &(ref materials, id) = subject.prepare();
        let bsdf = materials.resolve(id, &tilted_point(n), wo);
        assert!(bsdf.shading_normal().dot(wo) > 0.0);
        if subject.name == "null" || subject.name.starts_with("bump") || subject.name.starts_with("normal") {
            continue;
        }
        let drawn = (0..64).filter(|&k| {
            let mut s = sampler(9, k);
            let u = s.next_2d();
            bsdf.sample(LobeSet::ALL, s.next_1d(), u, TransportMode::Radiance)
                .is_some_and(|s| s.weight.max_element() > 0.0)
        });
        assert!(drawn.count() > 8, "{}", subject.name);
    }
}

/// A ramp of heights tilts the normal by its slope: h = u / 2 on a unit square turns the normal by atan(1/2) against u.
#[test]
fn a_bump_map_tilts_by_the_slope() {
    let ramp = picture(16, |x, _| Vec3::splat((x as f32 + 0.5) / 16.0));
    let materials = vec![
        Material::Diffuse { reflectance: grey(1.0) },
        Material::BumpMap { height: TextureId(0), scale: 0.5, nested: MaterialId(0) },
    ];
    let (materials, id) = prepare(materials, vec![ramp], SurfaceModel::Physical);
    for z in [0.9, -0.9] {
        let bsdf = materials.resolve(id, &flat_point(), direction(z, 1.0));
        let expected = Vec3::new(-0.5, 0.0, 1.0).normalize() * z.signum();
        // Diffuse is black behind, but the normal is still that of the bump.
        assert!((bsdf.shading_normal() - expected).length() < 1e-3, "{}", bsdf.shading_normal());
    }
}

#[test]
fn a_flat_normal_map_and_a_constant_height_change_nothing() {
    let flat = picture(2, |_, _| Vec3::new(0.5, 0.5, 1.0));
    let level = picture(2, |_, _| Vec3::splat(0.7));
    let list = vec![
        Material::Diffuse { reflectance: grey(1.0) },
        Material::NormalMap { normals: TextureId(0), nested: MaterialId(0) },
        Material::BumpMap { height: TextureId(1), scale: 3.0, nested: MaterialId(0) },
    ];
    let (materials, _) = prepare(list, vec![flat, level], SurfaceModel::Physical);
    let n = Vec3::new(0.2, -0.1, 1.0).normalize();
    let wo = direction(0.6, 1.0);
    let plain = materials.resolve(MaterialId(0), &tilted_point(n), wo);
    for id in [1, 2] {
        let mapped = materials.resolve(MaterialId(id), &tilted_point(n), wo);
        assert!((mapped.shading_normal() - plain.shading_normal()).length() < 1e-5);
        for wi in [direction(0.9, 0.3), direction(0.2, 3.0)] {
            let mode = TransportMode::Radiance;
            let (a, b) = (mapped.eval(LobeSet::ALL, wi, mode), plain.eval(LobeSet::ALL, wi, mode));
            assert!((a - b).abs().max_element() < 1e-5, "{id}: {a} {b}");
        }
    }
}

#[test]
fn a_normal_map_is_read_in_the_tangent_frame() {
    let tilt = Vec3::new(0.6, 0.0, 0.8);
    let map = picture(1, |_, _| (tilt + Vec3::ONE) * 0.5);
    let list = vec![
        Material::Diffuse { reflectance: grey(1.0) },
        Material::NormalMap { normals: TextureId(0), nested: MaterialId(0) },
    ];
    let (materials, id) = prepare(list, vec![map], SurfaceModel::Physical);
    let mut point = flat_point();
    (point.dp_du, point.dp_dv) = (Vec3::Y, -Vec3::X);
    let bsdf = materials.resolve(id, &point, direction(0.9, 1.0));
    assert!((bsdf.shading_normal() - Vec3::new(0.0, 0.6, 0.8)).length() < 1e-4, "{}", bsdf.shading_normal());
}
