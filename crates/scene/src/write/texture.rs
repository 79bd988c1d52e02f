//! Textures and pictures.

use super::names::file_name;
use super::xml::numbers;
use super::{WriteError, Writer, make_folder};
use crate::{Bitmap, BitmapPixels, ColorInput, FloatInput, Material, TextureFilter, TextureId, TextureKind, WrapMode};
use glam::{DAffine3, DMat3, DVec3};
use photinus_geometry::Affine3A;
use photinus_image::{Channel, Layer, Layers};
use std::sync::Arc;

impl Writer<'_> {
    /// Writes a texture for others to refer to.
    pub(super) fn texture(&mut self, id: TextureId) -> Result<(), WriteError> {
        let texture = &self.scene.textures[id.0 as usize];
        let name = self.textures.get(id.0 as usize).to_string();
        let to_uv = double(&texture.to_uv);
        let kind = match &texture.kind {
            TextureKind::Bitmap { .. } => "bitmap",
            TextureKind::Checkerboard { .. } => "checkerboard",
            TextureKind::Scale { .. } => "scale",
            TextureKind::VertexColor => "mesh_attribute",
        };
        let picture = match &texture.kind {
            TextureKind::Bitmap { bitmap, .. } => self.picture(bitmap, &name)?,
            _ => String::new(),
        };
        self.xml.open("texture", &[("type", kind), ("id", &name)]);
        match &texture.kind {
            TextureKind::Bitmap { bitmap, filter, wrap, alpha } => {
                self.xml.value("string", "filename", picture);
                self.xml.value("boolean", "raw", is_raw(bitmap));
                let filter = match filter {
                    TextureFilter::Nearest => "nearest",
                    TextureFilter::Bilinear => "bilinear",
                };
                self.xml.value("string", "filter_type", filter);
                let wrap = match wrap {
                    WrapMode::Repeat => "repeat",
                    WrapMode::Mirror => "mirror",
                    WrapMode::Clamp => "clamp",
                };
                self.xml.value("string", "wrap_mode", wrap);
                if *alpha {
                    self.xml.value("string", "channel", "a");
                } else if bitmap.has_holes() && self.is_opacity(id) {
                    // Said, because the mask would take the holes for its opacity.
                    self.xml.value("string", "channel", "all");
                }
                // Mitsuba's v runs down the picture.
                self.uv_map(&(flip_v() * to_uv * flip_v()));
            }
            TextureKind::Checkerboard { a, b } => {
                self.color("color0", a);
                self.color("color1", b);
                self.uv_map(&(to_uv * flip_v()));
            }
            TextureKind::Scale { input, factor } => {
                self.xml.value("float", "scale", factor);
                self.color("value", input);
            }
            TextureKind::VertexColor => self.xml.value("string", "name", "vertex_color"),
        }
        self.xml.close("texture");
        Ok(())
    }

    /// Whether a mask takes its opacity from this texture.
    fn is_opacity(&self, id: TextureId) -> bool {
        let takes = |m: &Material| matches!(m, Material::Mask { opacity, .. } if *opacity == FloatInput::Texture(id));
        self.scene.materials.iter().any(|m| takes(&m.material))
    }

    /// The plane's part of a map of texture coordinates.
    fn uv_map(&mut self, map: &DAffine3) {
        if *map == DAffine3::IDENTITY {
            return;
        }
        let (x, y, t) = (map.matrix3.x_axis, map.matrix3.y_axis, map.translation);
        let rows = [x.x, y.x, 0.0, t.x, x.y, y.y, 0.0, t.y, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        self.xml.open("transform", &[("name", "to_uv")]);
        self.xml.leaf("matrix", &[("value", &numbers(rows))]);
        self.xml.close("transform");
    }

    /// A colour parameter.
    pub(super) fn color(&mut self, name: &str, input: &ColorInput) {
        match input {
            ColorInput::Constant(c) => self.xml.value("rgb", name, numbers(c.to_array())),
            ColorInput::Texture(id) => self.reference(name, *id),
        }
    }

    /// A number parameter.
    pub(super) fn float(&mut self, name: &str, input: &FloatInput) {
        match input {
            FloatInput::Constant(v) => self.xml.value("float", name, v),
            FloatInput::Texture(id) => self.reference(name, *id),
        }
    }

    /// A texture parameter.
    pub(super) fn reference(&mut self, name: &str, id: TextureId) {
        let id = self.textures.get(id.0 as usize).to_string();
        self.xml.leaf("ref", &[("name", name), ("id", &id)]);
    }

    /// Writes a picture unless it is there; its path relative to the scene.
    pub(super) fn picture(&mut self, bitmap: &Arc<Bitmap>, name: &str) -> Result<String, WriteError> {
        let address = Arc::as_ptr(bitmap) as usize;
        if let Some(path) = self.pictures.get(&address) {
            return Ok(path.clone());
        }
        let (width, height) = (bitmap.width as usize, bitmap.height as usize);
        let stem = format!("textures/{}-{}", self.pictures.len(), file_name(name));
        make_folder(&self.folder.join("textures"))?;
        let relative = match &bitmap.pixels {
            BitmapPixels::Rgba8 { data, .. } => {
                let relative = format!("{stem}.png");
                photinus_image::write_png8_rgba(self.folder.join(&relative), width, height, data)?;
                relative
            }
            BitmapPixels::RgbaF32(data) => {
                let relative = format!("{stem}.exr");
                let channels = ["R", "G", "B", "A"].iter().enumerate().map(|(k, name)| Channel {
                    name: (*name).to_string(),
                    samples: data.iter().map(|p| p[k]).collect(),
                });
                let mut layers = Layers::new(width, height);
                layers.layers.push(Layer { name: String::new(), channels: channels.collect() });
                photinus_image::write_exr(self.folder.join(&relative), &layers)?;
                relative
            }
        };
        self.pictures.insert(address, relative.clone());
        Ok(relative)
    }
}

/// Whether a picture's numbers are read as they are.
pub(super) fn is_raw(bitmap: &Bitmap) -> bool {
    !matches!(bitmap.pixels, BitmapPixels::Rgba8 { srgb: true, .. })
}

/// (u, v) to (u, 1 - v).
fn flip_v() -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0)), translation: DVec3::Y }
}

/// The same map in double precision, exactly.
pub(super) fn double(map: &Affine3A) -> DAffine3 {
    let m = &map.matrix3;
    DAffine3 {
        matrix3: DMat3::from_cols(m.x_axis.as_dvec3(), m.y_axis.as_dvec3(), m.z_axis.as_dvec3()),
        translation: map.translation.as_dvec3(),
    }
}
