//! Light runs the same both ways.

use super::subjects::subjects;
use super::{flat_point, sampler, sphere, tilted_point};
use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use photinus_geometry::Vec3;

/// Index of refraction on either side, relative to each other: transmission scales radiance by its square.
fn eta_towards(bsdf: &Bsdf, wi: Vec3) -> f32 {
    if bsdf.geometric_normal().dot(wi) > 0.0 {
        return 1.0;
    }
    bsdf.lobes().iter().map(|lobe| lobe.eta).find(|&eta| eta != 1.0).unwrap_or(1.0)
}

/// f(wo, wi) / eta_o^2 = f(wi, wo) / eta_i^2 with the shading normal along the geometric one (Veach 1997, equation 5.14).
#[test]
fn values_are_reciprocal() {
    let mut compared = 0;
    for (t, subject) in subjects().iter().enumerate() {
        // Bumps shadow the light's direction only, and different materials on either side are no one surface.
        if subject.name.contains("map") || subject.name == "two-sided" {
            continue;
        }
        let &(ref materials, id) = subject.prepare();
        for k in 0..300 {
            let mut s = sampler(t as u32, k);
            let (wo, wi) = (sphere(s.next_2d()), sphere(s.next_2d()));
            if wo.z.abs() < 0.02 || wi.z.abs() < 0.02 {
                continue;
            }
            let (there, back) = (materials.resolve(id, &flat_point(), wo), materials.resolve(id, &flat_point(), wi));
            let mode = TransportMode::Radiance;
            let a = there.eval(LobeSet::ALL, wi, mode) / wi.z.abs();
            let b = back.eval(LobeSet::ALL, wo, mode) / wo.z.abs();
            let eta = eta_towards(&there, wi);
            let b = b / (eta * eta);
            let scale = a.max_element().max(b.max_element());
            if scale > 1e-4 {
                assert!((a - b).abs().max_element() < 5e-3 * scale, "{} {wo} {wi}: {a} {b}", subject.name);
                compared += 1;
            }
        }
    }
    assert!(compared > 2000, "{compared}");
}

/// Importance is the adjoint of radiance, shading normals and bumps included: both see the same surface. With
/// K(light, eye) = value / (cosine of the geometric normal), the photon's way from wo to wi equals the eye's from wi to wo.
#[test]
fn importance_is_the_adjoint_of_radiance() {
    let mut compared = 0;
    for (t, subject) in subjects().iter().enumerate() {
        if subject.name == "two-sided" {
            continue;
        }
        let &(ref materials, id) = subject.prepare();
        for normal in [Vec3::Z, Vec3::new(0.3, -0.1, 1.0).normalize()] {
            let point = tilted_point(normal);
            for k in 0..200 {
                let mut s = sampler(t as u32, k);
                let (light, eye) = (sphere(s.next_2d()), sphere(s.next_2d()));
                let (photon, radiance) = (materials.resolve(id, &point, light), materials.resolve(id, &point, eye));
                // A normal turned towards its viewer cannot be the same for two viewers.
                let outward = |b: &Bsdf, i: usize| b.frames[i].axes.n * b.geometric_normal().z;
                let same = photon.frames.len() == radiance.frames.len()
                    && (0..photon.frames.len()).all(|i| (outward(&photon, i) - outward(&radiance, i)).length() < 1e-5);
                if light.z.abs() < 0.05 || eye.z.abs() < 0.05 || !same {
                    continue;
                }
                let a = photon.eval(LobeSet::ALL, eye, TransportMode::Importance) / eye.z.abs();
                let b = radiance.eval(LobeSet::ALL, light, TransportMode::Radiance) / light.z.abs();
                let scale = a.max_element().max(b.max_element());
                if scale > 1e-4 {
                    assert!((a - b).abs().max_element() < 5e-3 * scale, "{} {light} {eye}: {a} {b}", subject.name);
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 2000, "{compared}");
}
