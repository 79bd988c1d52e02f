//! The surfaces: one entry per `<bsdf>` type that has no bsdf inside.

use super::color::Role;
use super::props::Props;
use super::{Importer, conductors, ior, names};
use crate::load::LoadError;
use crate::{ColorInput, FloatInput, Material, MicrofacetModel};
use photinus_geometry::Vec3;

impl<'t> Importer<'t, '_, '_> {
    /// The surface that `props` describes; none where it is a wrapper or unknown.
    pub(super) fn surface(&mut self, props: &Props<'t>) -> Result<Option<Material>, LoadError> {
        let material = match props.kind() {
            "diffuse" => self.diffuse(props)?,
            "roughdiffuse" => {
                self.context.warn(&props.place(), names::refusal("bsdf", "roughdiffuse"));
                props.ignore(&["alpha", "use_fast_approx"]);
                self.diffuse(props)?
            }
            "dielectric" => Material::Dielectric {
                int_ior: self.index(props, "int_ior", "bk7")?,
                ext_ior: self.index(props, "ext_ior", "air")?,
                specular_reflectance: self.factor(props, "specular_reflectance")?,
                specular_transmittance: self.factor(props, "specular_transmittance")?,
            },
            "thindielectric" => Material::ThinDielectric {
                int_ior: self.index(props, "int_ior", "bk7")?,
                ext_ior: self.index(props, "ext_ior", "air")?,
                specular_reflectance: self.factor(props, "specular_reflectance")?,
                specular_transmittance: self.factor(props, "specular_transmittance")?,
            },
            "roughdielectric" => Material::RoughDielectric {
                model: self.microfacets(props)?,
                alpha: self.alphas(props)?,
                int_ior: self.index(props, "int_ior", "bk7")?,
                ext_ior: self.index(props, "ext_ior", "air")?,
                specular_reflectance: self.factor(props, "specular_reflectance")?,
                specular_transmittance: self.factor(props, "specular_transmittance")?,
            },
            "conductor" => {
                let (eta, k) = self.complex_index(props)?;
                Material::Conductor { eta, k, specular_reflectance: self.factor(props, "specular_reflectance")? }
            }
            "roughconductor" => {
                let (eta, k) = self.complex_index(props)?;
                Material::RoughConductor {
                    model: self.microfacets(props)?,
                    alpha: self.alphas(props)?,
                    eta,
                    k,
                    specular_reflectance: self.factor(props, "specular_reflectance")?,
                }
            }
            "plastic" => Material::Plastic {
                int_ior: self.index(props, "int_ior", "polypropylene")?,
                ext_ior: self.index(props, "ext_ior", "air")?,
                diffuse_reflectance: self.color_or(props, "diffuse_reflectance", Role::Reflectance, 0.5)?,
                specular_reflectance: self.factor(props, "specular_reflectance")?,
                nonlinear: props.boolean("nonlinear")?.unwrap_or(false),
            },
            kind @ ("roughplastic" | "pplastic") => {
                if kind == "pplastic" {
                    self.context.warn(&props.place(), names::refusal("bsdf", kind));
                }
                Material::RoughPlastic {
                    model: self.microfacets(props)?,
                    alpha: self.alpha(props, "alpha")?.unwrap_or(FloatInput::Constant(0.1)),
                    int_ior: self.index(props, "int_ior", "polypropylene")?,
                    ext_ior: self.index(props, "ext_ior", "air")?,
                    diffuse_reflectance: self.color_or(props, "diffuse_reflectance", Role::Reflectance, 0.5)?,
                    specular_reflectance: self.factor(props, "specular_reflectance")?,
                    nonlinear: props.boolean("nonlinear")?.unwrap_or(false),
                }
            }
            kind @ ("principled" | "principledthin") => {
                if kind == "principledthin" {
                    self.context.warn(&props.place(), names::refusal("bsdf", kind));
                    props.ignore(&["diff_trans", "diffuse_transmittance_sampling_rate"]);
                }
                self.principled(props)?
            }
            "null" => Material::Null,
            "photinus_thesis" => Material::Thesis {
                int_ior: self.index(props, "int_ior", "bk7")?,
                ext_ior: self.index(props, "ext_ior", "air")?,
                roughness: self.float_or(props, "roughness", 1.0)?,
                reflectance: self.color_or(props, "reflectance", Role::Reflectance, 0.5)?,
                transmittance: self.color_or(props, "transmittance", Role::Reflectance, 0.0)?,
            },
            _ => return Ok(None),
        };
        Ok(Some(material))
    }

    fn diffuse(&mut self, props: &Props<'t>) -> Result<Material, LoadError> {
        let name = if props.has("reflectance") { "reflectance" } else { "diffuse_reflectance" };
        Ok(Material::Diffuse { reflectance: self.color_or(props, name, Role::Reflectance, 0.5)? })
    }

    /// A factor on light that is 1 where nothing is said.
    fn factor(&mut self, props: &Props<'t>, name: &str) -> Result<ColorInput, LoadError> {
        self.color_or(props, name, Role::Reflectance, 1.0)
    }

    /// An index of refraction, as a number or by name.
    fn index(&mut self, props: &Props<'t>, name: &str, default: &str) -> Result<f32, LoadError> {
        let is_text = props.get(name).is_some_and(|id| self.tree.node(id).tag == "string");
        let value = match (props.has(name), is_text) {
            (true, false) => props.float(name)?,
            (true, true) => {
                let text = props.string(name)?.unwrap_or_default();
                match ior::index(text) {
                    Some(index) => Some(index),
                    None => {
                        let message = format!("\"{text}\" is no known material; known are {}", ior::names());
                        return Err(LoadError::invalid(props.place_of(name), message));
                    }
                }
            }
            (false, _) => ior::index(default),
        };
        match value {
            Some(v) if v > 0.0 => Ok(v),
            _ => Err(LoadError::invalid(
                props.place_of(name),
                format!("the index of refraction \"{name}\" has to be above 0"),
            )),
        }
    }

    fn microfacets(&mut self, props: &Props<'t>) -> Result<MicrofacetModel, LoadError> {
        props.ignore(&["sample_visible"]);
        match props.choice("distribution")?.as_deref() {
            None | Some("beckmann") => Ok(MicrofacetModel::Beckmann),
            Some("ggx") => Ok(MicrofacetModel::Ggx),
            Some(other @ ("phong" | "as")) => {
                let message = format!("the distribution \"{other}\" is replaced by beckmann");
                self.context.warn(&props.place_of("distribution"), message);
                Ok(MicrofacetModel::Beckmann)
            }
            Some(other) => {
                let message = format!("unknown distribution \"{other}\": use beckmann or ggx");
                Err(LoadError::invalid(props.place_of("distribution"), message))
            }
        }
    }

    /// One roughness; a constant has to be 0 or more.
    fn alpha(&mut self, props: &Props<'t>, name: &str) -> Result<Option<FloatInput>, LoadError> {
        let alpha = self.float_input(props, name)?;
        if props.has(name) && self.tree.node(props.get(name).unwrap_or_default()).tag == "float" {
            props.float_in(name, 0.0..=f32::MAX)?;
        }
        Ok(alpha)
    }

    /// Roughness along both axes.
    fn alphas(&mut self, props: &Props<'t>) -> Result<[FloatInput; 2], LoadError> {
        let both = self.alpha(props, "alpha")?.unwrap_or(FloatInput::Constant(0.1));
        Ok([self.alpha(props, "alpha_u")?.unwrap_or(both), self.alpha(props, "alpha_v")?.unwrap_or(both)])
    }

    /// Index and extinction of a metal: given, or by name; "none" is a perfect mirror.
    fn complex_index(&mut self, props: &Props<'t>) -> Result<(ColorInput, ColorInput), LoadError> {
        let constant = |v: Vec3| ColorInput::Constant(v);
        let mirror = (constant(Vec3::ZERO), constant(Vec3::ZERO));
        let material = props.string("material")?;
        let exterior = if props.has("ext_eta") { self.index(props, "ext_eta", "air")? } else { 1.0 };
        let relative = |c: ColorInput| match c {
            ColorInput::Constant(v) => ColorInput::Constant(v / exterior),
            texture @ ColorInput::Texture(_) => texture,
        };
        if props.has("eta") || props.has("k") {
            if material.is_some() {
                self.context.warn(&props.place_of("material"), "eta and k are given: the material's name is ignored");
            }
            let eta = self.color_or(props, "eta", Role::Unbounded, 0.0)?;
            let k = self.color_or(props, "k", Role::Unbounded, 1.0)?;
            return Ok((relative(eta), relative(k)));
        }
        // Mitsuba 0.x took copper where nothing was said, Mitsuba 3 takes a mirror.
        let name = material.unwrap_or(if self.tree.is_old(props.id()) { "Cu" } else { "none" });
        if name.eq_ignore_ascii_case("none") {
            return Ok(mirror);
        }
        match conductors::conductor(name) {
            Some((eta, k)) => Ok((relative(constant(eta.into())), relative(constant(k.into())))),
            None => {
                let known: Vec<_> = conductors::CONDUCTORS.iter().map(|c| c.0).collect();
                let message = format!("\"{name}\" is no known conductor; known are none, {}", known.join(", "));
                Err(LoadError::invalid(props.place_of("material"), message))
            }
        }
    }

    fn principled(&mut self, props: &Props<'t>) -> Result<Material, LoadError> {
        props.ignore(&["main_specular_sampling_rate", "clearcoat_sampling_rate", "diffuse_reflectance_sampling_rate"]);
        // Disney's "specular" is the reflectance at normal incidence over 0.08 (Burley 2015, section 5.4).
        let eta = match (props.float_in("eta", 1.0..=100.0)?, props.float_in("specular", 0.0..=12.0)?) {
            (Some(eta), _) => eta,
            (None, specular) => 2.0 / (1.0 - (0.08 * specular.unwrap_or(0.5)).sqrt()) - 1.0,
        };
        Ok(Material::Principled {
            base_color: self.color_or(props, "base_color", Role::Reflectance, 0.5)?,
            roughness: self.float_or(props, "roughness", 0.5)?,
            anisotropic: self.float_or(props, "anisotropic", 0.0)?,
            metallic: self.float_or(props, "metallic", 0.0)?,
            spec_trans: self.float_or(props, "spec_trans", 0.0)?,
            eta: eta.max(1.001),
            spec_tint: self.float_or(props, "spec_tint", 0.0)?,
            sheen: self.float_or(props, "sheen", 0.0)?,
            sheen_tint: self.float_or(props, "sheen_tint", 0.0)?,
            flatness: self.float_or(props, "flatness", 0.0)?,
            clearcoat: self.float_or(props, "clearcoat", 0.0)?,
            clearcoat_gloss: self.float_or(props, "clearcoat_gloss", 0.0)?,
        })
    }
}
