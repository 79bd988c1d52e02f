//! What a library's material means in light transport.
//!
//! The format (Wavefront, "MTL material format", 1995) describes Phong shading: the formulas of its `illum` models are
//! read here as BSDFs, and each departure is noted where it is made.

use super::super::{Context, Draft, Place};
use super::parse::MapKind;
use super::textures::Textures;
use super::{Library, RawMaterial};
use crate::{ColorInput, FloatInput, Material, MaterialId, MicrofacetModel};
use photinus_geometry::Vec3;

/// A material of the scene, and what it emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::load) struct Converted {
    pub(in crate::load) material: MaterialId,
    /// Radiance, if the material shines.
    pub(in crate::load) emission: Option<ColorInput>,
    /// Light bends at its surface, so that inside and outside matter.
    pub(in crate::load) is_glass: bool,
}

/// Index of a coat, and of glass whose file gives none.
const DEFAULT_IOR: f32 = 1.5;
/// A mirror whose diffuse part is below this share of its reflection is a mirror only.
const NEGLIGIBLE_DIFFUSE: f32 = 0.05;

/// Adds material `raw` of `library` to the draft.
pub(in crate::load) fn convert(
    raw: &RawMaterial,
    library: &Library,
    draft: &mut Draft,
    context: &mut Context<'_>,
) -> Converted {
    let mut c = Converter { raw, library, draft, context };
    c.warn_of_unused();
    let is_glass = c.is_glass();
    let base = match raw.illum {
        _ if c.is_physically_based() => c.principled(),
        _ if is_glass => c.glass(),
        Some(3 | 5) if raw.ks.is_some_and(|ks| ks.max_element() > 0.0) => c.mirror(),
        Some(0 | 1) => c.diffuse_only(),
        Some(10) => {
            c.warn("illum 10 (shadows on invisible surfaces) is not supported: read as diffuse");
            c.diffuse_only()
        }
        Some(11..) => {
            c.warn("unknown illum model: read as illum 2");
            c.phong()
        }
        _ => c.phong(),
    };
    let material = c.tilted_normals(base);
    let material = c.opened(material);
    Converted { material, emission: c.emission(), is_glass }
}

struct Converter<'a, 'c> {
    raw: &'a RawMaterial,
    library: &'a Library,
    draft: &'a mut Draft,
    context: &'a mut Context<'c>,
}

impl<'c> Converter<'_, 'c> {
    fn warn(&mut self, message: &str) {
        let place = Place::new(&self.library.path, self.raw.line);
        self.context.warn(&place, format!("material \"{}\": {message}", self.raw.name));
    }

    fn warn_of_unused(&mut self) {
        for (kind, map) in &self.raw.maps {
            // The ambient colour has no meaning in light transport, and exporters repeat the diffuse picture there.
            if *kind == MapKind::Unused && !map.statement.eq_ignore_ascii_case("map_Ka") {
                let place = Place::new(&self.library.path, map.line);
                self.context.warn(&place, format!("{} is not supported: ignored", map.statement));
            }
        }
        if self.raw.anisor.is_some_and(|x| x != 0.0) {
            self.warn("a turned anisotropy (anisor) is not supported: ignored");
        }
    }

    fn textures(&mut self) -> Textures<'_, 'c> {
        Textures { library: self.library, draft: self.draft, context: self.context }
    }

    fn add(&mut self, suffix: &str, material: Material) -> MaterialId {
        self.draft.add_material(format!("{}{suffix}", self.raw.name), material)
    }

    /// `material`, seen alike from both sides: OBJ faces have none.
    fn two_sided(&mut self, material: Material) -> MaterialId {
        let inner = self.add(".side", material);
        self.add("", Material::TwoSided { front: inner, back: inner })
    }

    fn is_physically_based(&self) -> bool {
        let r = self.raw;
        let numbers = [r.pr, r.pm, r.ps, r.pc, r.pcr, r.aniso];
        numbers.iter().any(Option::is_some)
            || [MapKind::Roughness, MapKind::Metallic, MapKind::Sheen].iter().any(|&k| r.map(k).is_some())
    }

    /// Diffuse colour times `factor`. A picture multiplies `Kd`; black there counts as white, as exporters write both.
    fn diffuse(&mut self, factor: f32) -> ColorInput {
        let raw = self.raw;
        let kd = self.kd();
        match raw.map(MapKind::Diffuse) {
            Some(map) => self.textures().color(map, kd * factor, true).unwrap_or(ColorInput::Constant(kd * factor)),
            None => ColorInput::Constant(kd * factor),
        }
    }

    /// Largest diffuse reflectance, each channel.
    fn kd(&self) -> Vec3 {
        let textured = self.raw.map(MapKind::Diffuse).is_some();
        let default = if textured { Vec3::ONE } else { Vec3::splat(0.5) };
        match self.raw.kd {
            Some(kd) if textured && kd == Vec3::ZERO => Vec3::ONE,
            kd => kd.unwrap_or(default).min(Vec3::ONE),
        }
    }

    fn diffuse_only(&mut self) -> MaterialId {
        let reflectance = self.diffuse(1.0);
        self.two_sided(Material::Diffuse { reflectance })
    }

    /// GGX roughness of the Phong exponent `Ns`, by Walter et al., "Microfacet Models for Refraction through Rough
    /// Surfaces", EGSR 2007, section 5.2: exponent = 2 / alpha² - 2.
    fn alpha(&self) -> f32 {
        let exponent = self.raw.ns.unwrap_or(0.0).max(0.0);
        (2.0 / (exponent + 2.0)).sqrt().clamp(1e-3, 1.0)
    }

    /// `illum 2`: Kd + Ks with a lobe of exponent Ns.
    fn phong(&mut self) -> MaterialId {
        let ks = self.raw.ks.unwrap_or(Vec3::ZERO).min(Vec3::ONE);
        if ks.max_element() <= 0.0 {
            return self.diffuse_only();
        }
        let alpha = FloatInput::Constant(self.alpha());
        if self.library.raw.from_blender {
            // Blender writes its "specular" value there: reflectance 0.08 times that at normal incidence.
            return self.weak_coat(0.08 * ks.max_element(), alpha);
        }
        self.diffuse_and_lobe(ks, |specular_reflectance| Material::RoughConductor {
            model: MicrofacetModel::Ggx,
            alpha: [alpha; 2],
            eta: ColorInput::Constant(Vec3::ZERO),
            k: ColorInput::Constant(Vec3::ZERO),
            specular_reflectance,
        })
    }

    /// A diffuse base under a coat of reflectance `f0` at normal incidence.
    fn weak_coat(&mut self, f0: f32, alpha: FloatInput) -> MaterialId {
        let root = f0.sqrt();
        let diffuse_reflectance = self.diffuse(1.0);
        self.two_sided(Material::RoughPlastic {
            model: MicrofacetModel::Ggx,
            alpha,
            int_ior: ((1.0 + root) / (1.0 - root)).max(1.001),
            ext_ior: 1.0,
            diffuse_reflectance,
            specular_reflectance: ColorInput::Constant(Vec3::ONE),
            nonlinear: false,
        })
    }

    /// `illum 3` and `5`: Kd + Ks times what a mirror shows.
    fn mirror(&mut self) -> MaterialId {
        let ks = self.raw.ks.unwrap_or(Vec3::ZERO).min(Vec3::ONE);
        let zero = ColorInput::Constant(Vec3::ZERO);
        self.diffuse_and_lobe(ks, |specular_reflectance| Material::Conductor {
            eta: zero,
            k: zero,
            specular_reflectance,
        })
    }

    /// Kd diffuse plus Ks of `lobe`, scaled down together where they reflect more than they receive.
    fn diffuse_and_lobe(&mut self, ks: Vec3, lobe: impl Fn(ColorInput) -> Material) -> MaterialId {
        let raw = self.raw;
        let (most_diffuse, most_specular) = (self.kd().max_element(), ks.max_element());
        let scale = 1.0 / (self.kd() + ks).max_element().max(1.0);
        let only_lobe = most_diffuse <= NEGLIGIBLE_DIFFUSE * most_specular;
        // The weight of the lobe, and what it and the rest must be multiplied by to add up to Kd + Ks again.
        let weight = if only_lobe { 1.0 } else { most_specular / (most_diffuse + most_specular) };
        let tint = ks * (scale / weight);
        let specular = raw.map(MapKind::Specular).and_then(|map| self.textures().color(map, tint, false));
        let shiny = lobe(specular.unwrap_or(ColorInput::Constant(tint)));
        if only_lobe {
            return self.two_sided(shiny);
        }
        let reflectance = self.diffuse(scale / (1.0 - weight));
        let a = self.add(".diffuse", Material::Diffuse { reflectance });
        let b = self.add(".specular", shiny);
        self.two_sided(Material::Blend { weight: FloatInput::Constant(weight), a, b })
    }

    /// Index of refraction of a glass; none where the file says that light passes straight.
    fn glass_ior(&self) -> Option<f32> {
        match self.raw.ni {
            None => Some(DEFAULT_IOR),
            Some(ni) if ni > 1.0 => Some(ni.min(10.0)),
            Some(_) => None,
        }
    }

    fn is_glass(&self) -> bool {
        matches!(self.raw.illum, Some(4 | 6 | 7 | 9)) && self.glass_ior().is_some()
    }

    /// `illum 4`, `6`, `7` and `9`. Fresnel's equations say how much is reflected, not `Ks`.
    fn glass(&mut self) -> MaterialId {
        let mut filter = self.raw.tf.unwrap_or(Vec3::ONE).min(Vec3::ONE);
        let grey = filter.max_element() - filter.min_element() < 1e-3;
        if grey && filter.x < 0.5 {
            self.warn("a grey Tf below one half is read as opacity, as Maya writes it: 1 - Tf passes");
            filter = 1.0 - filter;
        }
        // Tf filters what passes through the object, in and out again: the root is each surface's share.
        let transmittance = Vec3::new(filter.x.sqrt(), filter.y.sqrt(), filter.z.sqrt());
        self.add(
            "",
            Material::Dielectric {
                int_ior: self.glass_ior().unwrap_or(DEFAULT_IOR),
                ext_ior: 1.0,
                specular_reflectance: ColorInput::Constant(Vec3::ONE),
                specular_transmittance: ColorInput::Constant(transmittance),
            },
        )
    }

    /// The extension for physically based materials: Pr, Pm, Ps, Pc, Pcr, aniso.
    fn principled(&mut self) -> MaterialId {
        let raw = self.raw;
        let glass = self.is_glass();
        let unit = |x: Option<f32>, default: f32| x.unwrap_or(default).clamp(0.0, 1.0);
        // The model's roughness is the square root of alpha (Burley 2012, section 5.4).
        let roughness_default = if raw.ns.is_some() { self.alpha().sqrt() } else { 0.5 };
        let base_color = self.diffuse(1.0);
        let mut input = |kind: MapKind, value: f32| {
            let texture = raw.map(kind).and_then(|map| self.textures().number(map));
            texture.unwrap_or(FloatInput::Constant(value))
        };
        let roughness = input(MapKind::Roughness, unit(raw.pr, roughness_default));
        let metallic = input(MapKind::Metallic, unit(raw.pm, 0.0));
        let sheen = input(MapKind::Sheen, unit(raw.ps, 0.0));
        let constant = FloatInput::Constant;
        let material = Material::Principled {
            base_color,
            roughness,
            anisotropic: constant(unit(raw.aniso, 0.0)),
            metallic,
            spec_trans: constant(if glass { 1.0 } else { 0.0 }),
            eta: self.glass_ior().unwrap_or(DEFAULT_IOR).max(1.001),
            spec_tint: constant(0.0),
            sheen,
            sheen_tint: constant(0.0),
            flatness: constant(0.0),
            clearcoat: constant(unit(raw.pc, 0.0)),
            clearcoat_gloss: constant(1.0 - unit(raw.pcr, 0.0)),
        };
        if glass { self.add("", material) } else { self.two_sided(material) }
    }

    /// Bump or normal map around `nested`.
    fn tilted_normals(&mut self, nested: MaterialId) -> MaterialId {
        let raw = self.raw;
        if let Some(map) = raw.map(MapKind::Normal)
            && let Some(normals) = self.textures().data(map)
        {
            return self.add(".normals", Material::NormalMap { normals, nested });
        }
        if let Some(map) = raw.map(MapKind::Bump)
            && let Some(height) = self.textures().data(map)
        {
            let scale = map.bump_multiplier * map.gain;
            return self.add(".bump", Material::BumpMap { height, scale, nested });
        }
        nested
    }

    /// `nested` with holes where `d`, `Tr` or a picture of the opacity says so.
    fn opened(&mut self, nested: MaterialId) -> MaterialId {
        let raw = self.raw;
        if let Some(map) = raw.map(MapKind::Opacity)
            && let Some(opacity) = self.textures().opacity(map)
        {
            return self.add(".mask", Material::Mask { opacity, nested });
        }
        if self.is_glass() {
            return nested;
        }
        let opacity = self.opacity();
        if opacity >= 1.0 {
            return nested;
        }
        self.add(".mask", Material::Mask { opacity: FloatInput::Constant(opacity), nested })
    }

    /// `d`, or 1 - `Tr`. Some programs write `Tr` as if it were `d`, so that a material which would vanish stays.
    fn opacity(&mut self) -> f32 {
        let raw = self.raw;
        match (raw.d, raw.tr) {
            (Some(d), Some(tr)) if (d + tr - 1.0).abs() > 1e-3 => {
                self.warn("d and Tr contradict each other: d is used");
                d.clamp(0.0, 1.0)
            }
            (Some(d), _) => {
                if d <= 0.0 {
                    self.warn("d 0 makes it invisible");
                }
                d.clamp(0.0, 1.0)
            }
            (None, Some(tr)) if tr >= 1.0 => {
                self.warn("Tr 1 would make it invisible: read as opaque");
                1.0
            }
            (None, tr) => 1.0 - tr.unwrap_or(0.0).clamp(0.0, 1.0),
        }
    }

    /// `Ke` times its picture. Libraries older than `Ke` mark lights by an ambient colour above 1.
    fn emission(&mut self) -> Option<ColorInput> {
        let raw = self.raw;
        let ke = raw.ke.unwrap_or(Vec3::ZERO);
        if let Some(map) = raw.map(MapKind::Emission) {
            let tint = if raw.ke.is_none() || ke == Vec3::ZERO { Vec3::ONE } else { ke };
            if let Some(color) = self.textures().color(map, tint, false) {
                return Some(color);
            }
        }
        if ke.max_element() > 0.0 {
            return Some(ColorInput::Constant(ke));
        }
        let ka = raw.ka.unwrap_or(Vec3::ZERO);
        if raw.ke.is_none() && ka.max_element() > 1.0 {
            self.warn("an ambient colour above 1 is read as emission");
            return Some(ColorInput::Constant(ka));
        }
        None
    }
}
