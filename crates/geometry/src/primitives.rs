//! What acceleration structures are built over: triangles and exact spheres, in world space.

use crate::Aabb;
use glam::Vec3;

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Middle, in scene units.
    pub center: Vec3,
    /// Radius, positive, in scene units.
    pub radius: f32,
}

/// Ids up to this many fit beside flags in a 32-bit word.
pub const MAX_PRIMITIVES: usize = (1 << 30) - 1;

/// Triangles and spheres under one numbering: triangle `i` is primitive `i`, sphere `j` is primitive
/// `triangle_count() + j`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Primitives {
    /// Vertex positions, shared by the triangles that index them.
    pub positions: Vec<Vec3>,
    /// Vertex indices of each triangle, in range of `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// Spheres.
    pub spheres: Vec<Sphere>,
}

impl Primitives {
    /// How many triangles.
    #[inline]
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// How many primitives of both kinds.
    #[inline]
    pub fn len(&self) -> usize {
        self.triangles.len() + self.spheres.len()
    }

    /// Whether there is nothing to hit.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Vertices of triangle `i`.
    #[inline]
    pub fn triangle(&self, i: usize) -> [Vec3; 3] {
        self.triangles[i].map(|v| self.positions[v as usize])
    }

    /// Bounds of primitive `id` of either kind.
    pub fn bounds_of(&self, id: usize) -> Aabb {
        match id.checked_sub(self.triangles.len()) {
            None => Aabb::around(self.triangle(id)),
            Some(j) => {
                let s = self.spheres[j];
                Aabb { min: s.center - Vec3::splat(s.radius), max: s.center + Vec3::splat(s.radius) }
            }
        }
    }

    /// Bounds of everything; empty where there is nothing.
    pub fn bounds(&self) -> Aabb {
        (0..self.len()).fold(Aabb::EMPTY, |b, i| b.union(self.bounds_of(i)))
    }
}
