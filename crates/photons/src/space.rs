//! Parts of space and sizes that several structures need.

use photinus_geometry::Aabb;

/// A box on both sides of a plane.
pub(crate) fn cut(bounds: Aabb, axis: usize, plane: f32) -> [Aabb; 2] {
    let [mut below, mut above] = [bounds; 2];
    (below.max[axis], above.min[axis]) = (plane, plane);
    [below, above]
}

/// A radius that holds some dozens of so many photons, if they lie on surfaces of a box of these bounds.
pub(crate) fn usual_radius(bounds: &Aabb, count: usize) -> f32 {
    let area = 2.0 * bounds.half_area();
    (area * 16.0 / count.max(1) as f32).sqrt().max(f32::MIN_POSITIVE)
}
