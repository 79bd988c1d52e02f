//! The materials that the tests loop over: at least one of every kind on the list.

use super::{grey, num, prepare, rgb, texture};
use crate::bsdf::{MATERIAL_KINDS, Materials, SurfaceModel, material_kind};
use photinus_geometry::Vec3;
use photinus_scene::{
    Bitmap, BitmapPixels, ColorInput, Material, MaterialId, MicrofacetModel, Texture, TextureFilter, TextureId,
    TextureKind, WrapMode,
};
use std::sync::{Arc, OnceLock};

pub struct Subject {
    pub name: String,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    prepared: OnceLock<(Materials, MaterialId)>,
}

impl Subject {
    pub fn new(name: &str, materials: Vec<Material>, textures: Vec<Texture>) -> Self {
        Self { name: name.into(), materials, textures, prepared: OnceLock::new() }
    }

    /// The materials with their tables, made on first use, and the id of the one to test.
    pub fn prepare(&self) -> &(Materials, MaterialId) {
        self.prepared.get_or_init(|| prepare(self.materials.clone(), self.textures.clone(), SurfaceModel::Physical))
    }
}

/// Glass of index 1.5 in vacuum.
pub fn glass() -> Material {
    Material::Dielectric {
        int_ior: 1.5,
        ext_ior: 1.0,
        specular_reflectance: grey(1.0),
        specular_transmittance: grey(1.0),
    }
}

pub fn rough_glass(model: MicrofacetModel, alpha: [f32; 2], int_ior: f32) -> Material {
    Material::RoughDielectric {
        model,
        alpha: alpha.map(num),
        int_ior,
        ext_ior: 1.0,
        specular_reflectance: grey(1.0),
        specular_transmittance: grey(1.0),
    }
}

/// A metal with the index of gold, about, or a perfect mirror.
pub fn metal(model: MicrofacetModel, alpha: [f32; 2], mirror: bool) -> Material {
    let (eta, k) = if mirror { (grey(0.0), grey(0.0)) } else { (rgb(0.143, 0.375, 1.442), rgb(3.983, 2.386, 1.603)) };
    Material::RoughConductor { model, alpha: alpha.map(num), eta, k, specular_reflectance: grey(1.0) }
}

pub fn rough_plastic(model: MicrofacetModel, alpha: f32, base: ColorInput, nonlinear: bool) -> Material {
    Material::RoughPlastic {
        model,
        alpha: num(alpha),
        int_ior: 1.49,
        ext_ior: 1.000277,
        diffuse_reflectance: base,
        specular_reflectance: grey(1.0),
        nonlinear,
    }
}

pub fn plastic(base: ColorInput, nonlinear: bool) -> Material {
    Material::Plastic {
        int_ior: 1.49,
        ext_ior: 1.000277,
        diffuse_reflectance: base,
        specular_reflectance: grey(1.0),
        nonlinear,
    }
}

pub fn thesis(roughness: f32, reflectance: ColorInput, transmittance: ColorInput) -> Material {
    Material::Thesis { int_ior: 1.5, ext_ior: 1.0, roughness: num(roughness), reflectance, transmittance }
}

/// The principled parameters as an array, in the order of the fields from roughness on (index of refraction apart).
pub fn principled(base_color: ColorInput, roughness: f32, rest: [f32; 9]) -> Material {
    let [anisotropic, metallic, spec_trans, spec_tint, sheen, sheen_tint, flatness, clearcoat, gloss] = rest.map(num);
    Material::Principled {
        base_color,
        roughness: num(roughness),
        anisotropic,
        metallic,
        spec_trans,
        eta: 1.5,
        spec_tint,
        sheen,
        sheen_tint,
        flatness,
        clearcoat,
        clearcoat_gloss: gloss,
    }
}

/// A picture of `size` x `size` pixels, linear floats, clamped.
pub fn picture(size: u32, pixel: impl Fn(u32, u32) -> Vec3) -> Texture {
    let data = (0..size * size).map(|i| pixel(i % size, i / size).extend(1.0).to_array()).collect();
    texture(TextureKind::Bitmap {
        bitmap: Arc::new(Bitmap { width: size, height: size, pixels: BitmapPixels::RgbaF32(data) }),
        filter: TextureFilter::Bilinear,
        wrap: WrapMode::Clamp,
        alpha: false,
    })
}

fn one(name: &str, material: Material) -> Subject {
    Subject::new(name, vec![material], vec![])
}

/// All of them, shared by the tests: tables take longer than most of these.
pub fn subjects() -> &'static [Subject] {
    static SUBJECTS: OnceLock<Vec<Subject>> = OnceLock::new();
    SUBJECTS.get_or_init(make_subjects)
}

/// Colours below 1 and different per channel where that could hide a mistake.
fn make_subjects() -> Vec<Subject> {
    use MicrofacetModel::{Beckmann, Ggx};
    let color = rgb(0.8, 0.5, 0.2);
    let mut list = vec![
        one("diffuse", Material::Diffuse { reflectance: color }),
        one("dielectric", glass()),
        one(
            "thin-dielectric",
            Material::ThinDielectric {
                int_ior: 1.5,
                ext_ior: 1.0,
                specular_reflectance: grey(1.0),
                specular_transmittance: color,
            },
        ),
        one(
            "conductor",
            Material::Conductor { eta: rgb(0.2, 0.9, 1.1), k: rgb(3.9, 2.4, 2.2), specular_reflectance: color },
        ),
        one("plastic", plastic(color, false)),
        one("plastic nonlinear", plastic(color, true)),
        one("principled", principled(color, 0.5, [0.0; 9])),
        one("principled metal", principled(color, 0.6, [0.7, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])),
        one("principled glass", principled(color, 0.5, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])),
        one("principled all", principled(color, 0.4, [0.3, 0.3, 0.4, 0.5, 0.8, 0.5, 0.4, 1.0, 0.2])),
        one("principled smooth", principled(color, 0.0, [0.0, 0.2, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])),
        one("null", Material::Null),
    ];
    for model in [Ggx, Beckmann] {
        for alpha in [[0.05, 0.05], [0.3, 0.3], [0.9, 0.9], [0.1, 0.6]] {
            list.push(one(&format!("rough-dielectric {model:?} {alpha:?}"), rough_glass(model, alpha, 1.5)));
            list.push(one(&format!("rough-conductor {model:?} {alpha:?}"), metal(model, alpha, false)));
        }
        list.push(one(&format!("rough-dielectric {model:?} 1.05"), rough_glass(model, [0.3; 2], 1.05)));
        list.push(one(&format!("rough-plastic {model:?}"), rough_plastic(model, 0.2, color, model == Ggx)));
    }
    for roughness in [0.0, 0.3, 0.7, 1.0] {
        list.push(one(&format!("thesis opaque {roughness}"), thesis(roughness, color, grey(0.0))));
        list.push(one(&format!("thesis clear {roughness}"), thesis(roughness, color, rgb(0.5, 0.9, 0.7))));
    }
    let base =
        || vec![Material::Diffuse { reflectance: color }, metal(Ggx, [0.2; 2], false), rough_glass(Ggx, [0.4; 2], 1.5)];
    let id = MaterialId;
    let mut nested = |name: &str, top: Material, textures: Vec<Texture>| {
        let mut materials = base();
        materials.push(top);
        list.push(Subject::new(name, materials, textures));
    };
    nested("two-sided", Material::TwoSided { front: id(0), back: id(1) }, vec![]);
    nested("mask", Material::Mask { opacity: num(0.3), nested: id(1) }, vec![]);
    nested("blend", Material::Blend { weight: num(0.6), a: id(0), b: id(2) }, vec![]);
    let wave = picture(8, |x, y| Vec3::splat(0.02 * ((x * 3 + y * 5) % 7) as f32));
    nested("bump-map", Material::BumpMap { height: TextureId(0), scale: 2.0, nested: id(1) }, vec![wave.clone()]);
    nested("bump-map glass", Material::BumpMap { height: TextureId(0), scale: 1.0, nested: id(2) }, vec![wave]);
    let tilt = picture(1, |_, _| (Vec3::new(0.3, -0.2, 0.9).normalize() + Vec3::ONE) * 0.5);
    nested("normal-map", Material::NormalMap { normals: TextureId(0), nested: id(0) }, vec![tilt]);
    list
}

#[test]
fn every_kind_has_a_subject_and_a_heading_in_the_documentation() {
    let subjects = subjects();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/materials.md");
    let document = std::fs::read_to_string(path).expect("docs/materials.md");
    for kind in MATERIAL_KINDS {
        let tested = subjects.iter().any(|s| s.materials.last().is_some_and(|m| material_kind(m) == *kind));
        assert!(tested, "no test subject for {}", kind.name);
        assert!(document.contains(&format!("\n### {}\n", kind.name)), "no heading for {}", kind.name);
        assert!(document.contains(kind.summary), "docs/materials.md lacks the summary of {}", kind.name);
    }
}
