//! The inclusion test: which photons a query finds, and what each adds to its sums. Every member and every vector
//! kernel repeats these operations in this order.

use crate::kernel::PreparedKernel;
use crate::octahedral::decode_scaled;
use crate::photon::{LOW_MASK, NORMAL_MAX, is_searchable, low_limit, normal_code};
use crate::{GatherQuery, Kernel};
use photinus_geometry::Vec3;

/// Squared radius of a search; negative, so that nothing is found, where the question makes no sense.
#[inline]
pub(crate) fn radius_sq(position: Vec3, radius: f32) -> f32 {
    if radius >= 0.0 && is_searchable(position) { radius * radius } else { -1.0 }
}

/// Squared distance.
#[inline]
pub(crate) fn distance_sq(photon: Vec3, position: Vec3) -> f32 {
    let d = photon - position;
    (d.x * d.x + d.y * d.y) + d.z * d.z
}

/// A query with what does not depend on the photon computed once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PreparedQuery {
    pub(crate) position: Vec3,
    pub(crate) r2: f32,
    pub(crate) normal: Vec3,
    /// The largest low byte of a surface word found: see [`low_limit`].
    pub(crate) low_limit: u32,
    pub(crate) kernel: PreparedKernel,
}

impl PreparedQuery {
    #[inline]
    pub(crate) fn new(query: &GatherQuery, kernel: Kernel) -> Self {
        Self {
            position: query.position,
            r2: radius_sq(query.position, query.radius),
            normal: query.normal,
            low_limit: low_limit(query.max_depth),
            kernel: PreparedKernel::new(kernel, query.radius),
        }
    }

    /// Whether a photon with this surface word passes the tests of normal and depth.
    #[inline]
    pub(crate) fn accepts(&self, surface: u32) -> bool {
        self.is_shallow(surface) && self.normal_within_60(surface)
    }

    /// Whether a photon with this surface word passes the test of depth.
    #[inline]
    pub(crate) fn is_shallow(&self, surface: u32) -> bool {
        surface & LOW_MASK <= self.low_limit
    }

    /// cos 60 = 1/2: with v the stored normal of any length, v . n >= |v| / 2, squared to save the root.
    #[inline]
    pub(crate) fn normal_within_60(&self, surface: u32) -> bool {
        let v = decode_scaled(normal_code(surface), NORMAL_MAX);
        let dot = (v.x * self.normal.x + v.y * self.normal.y) + v.z * self.normal.z;
        let length_sq = (v.x * v.x + v.y * v.y) + v.z * v.z;
        dot > 0.0 && dot * dot >= 0.25 * length_sq
    }
}
