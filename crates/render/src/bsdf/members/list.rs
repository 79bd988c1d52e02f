//! The list of materials: it feeds the documentation, the tests and anyone who wants to name a material.

use photinus_scene::Material;

/// A kind of material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaterialKind {
    /// Name, as in documents and messages.
    pub name: &'static str,
    /// What it is, in a line.
    pub summary: &'static str,
}

const fn kind(name: &'static str, summary: &'static str) -> MaterialKind {
    MaterialKind { name, summary }
}

/// Every kind of material, in the order of the documentation.
pub const MATERIAL_KINDS: &[MaterialKind] = &[
    kind("diffuse", "Lambertian reflection"),
    kind("dielectric", "smooth glass"),
    kind("thin-dielectric", "a thin pane of glass"),
    kind("rough-dielectric", "ground glass"),
    kind("conductor", "polished metal"),
    kind("rough-conductor", "brushed metal"),
    kind("plastic", "a diffuse base under a smooth coat"),
    kind("rough-plastic", "a diffuse base under a rough coat"),
    kind("principled", "the Disney principled model"),
    kind("thesis", "one roughness from mirror to Lambertian, Fresnel reflection and transmission"),
    kind("two-sided", "a material on either side"),
    kind("mask", "holes"),
    kind("blend", "a mixture of two materials"),
    kind("bump-map", "normals tilted by a height texture"),
    kind("normal-map", "normals from a texture"),
    kind("null", "nothing: light passes"),
];

/// The kind of a material.
pub fn material_kind(material: &Material) -> MaterialKind {
    let index = match material {
        Material::Diffuse { .. } => 0,
        Material::Dielectric { .. } => 1,
        Material::ThinDielectric { .. } => 2,
        Material::RoughDielectric { .. } => 3,
        Material::Conductor { .. } => 4,
        Material::RoughConductor { .. } => 5,
        Material::Plastic { .. } => 6,
        Material::RoughPlastic { .. } => 7,
        Material::Principled { .. } => 8,
        Material::Thesis { .. } => 9,
        Material::TwoSided { .. } => 10,
        Material::Mask { .. } => 11,
        Material::Blend { .. } => 12,
        Material::BumpMap { .. } => 13,
        Material::NormalMap { .. } => 14,
        Material::Null => 15,
    };
    MATERIAL_KINDS[index]
}
