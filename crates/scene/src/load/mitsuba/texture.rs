//! Textures, and the inputs of other plug-ins that may be a constant or a texture.

use super::color::Role;
use super::props::Props;
use super::tree::NodeId;
use super::{Importer, State, names};
use crate::load::bitmap::load_bitmap;
use crate::load::{BitmapEncoding, LoadError};
use crate::{Bitmap, BitmapPixels, ColorInput, FloatInput, Texture, TextureFilter, TextureId, TextureKind, WrapMode};
use glam::DAffine3;
use photinus_geometry::{Affine3A, Mat3, Vec3};
use std::sync::Arc;

/// What stands for a texture that cannot be read.
const MID_GREY: f32 = 0.5;

impl<'t> Importer<'t, '_, '_> {
    /// The colour parameter of that name.
    pub(super) fn color_input(
        &mut self,
        props: &Props<'t>,
        name: &str,
        role: Role,
    ) -> Result<Option<ColorInput>, LoadError> {
        let Some(id) = props.get(name) else { return Ok(None) };
        if let Some(color) = self.color_value(id, role)? {
            return Ok(Some(ColorInput::Constant(color)));
        }
        self.texture_of(props, name, id, false)
            .map(|t| Some(t.map_or(ColorInput::Constant(Vec3::splat(MID_GREY)), ColorInput::Texture)))
    }

    /// The colour parameter of that name, or a constant.
    pub(super) fn color_or(
        &mut self,
        props: &Props<'t>,
        name: &str,
        role: Role,
        default: f32,
    ) -> Result<ColorInput, LoadError> {
        Ok(self.color_input(props, name, role)?.unwrap_or(ColorInput::Constant(Vec3::splat(default))))
    }

    /// The colour parameter of that name where no texture makes sense.
    pub(super) fn constant_color(
        &mut self,
        props: &Props<'t>,
        name: &str,
        role: Role,
        default: f32,
    ) -> Result<Vec3, LoadError> {
        match self.color_input(props, name, role)? {
            Some(ColorInput::Constant(color)) => Ok(color),
            Some(ColorInput::Texture(_)) => {
                let place = props.place_of(name);
                self.context.warn(&place, format!("\"{name}\" cannot be a texture here: {MID_GREY} is used"));
                Ok(Vec3::splat(MID_GREY))
            }
            None => Ok(Vec3::splat(default)),
        }
    }

    /// The number of that name, from a texture where it is one.
    pub(super) fn float_input(&mut self, props: &Props<'t>, name: &str) -> Result<Option<FloatInput>, LoadError> {
        let Some(id) = props.get(name) else { return Ok(None) };
        if let Some(color) = self.color_value(id, Role::Unbounded)? {
            // A constant number keeps all its bits; a colour counts by its luminance (Rec. 709).
            let grey = color.x == color.y && color.y == color.z;
            let luminance = 0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z;
            return Ok(Some(FloatInput::Constant(if grey { color.x } else { luminance })));
        }
        let texture = self.texture_of(props, name, id, false)?;
        Ok(Some(texture.map_or(FloatInput::Constant(MID_GREY), FloatInput::Texture)))
    }

    /// The number of that name, or a constant.
    pub(super) fn float_or(&mut self, props: &Props<'t>, name: &str, default: f32) -> Result<FloatInput, LoadError> {
        Ok(self.float_input(props, name)?.unwrap_or(FloatInput::Constant(default)))
    }

    /// The opacity of a mask: where it is a picture with holes of its own (an alpha channel below 1) and the file does
    /// not say which channel is meant, the holes are, as the exporters that write such files intend.
    pub(super) fn opacity(&mut self, props: &Props<'t>, given: FloatInput) -> FloatInput {
        let (FloatInput::Texture(id), Some(element)) = (given, props.get("opacity")) else { return given };
        let texture = &self.draft.textures[id.0 as usize];
        let TextureKind::Bitmap { bitmap, filter, wrap, alpha: false } = &texture.kind else { return given };
        let says_channel = self.props(element).is_ok_and(|p| p.has("channel"));
        if says_channel || !bitmap.has_holes() {
            return given;
        }
        if let Some(&texture) = self.opacities.get(&element) {
            return FloatInput::Texture(texture);
        }
        let kind = TextureKind::Bitmap { bitmap: bitmap.clone(), filter: *filter, wrap: *wrap, alpha: true };
        let texture = Texture { name: format!("{}-alpha", texture.name), kind, to_uv: texture.to_uv };
        let texture = self.draft.add_texture(texture);
        self.opacities.insert(element, texture);
        FloatInput::Texture(texture)
    }

    fn texture_of(
        &mut self,
        props: &Props<'t>,
        name: &str,
        id: NodeId,
        raw: bool,
    ) -> Result<Option<TextureId>, LoadError> {
        let tag = &self.tree.node(id).tag;
        if tag != "texture" {
            let message = format!("the parameter \"{name}\" is a <{tag}>, but has to be a colour or a texture");
            return Err(LoadError::invalid(props.place_of(name), message));
        }
        self.texture(id, raw)
    }

    /// The texture of the element `id`; none where it cannot be read, which was warned about. `raw`: read as linear
    /// data unless the file says otherwise.
    pub(super) fn texture(&mut self, id: NodeId, raw: bool) -> Result<Option<TextureId>, LoadError> {
        let raw = raw && self.raw_is_open(id, 0);
        match self.textures.get(&(id, raw)) {
            Some(State::Done(texture)) => return Ok(*texture),
            Some(State::Building) => return Err(self.circle(id)),
            None => {}
        }
        self.enter(id)?;
        self.textures.insert((id, raw), State::Building);
        let texture = self.build_texture(id, raw)?;
        let texture = texture.map(|t| self.draft.add_texture(t));
        self.textures.insert((id, raw), State::Done(texture));
        self.leave();
        Ok(texture)
    }

    /// Whether it is left open how the picture inside a texture is meant.
    fn raw_is_open(&self, id: NodeId, depth: u32) -> bool {
        let Ok(props) = self.props(id) else { return false };
        match props.kind() {
            "bitmap" => !props.has("raw") && !props.has("gamma"),
            "scale" if depth < 16 => props.objects("texture").iter().any(|t| self.raw_is_open(t.1, depth + 1)),
            _ => false,
        }
    }

    fn build_texture(&mut self, id: NodeId, raw: bool) -> Result<Option<Texture>, LoadError> {
        let props = self.props(id)?;
        let (kind, to_uv) = match props.kind() {
            "bitmap" => {
                let Some(kind) = self.bitmap_texture(&props, raw)? else {
                    props.ignore(&["to_uv", "uscale", "vscale", "uoffset", "voffset"]);
                    props.finish(self.context);
                    return Ok(None);
                };
                (kind, flip_v() * self.uv_transform(&props)? * flip_v())
            }
            "checkerboard" => {
                let a = self.color_or(&props, "color0", Role::Reflectance, 0.4)?;
                let b = self.color_or(&props, "color1", Role::Reflectance, 0.2)?;
                (TextureKind::Checkerboard { a, b }, self.uv_transform(&props)? * flip_v())
            }
            "scale" => {
                let factor = props.float("scale")?.unwrap_or(1.0);
                let nested = props.objects("texture");
                let input = match (nested.first(), props.has("value")) {
                    (Some(&(_, nested)), _) => {
                        let texture = self.texture(nested, raw)?;
                        texture.map_or(ColorInput::Constant(Vec3::splat(MID_GREY)), ColorInput::Texture)
                    }
                    (None, true) => self.color_or(&props, "value", Role::Unbounded, 1.0)?,
                    (None, false) => return Err(props.error("a scale texture needs a nested texture")),
                };
                (TextureKind::Scale { input, factor }, DAffine3::IDENTITY)
            }
            "vertexcolors" => (TextureKind::VertexColor, DAffine3::IDENTITY),
            "mesh_attribute" => {
                let attribute = props.string("name")?.unwrap_or("vertex_color");
                if attribute != "vertex_color" {
                    let message = format!("mesh attribute \"{attribute}\" is not read: vertex_color is used");
                    self.context.warn(&props.place(), message);
                }
                let scale = props.float("scale")?.unwrap_or(1.0);
                if scale == 1.0 {
                    (TextureKind::VertexColor, DAffine3::IDENTITY)
                } else {
                    let name = self.name(id, self.draft.textures.len());
                    let plain = Texture { name, kind: TextureKind::VertexColor, to_uv: Affine3A::IDENTITY };
                    let input = ColorInput::Texture(self.draft.add_texture(plain));
                    (TextureKind::Scale { input, factor: scale }, DAffine3::IDENTITY)
                }
            }
            other => {
                self.context.warn(&props.place(), names::refusal("texture", other));
                return Ok(None);
            }
        };
        props.finish(self.context);
        let to_uv = Affine3A::from_mat3_translation(
            Mat3::from_cols(
                to_uv.matrix3.x_axis.as_vec3(),
                to_uv.matrix3.y_axis.as_vec3(),
                to_uv.matrix3.z_axis.as_vec3(),
            ),
            to_uv.translation.as_vec3(),
        );
        Ok(Some(Texture { name: self.name(id, self.draft.textures.len()), kind, to_uv }))
    }

    /// The picture of a bitmap texture; none where it cannot be read, with a warning.
    fn bitmap_texture(&mut self, props: &Props<'t>, raw: bool) -> Result<Option<TextureKind>, LoadError> {
        // Storage, caching and anisotropy do not change what is seen.
        props.ignore(&["format", "accel", "cache", "max_anisotropy"]);
        let filter = match props.choice("filter_type")?.as_deref() {
            Some("nearest") => TextureFilter::Nearest,
            // The filters of Mitsuba 0.x blur far away what is bilinear near by.
            None | Some("bilinear" | "ewa" | "trilinear") => TextureFilter::Bilinear,
            Some(other) => return Err(props.error(format!("unknown filter_type \"{other}\": use nearest or bilinear"))),
        };
        let (u, v) = (props.choice("wrap_mode_u")?, props.choice("wrap_mode_v")?);
        let wrap = match props.choice("wrap_mode")?.or(u).or(v).as_deref() {
            None | Some("repeat") => WrapMode::Repeat,
            Some("mirror") => WrapMode::Mirror,
            Some("clamp") => WrapMode::Clamp,
            Some(other @ ("zero" | "one")) => {
                self.context.warn(&props.place(), format!("wrap_mode \"{other}\" is read as \"clamp\""));
                WrapMode::Clamp
            }
            Some(other) => {
                return Err(props.error(format!("unknown wrap_mode \"{other}\": use repeat, mirror or clamp")));
            }
        };
        let encoding = match (props.boolean("raw")?, props.float("gamma")?) {
            (Some(true), _) => BitmapEncoding::Raw,
            (Some(false), _) => BitmapEncoding::Auto,
            (None, Some(1.0)) => BitmapEncoding::Raw,
            (None, Some(gamma)) if gamma > 0.0 => BitmapEncoding::Srgb,
            (None, Some(_)) => BitmapEncoding::Auto,
            (None, None) => {
                if raw {
                    BitmapEncoding::Raw
                } else {
                    BitmapEncoding::Auto
                }
            }
        };
        let channel = props.choice("channel")?;
        let Some(bitmap) = self.bitmap(props, encoding)? else { return Ok(None) };
        let (bitmap, alpha) = match channel.as_deref() {
            Some("a") => (bitmap, true),
            Some("r" | "x") => (Arc::new(one_channel(&bitmap, 0)), false),
            Some("g" | "y") => (Arc::new(one_channel(&bitmap, 1)), false),
            Some("b" | "z") => (Arc::new(one_channel(&bitmap, 2)), false),
            None | Some("" | "all") => (bitmap, false),
            Some(other) => {
                self.context.warn(&props.place(), format!("unknown channel \"{other}\": all are used"));
                (bitmap, false)
            }
        };
        Ok(Some(TextureKind::Bitmap { bitmap, filter, wrap, alpha }))
    }

    /// The picture that the parameter `filename` names. A picture that cannot be read is a warning, one that may not
    /// be read an error.
    pub(super) fn bitmap(
        &mut self,
        props: &Props<'t>,
        encoding: BitmapEncoding,
    ) -> Result<Option<Arc<Bitmap>>, LoadError> {
        let Some(name) = props.string("filename")? else { return Err(props.error("this bitmap needs a \"filename\"")) };
        let place = props.place_of("filename");
        let found = self.context.resolve(&place, name, &self.tree.folders_for(props.id()));
        match found.and_then(|path| load_bitmap(&place, &path, encoding, self.context)) {
            Ok(bitmap) => Ok(Some(bitmap)),
            Err(error @ LoadError::Outside { .. }) => Err(error),
            Err(error) => {
                let text = error.to_string();
                let text = text.strip_prefix(&format!("{place}: ")).unwrap_or(&text);
                self.context.warn(&place, format!("{text}: mid-grey is used"));
                Ok(None)
            }
        }
    }

    /// The transform of texture coordinates, as Mitsuba has them (v down).
    fn uv_transform(&mut self, props: &Props<'t>) -> Result<DAffine3, LoadError> {
        let mut old = [0.0f64, 0.0, 1.0, 1.0];
        for (slot, name) in old.iter_mut().zip(["uoffset", "voffset", "uscale", "vscale"]) {
            if let Some(v) = props.float(name)? {
                *slot = f64::from(v);
            }
        }
        let mut map = match props.transform("to_uv", self.context)? {
            Some(t) => t.matrix,
            // Mitsuba 3 reads the numbers of older files as "offset, then scale".
            None => {
                DAffine3::from_scale(glam::DVec3::new(old[2], old[3], 1.0))
                    * DAffine3::from_translation(glam::DVec3::new(old[0], old[1], 0.0))
            }
        };
        // Only the plane counts.
        let m = &mut map.matrix3;
        (m.x_axis.z, m.y_axis.z, m.z_axis, map.translation.z) = (0.0, 0.0, glam::DVec3::Z, 0.0);
        Ok(map)
    }
}

/// (u, v) to (u, 1 - v): Mitsuba's v runs down the picture, the model's runs up.
pub fn flip_v() -> DAffine3 {
    DAffine3 { matrix3: glam::DMat3::from_diagonal(glam::DVec3::new(1.0, -1.0, 1.0)), translation: glam::DVec3::Y }
}

/// A grey picture of one channel of another.
fn one_channel(bitmap: &Bitmap, channel: usize) -> Bitmap {
    let pixels = match &bitmap.pixels {
        BitmapPixels::Rgba8 { data, srgb } => BitmapPixels::Rgba8 {
            data: data.iter().map(|p| [p[channel], p[channel], p[channel], 255]).collect(),
            srgb: *srgb,
        },
        BitmapPixels::RgbaF32(data) => {
            BitmapPixels::RgbaF32(data.iter().map(|p| [p[channel], p[channel], p[channel], 1.0]).collect())
        }
    };
    Bitmap { width: bitmap.width, height: bitmap.height, pixels }
}
