//! What a bounding volume answers.

use photinus_geometry::Ray;

/// A bounding volume in a tree.
pub(crate) trait Volume: Copy + Send + Sync + 'static {
    /// What is computed once for a ray.
    type Prepared: Copy;

    /// Prepares a ray; `None` where it can hit nothing.
    fn prepare(ray: &Ray) -> Option<Self::Prepared>;

    /// A parameter not above that of any hit inside, if there may be one from the ray's start to `end`.
    fn enter(&self, ray: &Self::Prepared, end: f32) -> Option<f32>;

    /// Half the surface area in square scene units: the chance to be hit, as the surface-area heuristic needs it.
    fn half_surface(&self) -> f64;
}

/// A point and how far around it, along each axis, the volume has to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PaddedPoint {
    /// The point.
    pub at: [f64; 3],
    /// Not negative.
    pub pad: f64,
}

/// A volume that can be fitted around points.
pub(crate) trait Fit: Volume {
    /// The volume around the hull of `points`, of which there is at least one.
    fn fit(points: &[PaddedPoint]) -> Self;
}
