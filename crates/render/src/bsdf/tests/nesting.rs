//! Deep, wide and broken trees of materials.

use super::subjects::{plastic, principled, rough_plastic};
use super::{direction, flat_point, grey, num, prepare, sampler};
use crate::bsdf::{LobeSet, SurfaceModel, TransportMode};
use photinus_geometry::Vec3;
use photinus_scene::{ColorInput, Material, MaterialId, MicrofacetModel, TextureId, TextureKind};

/// Blends of blends of themselves double at every level; the depth is bounded, so this returns, and stays sane.
#[test]
fn endless_blends_end() {
    let mut list = vec![Material::Diffuse { reflectance: grey(0.5) }];
    for i in 0..200 {
        list.push(Material::Blend { weight: num(0.5), a: MaterialId(i), b: MaterialId(i) });
    }
    let (materials, id) = prepare(list, vec![], SurfaceModel::Physical);
    let bsdf = materials.resolve(id, &flat_point(), direction(0.5, 0.0));
    let value = bsdf.eval(LobeSet::ALL, direction(0.5, 2.0), TransportMode::Radiance).x;
    assert!((value - 0.25 / std::f32::consts::PI).abs() < 1e-5, "{value}");
    assert_eq!(materials.opacity(id, &flat_point().lookup()), 1.0);
}

#[test]
fn endless_masks_end() {
    let mut list = vec![Material::Null];
    for i in 0..200 {
        list.push(Material::Blend { weight: num(0.5), a: MaterialId(i), b: MaterialId(i) });
    }
    let (materials, id) = prepare(list, vec![], SurfaceModel::Physical);
    let opacity = materials.opacity(id, &flat_point().lookup());
    assert!((0.0..=1.0).contains(&opacity));
    assert!(materials.resolve(id, &flat_point(), direction(0.5, 0.0)).albedo(LobeSet::ALL).is_finite());
}

/// More lobes than a sum holds: the energy stays, in a diffuse lobe.
#[test]
fn too_many_lobes_keep_their_energy() {
    let mut list: Vec<Material> =
        (0..6).map(|i| rough_plastic(MicrofacetModel::Ggx, 0.1 + 0.1 * i as f32, grey(0.5), false)).collect();
    list.push(principled(grey(0.5), 0.4, [0.0, 0.0, 0.0, 0.0, 0.3, 0.0, 0.0, 1.0, 0.5]));
    list.push(plastic(grey(0.5), false));
    for i in 0..7 {
        let a = if i == 0 { 0 } else { 7 + i };
        list.push(Material::Blend { weight: num(0.5), a: MaterialId(a), b: MaterialId(i + 1) });
    }
    let (materials, id) = prepare(list, vec![], SurfaceModel::Physical);
    let bsdf = materials.resolve(id, &flat_point(), direction(0.8, 0.0));
    assert!(bsdf.lobes().len() <= 8);
    let mut sum = 0.0;
    for k in 0..4000 {
        let mut s = sampler(2, k);
        let u = s.next_2d();
        sum += bsdf.sample(LobeSet::ALL, s.next_1d(), u, TransportMode::Importance).map_or(0.0, |s| s.weight.x);
    }
    // Every one of them reflects about half.
    assert!((sum / 4000.0 - 0.5).abs() < 0.06, "{}", sum / 4000.0);
    assert!((bsdf.albedo(LobeSet::ALL).x - 0.5).abs() < 0.06, "{}", bsdf.albedo(LobeSet::ALL));
}

/// A blend stands for the sum of a diffuse and a mirror lobe, with factors above 1 that its weights make up for.
#[test]
fn blends_may_stand_for_sums() {
    let list = vec![
        Material::Diffuse { reflectance: super::rgb(1.2, 0.2, 0.2) },
        Material::Conductor { eta: grey(0.0), k: grey(0.0), specular_reflectance: super::rgb(0.4, 1.6, 9.0) },
        Material::Blend { weight: num(0.5), a: MaterialId(0), b: MaterialId(1) },
    ];
    let (materials, _) = prepare(list, vec![], SurfaceModel::Physical);
    let albedo = |id, set| materials.resolve(MaterialId(id), &flat_point(), direction(0.5, 0.0)).albedo(set);
    assert!((albedo(2, LobeSet::DIFFUSE) - Vec3::new(0.6, 0.1, 0.1)).length() < 1e-6);
    assert!((albedo(2, LobeSet::DELTA) - Vec3::new(0.2, 0.8, 1.0)).length() < 1e-6);
    assert!((albedo(0, LobeSet::ALL) - Vec3::new(1.0, 0.2, 0.2)).length() < 1e-6, "alone it is bounded by 1");
}

/// Ids out of range and materials inside themselves are mid-grey.
#[test]
fn broken_references_are_grey() {
    let list = vec![
        Material::TwoSided { front: MaterialId(0), back: MaterialId(0) },
        Material::Blend { weight: num(0.5), a: MaterialId(99), b: MaterialId(0) },
        Material::Diffuse { reflectance: ColorInput::Texture(TextureId(12)) },
        Material::BumpMap { height: TextureId(7), scale: 1.0, nested: MaterialId(2) },
    ];
    let (materials, _) = prepare(list, vec![], SurfaceModel::Physical);
    for id in [0, 1, 2, 3, 50] {
        let bsdf = materials.resolve(MaterialId(id), &flat_point(), direction(0.5, 0.0));
        assert!((bsdf.albedo(LobeSet::ALL) - Vec3::splat(0.5)).abs().max_element() < 1e-6, "{id}");
    }
}

/// Parameters that no file should hold.
#[test]
fn absurd_parameters_are_safe() {
    for x in [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e30, 1e-30] {
        let c = ColorInput::Constant(Vec3::new(x, 0.5, -x));
        let list = [
            Material::Diffuse { reflectance: c },
            Material::Dielectric { int_ior: x, ext_ior: 1.0, specular_reflectance: c, specular_transmittance: c },
            Material::Dielectric { int_ior: 1.5, ext_ior: x, specular_reflectance: c, specular_transmittance: c },
            Material::RoughDielectric {
                model: MicrofacetModel::Beckmann,
                alpha: [num(x), num(0.2)],
                int_ior: 1.5,
                ext_ior: 1.0,
                specular_reflectance: c,
                specular_transmittance: c,
            },
            Material::RoughConductor {
                model: MicrofacetModel::Ggx,
                alpha: [num(x); 2],
                eta: c,
                k: c,
                specular_reflectance: grey(1.0),
            },
            Material::Plastic {
                int_ior: x,
                ext_ior: 1.0,
                diffuse_reflectance: c,
                specular_reflectance: c,
                nonlinear: true,
            },
            principled(c, x, [x; 9]),
            Material::Thesis { int_ior: x, ext_ior: 1.0, roughness: num(x), reflectance: c, transmittance: c },
            Material::Blend { weight: num(x), a: MaterialId(0), b: MaterialId(0) },
        ];
        for material in list {
            let list = vec![Material::Diffuse { reflectance: grey(0.5) }, material.clone()];
            for model in [SurfaceModel::Physical, SurfaceModel::Fixed] {
                let (materials, id) = prepare(list.clone(), vec![], model);
                let bsdf = materials.resolve(id, &flat_point(), direction(0.4, 1.0));
                let value = bsdf.eval(LobeSet::ALL, direction(0.6, 2.0), TransportMode::Radiance);
                assert!(value.is_finite() && value.min_element() >= 0.0, "{material:?}: {value}");
                if let Some(child) = bsdf.sample(LobeSet::DELTA, 0.5, [0.5; 2], TransportMode::Radiance) {
                    assert!(child.wi.is_finite() && child.weight.is_finite(), "{material:?}");
                }
            }
        }
    }
}

#[test]
fn endless_textures_end() {
    let nest = |a: u32, b: u32| {
        super::texture(TextureKind::Checkerboard {
            a: ColorInput::Texture(TextureId(a)),
            b: ColorInput::Texture(TextureId(b)),
        })
    };
    let textures = vec![nest(1, 0), nest(0, 1)];
    let list = vec![Material::Diffuse { reflectance: ColorInput::Texture(TextureId(0)) }];
    let (materials, id) = prepare(list, textures, SurfaceModel::Physical);
    let mut point = flat_point();
    point.uv_footprint = 0.7;
    assert!(materials.resolve(id, &point, direction(0.5, 0.0)).albedo(LobeSet::ALL).is_finite());
}
