//! A point on a surface, with all that shading needs.

use crate::texture::TextureLookup;
use photinus_geometry::{Vec2, Vec3};

/// A point on a surface. What the materials and lights that are on it do not read (see
/// [`Reads`](crate::bsdf::Reads)) is not filled in: 0, and white.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Where, in world space.
    pub position: Vec3,
    /// Unit face normal on the side that the shape's normals point to.
    pub geometric_normal: Vec3,
    /// Unit shading normal, on the same side as the face normal.
    pub normal: Vec3,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Change of position with u and v, not normalised, in scene units; for bump maps and brushed
    /// metal.
    pub dp_du: Vec3,
    /// See `dp_du`.
    pub dp_dv: Vec3,
    /// Vertex colour, linear RGB; white where the mesh has none.
    pub color: Vec3,
    /// Width of the pixel's footprint in texture coordinates; 0: unknown, no filtering beyond bilinear.
    pub uv_footprint: f32,
    /// How far off the surface a ray must start so that rounding cannot make it hit the surface again, scene units.
    pub offset: f32,
    /// Index of the shape.
    pub shape: u32,
    /// Primitive id.
    pub prim: u32,
}

impl SurfacePoint {
    /// Where a ray along `dir` starts: off the surface, on the side that `dir` points to.
    #[inline]
    pub fn ray_origin(&self, dir: Vec3) -> Vec3 {
        let step = self.geometric_normal * self.offset;
        self.position + if self.geometric_normal.dot(dir) >= 0.0 { step } else { -step }
    }

    /// Where textures are read for this point.
    #[inline]
    pub fn lookup(&self) -> TextureLookup {
        TextureLookup { uv: self.uv, footprint: self.uv_footprint, vertex_color: self.color }
    }
}
