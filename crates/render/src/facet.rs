//! What a hit of a triangle reads, side by side: hits come in no order, and every array of vertices would cost a miss.

use crate::SurfacePoint;
use crate::bsdf::Reads;
use photinus_geometry::{Frame, Vec2, Vec3};

/// A point on a triangle is off its plane by at most a few units in the last place of its largest coordinates (Ray
/// Tracing Gems, chapter 6), and so is the test of a ray that starts there: 2^-20 is sixteen such units.
pub(crate) const OFFSET: f32 = 1.0 / 1_048_576.0;
/// Keeps the offset above zero at the origin.
pub(crate) const TINY: f32 = 1e-20;

/// How far off a triangle with this corner and these edges rays must start.
pub(crate) fn offset_on(corner: Vec3, edges: [Vec3; 2]) -> f32 {
    OFFSET * (corner.abs() + edges[0].abs() + edges[1].abs()).max_element() + TINY
}

/// A triangle: two lines of the cache. Where it has no normals and nothing reads its coordinates, the first is enough.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(128))]
pub(crate) struct Facet {
    /// First vertex, and the edges from it to the second and the third.
    corner: Vec3,
    edges: [Vec3; 2],
    /// Unit normal by the order of the vertices; z where the triangle has no area.
    face: Vec3,
    /// How far off it rays must start.
    offset: f32,
    /// Index of its shape.
    pub shape: u32,
    /// Whether the vertices have texture coordinates.
    is_mapped: bool,
    /// Normals of the vertices.
    normals: [Vec3; 3],
    /// Texture coordinates of the vertices; barycentrics where they have none.
    uvs: [Vec2; 3],
    /// Side of the square in texture coordinates that a unit square of the triangle is there, the inverse of
    /// [`uv_scale`](crate::footprint::uv_scale).
    uv_per_length: f32,
    /// Whether the vertices have normals: here, so that both lines are asked for by what is read first.
    pub is_smooth: bool,
}

impl Facet {
    /// The triangle of a shape with these corners and what they have.
    pub fn new(shape: u32, [a, b, c]: [Vec3; 3], normals: Option<[Vec3; 3]>, uvs: Option<[Vec2; 3]>) -> Self {
        let edges = [b - a, c - a];
        let cross = edges[0].cross(edges[1]);
        let (is_smooth, is_mapped) = (normals.is_some(), uvs.is_some());
        let uvs = uvs.unwrap_or([Vec2::ZERO, Vec2::X, Vec2::Y]);
        Self {
            corner: a,
            edges,
            face: cross.try_normalize().unwrap_or(Vec3::Z),
            offset: offset_on(a, edges),
            shape,
            is_smooth,
            is_mapped,
            normals: normals.unwrap_or([Vec3::ZERO; 3]),
            uvs,
            uv_per_length: uv_per_length(uvs, cross.length()),
        }
    }

    /// The face normal at barycentrics (alpha, beta), towards the outside: that of [`Self::surface`], for less.
    pub fn outward_normal(&self, alpha: f32, beta: f32) -> Vec3 {
        self.outward(if self.is_smooth { mixed(self.normals, alpha, beta) } else { self.face })
    }

    /// The face normal on the side of `normal`: vertex normals say which side is out; windings in real files often do
    /// not.
    #[inline]
    fn outward(&self, normal: Vec3) -> Vec3 {
        if self.face.dot(normal) < 0.0 { -self.face } else { self.face }
    }

    /// Which side of the face, by the order of its vertices, is outside all over it: 1, -1, or none where its vertex
    /// normals do not agree.
    pub fn outer_side(&self) -> Option<f32> {
        if !self.is_smooth {
            return Some(1.0);
        }
        let face = self.edges[0].cross(self.edges[1]);
        let along = self.normals.map(|n| face.dot(n));
        match [along.iter().all(|&x| x > 0.0), along.iter().all(|&x| x < 0.0)] {
            [true, _] => Some(1.0),
            [_, true] => Some(-1.0),
            _ => None,
        }
    }

    /// The surface of primitive `prim`, which it is, at barycentrics (alpha, beta), with what `reads` says; `is_smooth` is
    /// its own, `width` the width of the pixel's cone there, 0 where unknown.
    #[inline]
    pub fn surface(
        &self,
        is_smooth: bool,
        prim: u32,
        [alpha, beta]: [f32; 2],
        reads: Reads,
        width: f32,
    ) -> SurfacePoint {
        let normal =
            if is_smooth { mixed(self.normals, alpha, beta).try_normalize().unwrap_or(self.face) } else { self.face };
        let mut point = SurfacePoint {
            position: self.corner + self.edges[0] * alpha + self.edges[1] * beta,
            geometric_normal: self.outward(normal),
            normal,
            uv: Vec2::ZERO,
            dp_du: Vec3::ZERO,
            dp_dv: Vec3::ZERO,
            color: Vec3::ONE,
            uv_footprint: 0.0,
            offset: self.offset,
            shape: self.shape,
            prim,
        };
        if reads != Reads::NONE {
            let [a, b, c] = self.uvs;
            point.uv = a * (1.0 - alpha - beta) + b * alpha + c * beta;
            if width > 0.0 {
                point.uv_footprint = width * self.uv_per_length;
            }
            if reads.tangents || !self.is_mapped {
                (point.dp_du, point.dp_dv) = self.tangents(point.geometric_normal);
            }
        }
        point
    }

    /// Change of position with u and v; any tangents where the texture coordinates span no area.
    fn tangents(&self, outward: Vec3) -> (Vec3, Vec3) {
        let [e1, e2] = self.edges;
        if !self.is_mapped {
            return (e1, e2);
        }
        let (d1, d2) = (self.uvs[1] - self.uvs[0], self.uvs[2] - self.uvs[0]);
        let determinant = d1.x * d2.y - d1.y * d2.x;
        if determinant == 0.0 || !determinant.is_finite() {
            let frame = Frame::from_normal(outward);
            return (frame.s, frame.t);
        }
        let inv = 1.0 / determinant;
        ((e1 * d2.y - e2 * d1.y) * inv, (e2 * d1.x - e1 * d2.x) * inv)
    }
}

/// What vertices have, at barycentrics (alpha, beta).
#[inline]
pub(crate) fn mixed([a, b, c]: [Vec3; 3], alpha: f32, beta: f32) -> Vec3 {
    a * (1.0 - alpha - beta) + b * alpha + c * beta
}

/// See [`Facet::uv_per_length`]; `area` is the triangle's, twice.
fn uv_per_length([a, b, c]: [Vec2; 3], area: f32) -> f32 {
    let uv_area = (b - a).perp_dot(c - a).abs();
    if uv_area == 0.0 || !uv_area.is_finite() {
        return 1.0;
    }
    let ratio = (uv_area / area).sqrt();
    if ratio.is_finite() { ratio } else { 0.0 }
}

const _: () = assert!(size_of::<Facet>() == 128);
