//! What materials read of the surface that they are on: what they do not read need not be made at every hit.

use photinus_scene::{ColorInput, FloatInput, Material};
use std::ops::BitOr;

/// What is read of a [`SurfacePoint`](crate::SurfacePoint) beside its place and normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reads {
    /// Texture coordinates, the pixel's footprint in them, vertex colours.
    pub textures: bool,
    /// The directions of the texture coordinates.
    pub tangents: bool,
}

impl Reads {
    /// Nothing.
    pub const NONE: Self = Self { textures: false, tangents: false };
    /// Everything.
    pub const ALL: Self = Self { textures: true, tangents: true };

    /// What an input reads.
    pub fn of_color(input: ColorInput) -> Self {
        Self { textures: matches!(input, ColorInput::Texture(_)), tangents: false }
    }

    fn of_numbers<const N: usize>(inputs: [FloatInput; N]) -> Self {
        Self { textures: inputs.iter().any(|input| matches!(input, FloatInput::Texture(_))), tangents: false }
    }

    fn of_colors<const N: usize>(inputs: [ColorInput; N]) -> Self {
        inputs.into_iter().map(Self::of_color).fold(Self::NONE, Self::bitor)
    }

    fn tangents_if(condition: bool) -> Self {
        Self { textures: false, tangents: condition }
    }
}

impl BitOr for Reads {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self { textures: self.textures || other.textures, tangents: self.tangents || other.tangents }
    }
}

/// What a material reads itself, what it is made of left out. No field is passed over by `..`, so that a new input is not
/// forgotten here.
pub fn reads(material: &Material) -> Reads {
    match *material {
        Material::Diffuse { reflectance } => Reads::of_color(reflectance),
        Material::Dielectric { int_ior: _, ext_ior: _, specular_reflectance, specular_transmittance }
        | Material::ThinDielectric { int_ior: _, ext_ior: _, specular_reflectance, specular_transmittance } => {
            Reads::of_colors([specular_reflectance, specular_transmittance])
        }
        Material::RoughDielectric {
            model: _,
            alpha,
            int_ior: _,
            ext_ior: _,
            specular_reflectance,
            specular_transmittance,
        } => {
            Reads::of_numbers(alpha)
                | Reads::of_colors([specular_reflectance, specular_transmittance])
                | Reads::tangents_if(alpha[0] != alpha[1])
        }
        Material::Conductor { eta, k, specular_reflectance } => Reads::of_colors([eta, k, specular_reflectance]),
        Material::RoughConductor { model: _, alpha, eta, k, specular_reflectance } => {
            Reads::of_numbers(alpha)
                | Reads::of_colors([eta, k, specular_reflectance])
                | Reads::tangents_if(alpha[0] != alpha[1])
        }
        Material::Plastic { int_ior: _, ext_ior: _, diffuse_reflectance, specular_reflectance, nonlinear: _ } => {
            Reads::of_colors([diffuse_reflectance, specular_reflectance])
        }
        Material::RoughPlastic {
            model: _,
            alpha,
            int_ior: _,
            ext_ior: _,
            diffuse_reflectance,
            specular_reflectance,
            nonlinear: _,
        } => Reads::of_numbers([alpha]) | Reads::of_colors([diffuse_reflectance, specular_reflectance]),
        Material::Principled {
            base_color,
            roughness,
            anisotropic,
            metallic,
            spec_trans,
            eta: _,
            spec_tint,
            sheen,
            sheen_tint,
            flatness,
            clearcoat,
            clearcoat_gloss,
        } => {
            let base = [roughness, anisotropic, metallic, spec_trans, spec_tint];
            let layers = [sheen, sheen_tint, flatness, clearcoat, clearcoat_gloss];
            Reads::of_color(base_color)
                | Reads::of_numbers(base)
                | Reads::of_numbers(layers)
                | Reads::tangents_if(anisotropic != FloatInput::Constant(0.0))
        }
        Material::Thesis { int_ior: _, ext_ior: _, roughness, reflectance, transmittance } => {
            Reads::of_numbers([roughness]) | Reads::of_colors([reflectance, transmittance])
        }
        Material::Mask { opacity, nested: _ } => Reads::of_numbers([opacity]),
        Material::Blend { weight, a: _, b: _ } => Reads::of_numbers([weight]),
        Material::BumpMap { height: _, scale: _, nested: _ } | Material::NormalMap { normals: _, nested: _ } => {
            Reads::ALL
        }
        Material::TwoSided { front: _, back: _ } | Material::Null => Reads::NONE,
    }
}
