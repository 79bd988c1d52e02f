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
    /// Largest stretch of that map.
    stretch: f32,
    /// What the map does to the footprint: the root of its change of area, as for the surface's own coordinates.
    scale: f32,
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
        let mut seen: Vec<(Arc<Bitmap>, bool)> = Vec::new();
        for texture in textures {
            let kind = match &texture.kind {
                TextureKind::Bitmap { bitmap, filter, wrap, alpha } => {
                    let filtered = *filter != TextureFilter::Nearest;
                    let same =
                        |(other, pyramid): &(Arc<Bitmap>, bool)| Arc::ptr_eq(other, bitmap) && *pyramid == filtered;
                    let map = seen.iter().position(same).unwrap_or_else(|| {
                        seen.push((Arc::clone(bitmap), filtered));
                        let make = if filtered { MipMap::new } else { MipMap::without_pyramid };
                        result.maps.push(make(bitmap));
                        seen.len() - 1
                    });
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
            let scale = (to_uv[0].x * to_uv[1].y - to_uv[0].y * to_uv[1].x).abs().sqrt();
            result.textures.push(Prepared { kind, to_uv, stretch, scale, step: 0.0 });
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
        let footprint = at.footprint * texture.scale;
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

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Affine3A;
    use photinus_scene::BitmapPixels;

    fn texture(kind: TextureKind, to_uv: Affine3A) -> Texture {
        Texture { name: "test".into(), kind, to_uv }
    }

    fn at(u: f32, v: f32) -> TextureLookup {
        TextureLookup { uv: Vec2::new(u, v), footprint: 0.0, vertex_color: Vec3::new(0.1, 0.2, 0.3) }
    }

    fn bitmap(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [f32; 4]) -> Arc<Bitmap> {
        let data = (0..width * height).map(|i| pixel(i % width, i / width)).collect();
        Arc::new(Bitmap { width, height, pixels: BitmapPixels::RgbaF32(data) })
    }

    fn picture(bitmap: &Arc<Bitmap>, filter: TextureFilter, alpha: bool) -> TextureKind {
        TextureKind::Bitmap { bitmap: Arc::clone(bitmap), filter, wrap: WrapMode::Repeat, alpha }
    }

    #[test]
    fn kinds_scale_nest_and_transform() {
        let dots = bitmap(2, 1, |x, _| [x as f32, 0.5, 0.25, 0.75]);
        let twice = Affine3A::from_scale(Vec3::new(2.0, 1.0, 1.0));
        let shifted = Affine3A::from_translation(Vec3::new(0.5, 0.0, 0.0));
        let textures = Textures::new(&[
            texture(picture(&dots, TextureFilter::Nearest, false), Affine3A::IDENTITY),
            texture(picture(&dots, TextureFilter::Nearest, true), Affine3A::IDENTITY),
            texture(TextureKind::Scale { input: ColorInput::Texture(TextureId(0)), factor: 4.0 }, Affine3A::IDENTITY),
            texture(TextureKind::VertexColor, Affine3A::IDENTITY),
            texture(
                TextureKind::Checkerboard { a: ColorInput::Texture(TextureId(3)), b: ColorInput::Constant(Vec3::ONE) },
                twice,
            ),
            texture(picture(&dots, TextureFilter::Nearest, false), shifted),
        ]);
        let color = |id, u, v| textures.color(ColorInput::Texture(TextureId(id)), &at(u, v));
        assert_eq!(color(0, 0.75, 0.5), Vec3::new(1.0, 0.5, 0.25));
        assert_eq!(color(1, 0.75, 0.5), Vec3::splat(0.75));
        assert_eq!(color(2, 0.75, 0.5), Vec3::new(4.0, 2.0, 1.0));
        assert_eq!(color(3, 0.1, 0.1), Vec3::new(0.1, 0.2, 0.3));
        assert_eq!(color(4, 0.2, 0.1), Vec3::new(0.1, 0.2, 0.3), "u = 0.2 is 0.4 on the board");
        assert_eq!(color(4, 0.3, 0.1), Vec3::ONE);
        assert_eq!(color(5, 0.25, 0.5).x, 1.0, "shifted by half the picture");
        assert_eq!(color(77, 0.0, 0.0), GREY);
        assert_eq!(textures.float(FloatInput::Texture(TextureId(1)), &at(0.1, 0.1)), 0.75);
        assert_eq!(textures.float(FloatInput::Constant(0.3), &at(0.1, 0.1)), 0.3);
        assert_eq!(textures.maps.len(), 1, "one picture, prepared once");
    }

    /// The footprint is stretched with the coordinates: a picture repeated 8 times reaches its mean 8 times sooner.
    #[test]
    fn footprints_follow_the_transform() {
        let stripes = bitmap(16, 16, |x, _| [f32::from(x % 2 == 0), 0.0, 0.0, 1.0]);
        let repeated = Affine3A::from_scale(Vec3::splat(8.0));
        let textures = Textures::new(&[
            texture(picture(&stripes, TextureFilter::Bilinear, false), Affine3A::IDENTITY),
            texture(picture(&stripes, TextureFilter::Bilinear, false), repeated),
        ]);
        let red = |id, footprint| {
            let lookup = TextureLookup { footprint, ..at(0.5 / 16.0 / if id == 1 { 8.0 } else { 1.0 }, 0.5) };
            textures.color(ColorInput::Texture(TextureId(id)), &lookup).x
        };
        assert_eq!(red(0, 0.0), 1.0);
        assert!((red(0, 2.0 / 16.0) - 0.5).abs() < 1e-5);
        assert!((red(1, 2.0 / 16.0 / 8.0) - 0.5).abs() < 1e-5);
        assert_eq!(red(1, 0.5 / 16.0 / 8.0), 1.0);
    }

    /// A plank's picture of 64 x 4 pixels, repeated 16 times across: every pixel of it is square on the surface.
    #[test]
    fn footprints_keep_their_area_in_stretched_pictures() {
        let dots = bitmap(64, 4, |x, y| [f32::from((x + y) % 2 == 0), 0.0, 0.0, 1.0]);
        let to_uv = Affine3A::from_scale(Vec3::new(1.0, 16.0, 1.0));
        let textures = Textures::new(&[texture(picture(&dots, TextureFilter::Bilinear, false), to_uv)]);
        let red = |footprint| {
            let lookup = TextureLookup { footprint, ..at(0.5 / 64.0, 0.5 / 64.0) };
            textures.color(ColorInput::Texture(TextureId(0)), &lookup).x
        };
        let sharp = red(0.0);
        assert_eq!(red(1.0 / 64.0), sharp, "one pixel wide");
        assert!((red(2.0 / 64.0) - 0.5).abs() < 1e-5, "two pixels wide");
    }

    #[test]
    fn gradients_are_slopes() {
        let ramp = bitmap(32, 32, |x, y| {
            let height = 3.0 * (x as f32 + 0.5) / 32.0 + 0.5 * (y as f32 + 0.5) / 32.0;
            [height, height, height, 1.0]
        });
        let textures = Textures::new(&[texture(picture(&ramp, TextureFilter::Bilinear, false), Affine3A::IDENTITY)]);
        let gradient = textures.gradient(TextureId(0), &at(0.4, 0.6));
        // Rows are counted downwards, v upwards.
        assert!((gradient - Vec2::new(3.0, -0.5)).length() < 1e-2, "{gradient}");
        assert_eq!(textures.gradient(TextureId(9), &at(0.0, 0.0)), Vec2::ZERO);
    }
}
