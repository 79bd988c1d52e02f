//! All textures of a scene, prepared for look-ups.

use super::bitmap::MipMap;
use super::checkerboard::checkerboard_share;
use super::luminance;
use photinus_geometry::{Vec2, Vec3};
use photinus_scene::{Bitmap, ColorInput, FloatInput, Texture, TextureFilter, TextureId, TextureKind, WrapMode};
use std::sync::Arc;

/// Textures nested deeper than this read as mid-grey: a file may nest without end.
const MAX_DEPTH: u32 = 8;

/// What a missing or endlessly nested texture shows.
const GREY: Vec3 = Vec3::splat(0.5);

/// Where a texture is read.
#[derive(Clone, Copy, Debug)]
pub struct TextureLookup {
    /// Texture coordinates.
    pub uv: Vec2,
    /// Width of the pixel's footprint in texture coordinates; 0: unknown, no filtering beyond bilinear.
    pub footprint: f32,
    /// Vertex colour, linear RGB; white where the mesh has none.
    pub vertex_color: Vec3,
}

#[derive(Clone, Debug)]
enum Kind {
    Bitmap { map: u32, filter: TextureFilter, wrap: WrapMode, alpha: bool },
    Checkerboard { a: ColorInput, b: ColorInput },
    Scale { input: ColorInput, factor: f32 },
    VertexColor,
}

#[derive(Clone, Debug)]
struct Prepared {
    kind: Kind,
    /// Rows of the affine map from the surface's coordinates to the texture's: (a, b, offset) for u and for v.
    to_uv: [Vec3; 2],
    /// Largest stretch of that map, which scales the footprint.
    stretch: f32,
    /// Length in the surface's coordinates over which differences are taken: half a pixel of the finest picture.
    step: f32,
}

/// All textures of a scene.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    textures: Vec<Prepared>,
    maps: Vec<MipMap>,
}

impl Textures {
    /// Builds pyramids; a picture shared by several textures is prepared once.
    pub fn new(textures: &[Texture]) -> Self {
        let mut result = Self::default();
        let mut seen: Vec<Arc<Bitmap>> = Vec::new();
        for texture in textures {
            let kind = match &texture.kind {
                TextureKind::Bitmap { bitmap, filter, wrap, alpha } => {
                    let map = match seen.iter().position(|other| Arc::ptr_eq(other, bitmap)) {
                        Some(i) => i,
                        None => {
                            seen.push(Arc::clone(bitmap));
                            result.maps.push(MipMap::new(bitmap));
                            seen.len() - 1
                        }
                    };
                    Kind::Bitmap { map: map as u32, filter: *filter, wrap: *wrap, alpha: *alpha }
                }
                TextureKind::Checkerboard { a, b } => Kind::Checkerboard { a: *a, b: *b },
                TextureKind::Scale { input, factor } => Kind::Scale { input: *input, factor: *factor },
                TextureKind::VertexColor => Kind::VertexColor,
            };
            let (m, offset) = (texture.to_uv.matrix3, texture.to_uv.translation);
            let to_uv = [Vec3::new(m.x_axis.x, m.y_axis.x, offset.x), Vec3::new(m.x_axis.y, m.y_axis.y, offset.y)];
            let column = |x: f32, y: f32| (x * x + y * y).sqrt();
            let stretch = column(to_uv[0].x, to_uv[1].x).max(column(to_uv[0].y, to_uv[1].y));
            result.textures.push(Prepared { kind, to_uv, stretch, step: 0.0 });
        }
        for i in 0..result.textures.len() {
            result.textures[i].step = result.finest_step(TextureId(i as u32), 0);
        }
        result
    }

    /// Bytes of the pyramids beyond the scene's own pictures.
    pub fn bytes(&self) -> usize {
        self.maps.iter().map(MipMap::bytes).sum::<usize>() + self.textures.len() * size_of::<Prepared>()
    }

    /// The colour of an input; textures are linear RGB.
    pub fn color(&self, input: ColorInput, at: &TextureLookup) -> Vec3 {
        self.color_at_depth(input, at, 0)
    }

    /// The number of an input: a texture's luminance, or its alpha where it reads alpha.
    pub fn float(&self, input: FloatInput, at: &TextureLookup) -> f32 {
        match input {
            FloatInput::Constant(x) => x,
            FloatInput::Texture(id) => luminance(self.texture(id, at, 0)),
        }
    }

    /// Change of a texture's luminance with u and v of the surface, by central differences over a pixel of the picture
    /// or over the footprint, whichever is wider.
    pub fn gradient(&self, id: TextureId, at: &TextureLookup) -> Vec2 {
        let Some(texture) = self.textures.get(id.0 as usize) else { return Vec2::ZERO };
        let half = texture.step.max(0.5 * at.footprint);
        let value = |offset: Vec2| luminance(self.texture(id, &TextureLookup { uv: at.uv + offset, ..*at }, 0));
        let slope = |d: Vec2| (value(d) - value(-d)) / (2.0 * half);
        let gradient = Vec2::new(slope(Vec2::new(half, 0.0)), slope(Vec2::new(0.0, half)));
        if gradient.is_finite() { gradient } else { Vec2::ZERO }
    }

    fn color_at_depth(&self, input: ColorInput, at: &TextureLookup, depth: u32) -> Vec3 {
        match input {
            ColorInput::Constant(c) => c,
            ColorInput::Texture(id) => self.texture(id, at, depth),
        }
    }

    fn texture(&self, id: TextureId, at: &TextureLookup, depth: u32) -> Vec3 {
        let Some(texture) = self.textures.get(id.0 as usize).filter(|_| depth < MAX_DEPTH) else { return GREY };
        let p = Vec3::new(at.uv.x, at.uv.y, 1.0);
        let uv = Vec2::new(texture.to_uv[0].dot(p), texture.to_uv[1].dot(p));
        let footprint = at.footprint * texture.stretch;
        match texture.kind {
            Kind::Bitmap { map, filter, wrap, alpha } => {
                let c = self.maps[map as usize].lookup(uv, footprint, filter, wrap);
                if alpha { Vec3::splat(c.w) } else { c.truncate() }
            }
            Kind::Checkerboard { a, b } => {
                let share = checkerboard_share(uv, footprint);
                let mut color = Vec3::ZERO;
                if share > 0.0 {
                    color += self.color_at_depth(a, at, depth + 1) * share;
                }
                if share < 1.0 {
                    color += self.color_at_depth(b, at, depth + 1) * (1.0 - share);
                }
                color
            }
            Kind::Scale { input, factor } => self.color_at_depth(input, at, depth + 1) * factor,
            Kind::VertexColor => at.vertex_color,
        }
    }

    fn finest_step(&self, id: TextureId, depth: u32) -> f32 {
        /// A thousandth of the texture: fine enough for a checkerboard's edges.
        const COARSEST: f32 = 5e-4;
        let Some(texture) = self.textures.get(id.0 as usize).filter(|_| depth < MAX_DEPTH) else { return COARSEST };
        let nested = |input: ColorInput| match input {
            ColorInput::Constant(_) => COARSEST,
            ColorInput::Texture(id) => self.finest_step(id, depth + 1),
        };
        let step = match texture.kind {
            Kind::Bitmap { map, .. } => {
                let [w, h] = self.maps[map as usize].size();
                0.5 / w.max(h) as f32 / texture.stretch
            }
            Kind::Checkerboard { a, b } => nested(a).min(nested(b)).min(COARSEST / texture.stretch),
            Kind::Scale { input, .. } => nested(input),
            Kind::VertexColor => COARSEST,
        };
        if step.is_finite() && step > 1e-7 { step } else { COARSEST }
    }
}
