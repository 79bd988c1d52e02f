//! Tests over all materials. Every random number comes from `SEED`.

mod chi_square;
mod energy;
mod fixed;
mod known_answers;
mod mitsuba_values;
mod nesting;
mod recipes;
mod reciprocity;
mod shading_normals;
mod subjects;

use super::{Bsdf, Materials, SurfaceModel};
use crate::SurfacePoint;
use photinus_geometry::{Affine3A, Vec2, Vec3};
use photinus_num::{Sampler, StreamKind};
use photinus_scene::{ColorInput, FloatInput, Material, MaterialId, NamedMaterial, Texture, TextureKind};

pub(super) const SEED: u64 = 20_260_806;

/// Independent random numbers: each sample its own stream.
pub(super) fn sampler(test: u32, sample: u64) -> Sampler {
    Sampler::new(SEED, StreamKind::Test, (u64::from(test) << 32) | sample, 0)
}

/// A uniform direction on the sphere.
pub(super) fn sphere(u: [f32; 2]) -> Vec3 {
    let z = 1.0 - 2.0 * u[0];
    let r = (1.0 - z * z).max(0.0).sqrt();
    let phi = u[1] * std::f32::consts::TAU;
    Vec3::new(r * phi.cos(), r * phi.sin(), z)
}

/// A direction of elevation cosine `z` (negative: behind) and azimuth `phi`.
pub(super) fn direction(z: f32, phi: f32) -> Vec3 {
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * phi.cos(), r * phi.sin(), z)
}

pub(super) fn rgb(r: f32, g: f32, b: f32) -> ColorInput {
    ColorInput::Constant(Vec3::new(r, g, b))
}

pub(super) fn grey(x: f32) -> ColorInput {
    ColorInput::Constant(Vec3::splat(x))
}

pub(super) fn num(x: f32) -> FloatInput {
    FloatInput::Constant(x)
}

pub(super) fn texture(kind: TextureKind) -> Texture {
    Texture { name: "test".into(), kind, to_uv: Affine3A::IDENTITY }
}

/// The materials prepared, and the id of the last one.
pub(super) fn prepare(
    materials: Vec<Material>,
    textures: Vec<Texture>,
    model: SurfaceModel,
) -> (Materials, MaterialId) {
    let last = MaterialId(materials.len() as u32 - 1);
    let named: Vec<_> = materials.into_iter().map(|material| NamedMaterial { name: "test".into(), material }).collect();
    (Materials::from_lists(&named, &textures, model), last)
}

/// A point whose geometric normal is z.
pub(super) fn flat_point() -> SurfacePoint {
    tilted_point(Vec3::Z)
}

/// A point whose geometric normal is z and whose shading normal is `n`.
pub(super) fn tilted_point(n: Vec3) -> SurfacePoint {
    SurfacePoint {
        position: Vec3::ZERO,
        offset: 1e-4,
        geometric_normal: Vec3::Z,
        normal: n,
        uv: Vec2::new(0.3, 0.4),
        dp_du: Vec3::X,
        dp_dv: Vec3::Y,
        color: Vec3::ONE,
        uv_footprint: 0.0,
        shape: 0,
        prim: 0,
    }
}

/// One material resolved at the flat point.
pub(super) fn resolve(material: Material, wo: Vec3) -> Bsdf {
    let (materials, id) = prepare(vec![material], vec![], SurfaceModel::Physical);
    materials.resolve(id, &flat_point(), wo)
}
