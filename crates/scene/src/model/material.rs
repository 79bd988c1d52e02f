//! Surface materials: what a surface does to light, as data.

use super::texture::{ColorInput, FloatInput, TextureId};
use photinus_geometry::Vec3;

/// Index into [`Scene::materials`](super::Scene::materials).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// Distribution of microfacet normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MicrofacetModel {
    /// Trowbridge-Reitz (Walter et al. 2007).
    Ggx,
    /// Beckmann-Spizzichino.
    Beckmann,
}

/// A material. Indices of refraction are relative to vacuum; colours are linear RGB factors, 1 for no change.
///
/// Names and defaults follow Mitsuba 3's plug-ins, which document each parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// Lambertian reflection.
    Diffuse {
        /// Albedo.
        reflectance: ColorInput,
    },
    /// Smooth glass: the normal points from interior to exterior.
    Dielectric {
        /// Index inside.
        int_ior: f32,
        /// Index outside.
        ext_ior: f32,
        /// Factor on reflection.
        specular_reflectance: ColorInput,
        /// Factor on transmission.
        specular_transmittance: ColorInput,
    },
    /// A thin pane: both interfaces at once, no bending.
    ThinDielectric {
        /// Index inside.
        int_ior: f32,
        /// Index outside.
        ext_ior: f32,
        /// Factor on reflection.
        specular_reflectance: ColorInput,
        /// Factor on transmission.
        specular_transmittance: ColorInput,
    },
    /// Ground glass.
    RoughDielectric {
        /// Microfacet distribution.
        model: MicrofacetModel,
        /// Roughness along the tangent and bitangent.
        alpha: [FloatInput; 2],
        /// Index inside.
        int_ior: f32,
        /// Index outside.
        ext_ior: f32,
        /// Factor on reflection.
        specular_reflectance: ColorInput,
        /// Factor on transmission.
        specular_transmittance: ColorInput,
    },
    /// Polished metal; `eta` and `k` both zero means a perfect mirror (Mitsuba's material "none").
    Conductor {
        /// Real index, per channel.
        eta: ColorInput,
        /// Extinction, per channel.
        k: ColorInput,
        /// Factor on reflection.
        specular_reflectance: ColorInput,
    },
    /// Brushed metal.
    RoughConductor {
        /// Microfacet distribution.
        model: MicrofacetModel,
        /// Roughness along the tangent and bitangent.
        alpha: [FloatInput; 2],
        /// Real index, per channel.
        eta: ColorInput,
        /// Extinction, per channel.
        k: ColorInput,
        /// Factor on reflection.
        specular_reflectance: ColorInput,
    },
    /// A diffuse base under a smooth coat.
    Plastic {
        /// Index of the coat.
        int_ior: f32,
        /// Index outside.
        ext_ior: f32,
        /// Albedo of the base.
        diffuse_reflectance: ColorInput,
        /// Factor on the coat's reflection.
        specular_reflectance: ColorInput,
        /// Whether inter-reflection inside the coat shifts the colour.
        nonlinear: bool,
    },
    /// A diffuse base under a rough coat.
    RoughPlastic {
        /// Microfacet distribution.
        model: MicrofacetModel,
        /// Roughness.
        alpha: FloatInput,
        /// Index of the coat.
        int_ior: f32,
        /// Index outside.
        ext_ior: f32,
        /// Albedo of the base.
        diffuse_reflectance: ColorInput,
        /// Factor on the coat's reflection.
        specular_reflectance: ColorInput,
        /// Whether inter-reflection inside the coat shifts the colour.
        nonlinear: bool,
    },
    /// The Disney principled model, solid form (Burley 2012 and 2015), parameters in 0..1 unless said.
    Principled {
        /// Surface colour.
        base_color: ColorInput,
        /// Roughness of the main lobe.
        roughness: FloatInput,
        /// Stretch of the highlight.
        anisotropic: FloatInput,
        /// Metal or not.
        metallic: FloatInput,
        /// Glass or not.
        spec_trans: FloatInput,
        /// Index of refraction, above 1.
        eta: f32,
        /// Tint of the highlight towards the base colour.
        spec_tint: FloatInput,
        /// Retro-reflection at grazing angles.
        sheen: FloatInput,
        /// Tint of the sheen.
        sheen_tint: FloatInput,
        /// Mixes the diffuse lobe with a flat one.
        flatness: FloatInput,
        /// Strength of a second, clear coat.
        clearcoat: FloatInput,
        /// Gloss of that coat.
        clearcoat_gloss: FloatInput,
    },
    /// The thesis's surface (3.1.3): Fresnel decides reflect, transmit or absorb; one roughness spreads both, 0 a
    /// mirror, 1 a Lambertian surface.
    Thesis {
        /// Index inside.
        int_ior: f32,
        /// Index outside.
        ext_ior: f32,
        /// Microscopic roughness, 0 to 1.
        roughness: FloatInput,
        /// Colour of reflected light.
        reflectance: ColorInput,
        /// Colour of transmitted light; black: opaque, and what enters is absorbed or scattered back diffusely.
        transmittance: ColorInput,
    },
    /// `front` on the side of the normal, `back` on the other.
    TwoSided {
        /// Outside.
        front: MaterialId,
        /// Inside; often the same.
        back: MaterialId,
    },
    /// Holes: with probability 1 - opacity light passes straight through.
    Mask {
        /// 0 clear, 1 solid.
        opacity: FloatInput,
        /// What the solid part is made of.
        nested: MaterialId,
    },
    /// A mixture: `weight` of `b`, the rest of `a`.
    Blend {
        /// Share of `b`, 0 to 1.
        weight: FloatInput,
        /// First material.
        a: MaterialId,
        /// Second material.
        b: MaterialId,
    },
    /// Normals tilted by the slope of a height texture.
    BumpMap {
        /// Heights, in scene units after `scale`.
        height: TextureId,
        /// Factor on the heights.
        scale: f32,
        /// What the surface is made of.
        nested: MaterialId,
    },
    /// Normals read from a texture, (r, g, b) = (n + 1) / 2 in the tangent frame.
    NormalMap {
        /// The picture, read as linear.
        normals: TextureId,
        /// What the surface is made of.
        nested: MaterialId,
    },
    /// Nothing: light passes unchanged.
    Null,
}

impl Material {
    /// Mid-grey, for what a file leaves open (Mitsuba's default reflectance of 0.5).
    pub fn default_diffuse() -> Self {
        Self::Diffuse { reflectance: ColorInput::Constant(Vec3::splat(0.5)) }
    }

    /// Materials that this one is made of.
    pub fn nested(&self) -> impl Iterator<Item = MaterialId> {
        match *self {
            Self::TwoSided { front, back } => [Some(front), Some(back)],
            Self::Blend { a, b, .. } => [Some(a), Some(b)],
            Self::Mask { nested, .. } | Self::BumpMap { nested, .. } | Self::NormalMap { nested, .. } => {
                [Some(nested), None]
            }
            _ => [None, None],
        }
        .into_iter()
        .flatten()
    }
}

/// A material and its name. A nested material's index is below that of the material around it: no cycles.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMaterial {
    /// Id in the file, or one made up from its kind and number.
    pub name: String,
    /// The surface.
    pub material: Material,
}
