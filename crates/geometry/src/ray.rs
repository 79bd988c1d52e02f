//! Rays and what they hit.

use glam::Vec3;

/// A half-line, cut to an interval of its parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Start, in scene units.
    pub origin: Vec3,
    /// Smallest accepted parameter.
    pub t_min: f32,
    /// Direction; need not be of unit length (the parameter counts in its length).
    pub dir: Vec3,
    /// Largest accepted parameter; infinite for none.
    pub t_max: f32,
}

impl Ray {
    /// The ray from `origin` along `dir` over all parameters from zero.
    #[inline]
    pub fn new(origin: Vec3, dir: Vec3) -> Self {
        Self { origin, t_min: 0.0, dir, t_max: f32::INFINITY }
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.dir * t
    }
}

/// The nearest intersection of a ray.
///
/// `alpha` and `beta` are barycentrics: the point is `A + alpha (B - A) + beta (C - A)`, the field's (u, v). On a
/// sphere both are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Hit {
    /// Ray parameter; infinite where nothing was hit.
    pub t: f32,
    /// Weight of the second vertex.
    pub alpha: f32,
    /// Weight of the third vertex.
    pub beta: f32,
    /// Primitive id: triangles first, then spheres; [`NO_HIT`] where nothing was hit.
    pub prim: u32,
}

/// The primitive id of a miss.
pub const NO_HIT: u32 = u32::MAX;

impl Hit {
    /// Nothing was hit.
    pub const MISS: Self = Self { t: f32::INFINITY, alpha: 0.0, beta: 0.0, prim: NO_HIT };

    /// Whether something was hit.
    #[inline]
    pub fn is_hit(&self) -> bool {
        self.prim != NO_HIT
    }

    /// Whether this hit replaces `other`: nearer, or as near with a lower id, so that the winner does not depend on
    /// the order of tests.
    #[inline]
    pub fn beats(&self, other: &Self) -> bool {
        self.t < other.t || (self.t == other.t && self.prim < other.prim)
    }
}

impl Default for Hit {
    fn default() -> Self {
        Self::MISS
    }
}
