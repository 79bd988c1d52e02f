//! The materials: one file each, all of them in the three matches below.
//!
//! A member turns its resolved parameters into lobes.

mod blend;
mod bump_map;
mod conductor;
mod dielectric;
mod diffuse;
mod list;
mod mask;
mod normal_map;
mod plastic;
mod principled;
mod reads;
mod rough_conductor;
mod rough_dielectric;
mod rough_plastic;
mod thesis;
mod thin_dielectric;
mod two_sided;

pub use list::{MATERIAL_KINDS, MaterialKind, material_kind};
pub use reads::Reads;
pub(super) use reads::reads;

use super::builder::{Builder, Place};
use super::materials::{Materials, Table};
use crate::texture::TextureLookup;
use photinus_scene::{FloatInput, Material, MicrofacetModel};

/// Adds the lobes of `material` at `place`.
pub(super) fn add(builder: &mut Builder, material: &Material, place: Place) {
    match material {
        Material::TwoSided { .. }
        | Material::Mask { .. }
        | Material::Blend { .. }
        | Material::BumpMap { .. }
        | Material::NormalMap { .. }
        | Material::Null => {}
        _ => builder.occupy(place),
    }
    match *material {
        Material::Diffuse { reflectance } => diffuse::add(builder, place, reflectance),
        Material::Dielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance } => {
            dielectric::add(builder, place, [int_ior, ext_ior], specular_reflectance, specular_transmittance);
        }
        Material::ThinDielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance } => {
            thin_dielectric::add(builder, place, [int_ior, ext_ior], specular_reflectance, specular_transmittance);
        }
        Material::RoughDielectric { .. } => rough_dielectric::add(builder, place, material),
        Material::Conductor { eta, k, specular_reflectance } => {
            conductor::add(builder, place, eta, k, specular_reflectance);
        }
        Material::RoughConductor { .. } => rough_conductor::add(builder, place, material),
        Material::Plastic { .. } => plastic::add(builder, place, material),
        Material::RoughPlastic { .. } => rough_plastic::add(builder, place, material),
        Material::Principled { .. } => principled::add(builder, place, material),
        Material::Thesis { .. } => thesis::add(builder, place, material),
        Material::TwoSided { front, back } => two_sided::add(builder, place, front, back),
        Material::Mask { opacity, nested } => mask::add(builder, place, opacity, nested),
        Material::Blend { weight, a, b } => blend::add(builder, place, weight, a, b),
        Material::BumpMap { height, scale, nested } => bump_map::add(builder, place, height, scale, nested),
        Material::NormalMap { normals, nested } => normal_map::add(builder, place, normals, nested),
        // No lobe: the share that it takes is simply not solid.
        Material::Null => {}
    }
}

/// Probability that a ray meets `material`.
pub(super) fn opacity(
    materials: &Materials,
    material: photinus_scene::MaterialId,
    at: &TextureLookup,
    depth: u8,
) -> f32 {
    // As deep as lobes are collected; what lies below is solid there too.
    if depth > 8 || !materials.has_opacity(material) {
        return 1.0;
    }
    let of = |id| opacity(materials, id, at, depth + 1);
    match *materials.material(material) {
        Material::Null => 0.0,
        Material::Mask { opacity, nested } => {
            let share = materials.textures().float(opacity, at);
            if share > 0.0 { share.min(1.0) * of(nested) } else { 0.0 }
        }
        Material::Blend { weight, a, b } => {
            let weight = materials.textures().float(weight, at);
            let weight = if weight > 0.0 { weight.min(1.0) } else { 0.0 };
            (1.0 - weight) * of(a) + weight * of(b)
        }
        // Both sides of a two-sided surface have the same holes: those of its front.
        Material::TwoSided { front, .. } => of(front),
        Material::BumpMap { nested, .. } | Material::NormalMap { nested, .. } => of(nested),
        _ => 1.0,
    }
}

/// The tables that a material's lobes look up.
pub(super) fn tables(material: &Material) -> Vec<Table> {
    let ggx = MicrofacetModel::Ggx;
    match *material {
        Material::RoughConductor { model, .. } => vec![Table::SplitSum(model)],
        Material::RoughDielectric { model, int_ior, ext_ior, .. }
        | Material::RoughPlastic { model, int_ior, ext_ior, .. } => {
            vec![Table::Interface(model, dielectric::relative_index([int_ior, ext_ior]))]
        }
        Material::Principled { spec_trans: FloatInput::Constant(0.0), .. } => vec![Table::SplitSum(ggx)],
        Material::Principled { eta, .. } => {
            vec![Table::SplitSum(ggx), Table::Interface(ggx, principled::relative_index(eta))]
        }
        Material::Thesis { int_ior, ext_ior, .. } => {
            vec![Table::Interface(ggx, dielectric::relative_index([int_ior, ext_ior]))]
        }
        _ => vec![],
    }
}

/// The relative indices of which a material needs the mean reflectance under diffuse light.
pub(super) fn indices(material: &Material) -> Vec<f32> {
    match *material {
        Material::Plastic { int_ior, ext_ior, .. } | Material::Thesis { int_ior, ext_ior, .. } => {
            let eta = dielectric::relative_index([int_ior, ext_ior]);
            vec![eta, 1.0 / eta]
        }
        _ => vec![],
    }
}
