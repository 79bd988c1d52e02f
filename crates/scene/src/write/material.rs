//! Materials.

use super::Writer;
use crate::{ColorInput, FloatInput, Material, MaterialId, MicrofacetModel};
use photinus_geometry::Vec3;

impl Writer<'_> {
    /// Writes a material for shapes and other materials to refer to.
    pub(super) fn material(&mut self, index: usize) {
        let scene = self.scene;
        let material = &scene.materials[index].material;
        let name = self.materials.get(index).to_string();
        self.xml.open("bsdf", &[("type", kind(material)), ("id", &name)]);
        self.parameters(material);
        for nested in nested(material) {
            let nested = self.materials.get(nested.0 as usize).to_string();
            self.xml.leaf("ref", &[("id", &nested)]);
        }
        self.xml.close("bsdf");
    }

    fn parameters(&mut self, material: &Material) {
        match material {
            Material::Diffuse { reflectance } => self.color("reflectance", reflectance),
            Material::Dielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance }
            | Material::ThinDielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance } => {
                self.indices(*int_ior, *ext_ior);
                self.color("specular_reflectance", specular_reflectance);
                self.color("specular_transmittance", specular_transmittance);
            }
            Material::RoughDielectric {
                model,
                alpha,
                int_ior,
                ext_ior,
                specular_reflectance,
                specular_transmittance,
            } => {
                self.roughness(*model, alpha);
                self.indices(*int_ior, *ext_ior);
                self.color("specular_reflectance", specular_reflectance);
                self.color("specular_transmittance", specular_transmittance);
            }
            Material::Conductor { eta, k, specular_reflectance } => {
                self.complex_index(eta, k);
                self.color("specular_reflectance", specular_reflectance);
            }
            Material::RoughConductor { model, alpha, eta, k, specular_reflectance } => {
                self.roughness(*model, alpha);
                self.complex_index(eta, k);
                self.color("specular_reflectance", specular_reflectance);
            }
            Material::Plastic { int_ior, ext_ior, diffuse_reflectance, specular_reflectance, nonlinear } => {
                self.indices(*int_ior, *ext_ior);
                self.color("diffuse_reflectance", diffuse_reflectance);
                self.color("specular_reflectance", specular_reflectance);
                self.xml.value("boolean", "nonlinear", nonlinear);
            }
            Material::RoughPlastic {
                model,
                alpha,
                int_ior,
                ext_ior,
                diffuse_reflectance,
                specular_reflectance,
                nonlinear,
            } => {
                self.distribution(*model);
                self.float("alpha", alpha);
                self.indices(*int_ior, *ext_ior);
                self.color("diffuse_reflectance", diffuse_reflectance);
                self.color("specular_reflectance", specular_reflectance);
                self.xml.value("boolean", "nonlinear", nonlinear);
            }
            Material::Principled {
                base_color,
                roughness,
                anisotropic,
                metallic,
                spec_trans,
                eta,
                spec_tint,
                sheen,
                sheen_tint,
                flatness,
                clearcoat,
                clearcoat_gloss,
            } => {
                self.color("base_color", base_color);
                self.xml.value("float", "eta", eta);
                for (name, input) in [
                    ("roughness", roughness),
                    ("anisotropic", anisotropic),
                    ("metallic", metallic),
                    ("spec_trans", spec_trans),
                    ("spec_tint", spec_tint),
                    ("sheen", sheen),
                    ("sheen_tint", sheen_tint),
                    ("flatness", flatness),
                    ("clearcoat", clearcoat),
                    ("clearcoat_gloss", clearcoat_gloss),
                ] {
                    self.float(name, input);
                }
            }
            Material::Thesis { int_ior, ext_ior, roughness, reflectance, transmittance } => {
                self.indices(*int_ior, *ext_ior);
                self.float("roughness", roughness);
                self.color("reflectance", reflectance);
                self.color("transmittance", transmittance);
            }
            Material::Mask { opacity, .. } => self.float("opacity", opacity),
            Material::Blend { weight, .. } => self.float("weight", weight),
            Material::BumpMap { height, scale, .. } => {
                self.reference("bumpmap", *height);
                self.xml.value("float", "scale", scale);
            }
            Material::NormalMap { normals, .. } => self.reference("normalmap", *normals),
            Material::TwoSided { .. } | Material::Null => {}
        }
    }

    fn indices(&mut self, int_ior: f32, ext_ior: f32) {
        self.xml.value("float", "int_ior", int_ior);
        self.xml.value("float", "ext_ior", ext_ior);
    }

    fn distribution(&mut self, model: MicrofacetModel) {
        let name = match model {
            MicrofacetModel::Ggx => "ggx",
            MicrofacetModel::Beckmann => "beckmann",
        };
        self.xml.value("string", "distribution", name);
    }

    fn roughness(&mut self, model: MicrofacetModel, alpha: &[FloatInput; 2]) {
        self.distribution(model);
        if alpha[0] == alpha[1] {
            self.float("alpha", &alpha[0]);
        } else {
            self.float("alpha_u", &alpha[0]);
            self.float("alpha_v", &alpha[1]);
        }
    }

    fn complex_index(&mut self, eta: &ColorInput, k: &ColorInput) {
        let zero = ColorInput::Constant(Vec3::ZERO);
        if *eta == zero && *k == zero {
            self.xml.value("string", "material", "none");
        } else {
            self.color("eta", eta);
            self.color("k", k);
        }
    }
}

/// Name of the plug-in.
fn kind(material: &Material) -> &'static str {
    match material {
        Material::Diffuse { .. } => "diffuse",
        Material::Dielectric { .. } => "dielectric",
        Material::ThinDielectric { .. } => "thindielectric",
        Material::RoughDielectric { .. } => "roughdielectric",
        Material::Conductor { .. } => "conductor",
        Material::RoughConductor { .. } => "roughconductor",
        Material::Plastic { .. } => "plastic",
        Material::RoughPlastic { .. } => "roughplastic",
        Material::Principled { .. } => "principled",
        Material::Thesis { .. } => "photinus_thesis",
        Material::TwoSided { .. } => "twosided",
        Material::Mask { .. } => "mask",
        Material::Blend { .. } => "blendbsdf",
        Material::BumpMap { .. } => "bumpmap",
        Material::NormalMap { .. } => "normalmap",
        Material::Null => "null",
    }
}

/// What the element refers to: the same material on both sides is named once.
fn nested(material: &Material) -> Vec<MaterialId> {
    match material {
        Material::TwoSided { front, back } if front == back => vec![*front],
        other => other.nested().collect(),
    }
}
