//! What things are made of: paints, woods, cloths, metals and glass, made once a scene and found again by name.

use super::{Drawing, Stage, bitmap, bitmap::hex, rgb};
use crate::{
    Bitmap, ColorInput, FloatInput, Material, MaterialId, MicrofacetModel, Texture, TextureFilter, TextureKind,
    WrapMode,
};
use photinus_geometry::{Affine3A, Vec3};
use std::sync::Arc;

/// Index of varnish, glaze and plastic coats.
const COAT_IOR: f32 = 1.5;
/// A coat of wax: index low enough that it mirrors a hundredth, GGX roughness low enough that paths follow it.
const WAX_IOR: f32 = 1.25;
const WAX_ROUGHNESS: f32 = 0.2;

/// Linear RGB of a chart colour 0xRRGGBB (IEC 61966-2-1).
pub fn linear(number: u32) -> [f32; 3] {
    hex(number).to_array().map(|c| if c <= 0.040_45 { c / 12.92 } else { libm::powf((c + 0.055) / 1.055, 2.4) })
}

/// A constant colour from the chart.
pub fn chart(number: u32) -> ColorInput {
    rgb(linear(number))
}

/// How a surface of some colour shines.
#[derive(Clone, Copy, Debug)]
pub enum Finish {
    /// Not at all: cloth, wall paint, paper.
    Matte,
    /// Softly, with this GGX roughness: oiled wood, leaves; on a [waxed stage](Stage::waxed) like wax.
    Satin(f32),
    /// Like a smooth coat: glaze, lacquer.
    Gloss,
}

impl Stage {
    /// The material of this name, made by `make` when the scene has none yet.
    fn once(&mut self, name: &str, make: impl FnOnce(&mut Self) -> Material) -> MaterialId {
        if let Some(known) = self.find_material(name) {
            return known;
        }
        let material = make(self);
        self.two_sided(name, material)
    }

    /// A coloured surface, the same from both sides.
    pub fn paint(&mut self, name: &str, color: u32, finish: Finish) -> MaterialId {
        self.once(name, |stage| finished(chart(color), finish, stage.waxed))
    }

    /// A surface that shows a picture, which is drawn while the scene grows; one repeat covers `tile` of the mesh's texture coordinates.
    pub fn printed(
        &mut self,
        name: &str,
        tile: [f32; 2],
        finish: Finish,
        picture: impl FnOnce() -> Arc<Bitmap> + Send + 'static,
    ) -> MaterialId {
        self.once(name, |stage| {
            let (name, drawing) = (name.to_owned(), Drawing::begin(picture));
            let texture = stage.texture(move || Texture {
                name,
                kind: TextureKind::Bitmap {
                    bitmap: drawing.finished(),
                    filter: TextureFilter::Bilinear,
                    wrap: WrapMode::Repeat,
                    alpha: false,
                },
                to_uv: Affine3A::from_scale(Vec3::new(1.0 / tile[0], 1.0 / tile[1], 1.0)),
            });
            finished(ColorInput::Texture(texture), finish, stage.waxed)
        })
    }

    /// Brown wood with its grain along the longer side of boards.
    pub fn oak(&mut self) -> MaterialId {
        self.printed("oak", [28.0, 70.0], Finish::Satin(0.3), || bitmap::grain(11, hex(0xB98A58), hex(0x7C5330)))
    }

    /// Dark red-brown wood.
    pub fn walnut(&mut self) -> MaterialId {
        self.printed("walnut", [24.0, 60.0], Finish::Satin(0.3), || bitmap::grain(12, hex(0x7A5138), hex(0x3E2517)))
    }

    /// Brass, lightly brushed (eta and k of Johnson and Christy's copper and zinc alloys, rounded).
    pub fn brass(&mut self) -> MaterialId {
        self.metal("brass", 0.12, [0.444, 0.527, 1.094], [3.695, 2.765, 1.829])
    }

    /// Satin steel (eta and k of chromium, rounded).
    pub fn steel(&mut self) -> MaterialId {
        self.metal("steel", 0.1, [3.18, 3.18, 2.33], [3.31, 3.33, 3.13])
    }

    fn metal(&mut self, name: &str, roughness: f32, eta: [f32; 3], k: [f32; 3]) -> MaterialId {
        self.once(name, |_| Material::RoughConductor {
            model: MicrofacetModel::Ggx,
            alpha: [FloatInput::Constant(roughness); 2],
            eta: rgb(eta),
            k: rgb(k),
            specular_reflectance: rgb([1.0; 3]),
        })
    }

    /// A silvered mirror.
    pub fn looking_glass(&mut self) -> MaterialId {
        self.once("looking-glass", |_| Material::Conductor {
            eta: rgb([0.0; 3]),
            k: rgb([0.0; 3]),
            specular_reflectance: rgb([0.9; 3]),
        })
    }

    /// Solid clear glass; shared by all closed glass bodies.
    pub fn clear_glass(&mut self) -> MaterialId {
        match self.find_material("glass") {
            Some(known) => known,
            None => self.glass("glass"),
        }
    }
}

fn finished(color: ColorInput, finish: Finish, waxed: bool) -> Material {
    let specular_reflectance = rgb([1.0; 3]);
    match finish {
        Finish::Matte => Material::Diffuse { reflectance: color },
        Finish::Satin(roughness) => {
            let (roughness, int_ior) =
                if waxed { (roughness.min(WAX_ROUGHNESS), WAX_IOR) } else { (roughness, COAT_IOR) };
            Material::RoughPlastic {
                model: MicrofacetModel::Ggx,
                alpha: FloatInput::Constant(roughness),
                int_ior,
                ext_ior: 1.0,
                diffuse_reflectance: color,
                specular_reflectance,
                nonlinear: false,
            }
        }
        Finish::Gloss => Material::Plastic {
            int_ior: COAT_IOR,
            ext_ior: 1.0,
            diffuse_reflectance: color,
            specular_reflectance,
            nonlinear: false,
        },
    }
}
