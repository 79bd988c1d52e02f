//! Affine transforms undone in doubles, and boxes carried along by them.

use crate::bounds::SLAB_SLACK;
use crate::hierarchy::clip::Cell;
use glam::Affine3A;
use photinus_geometry::{Aabb, Ray, Vec3};

/// The largest product of the norms of a matrix and its inverse that counts as one: beyond it a ray in the prototype's
/// coordinates would have lost most of a float's digits.
const MAX_CONDITION: f64 = 1e6;

/// From the scene's coordinates to a prototype's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inverse {
    /// Rows of the matrix.
    rows: [[f64; 3]; 3],
    /// What the matrix is applied to is taken from here.
    origin: [f64; 3],
}

/// Rows of a transform's matrix.
fn rows(transform: &Affine3A) -> [[f64; 3]; 3] {
    let m = transform.matrix3;
    let columns = [m.x_axis, m.y_axis, m.z_axis].map(|c| c.to_array().map(f64::from));
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}

/// The largest sum of magnitudes in a row.
fn norm(rows: &[[f64; 3]; 3]) -> f64 {
    rows.iter().map(|r| r[0].abs() + r[1].abs() + r[2].abs()).fold(0.0, f64::max)
}

impl Inverse {
    /// The inverse of a transform; `None` where there is none, nearly none, or where it is not finite.
    pub fn of(transform: &Affine3A) -> Option<Self> {
        let m = rows(transform);
        let origin = transform.translation.to_array().map(f64::from);
        // Cofactors, by the cyclic rule that carries their signs.
        let cofactor = |i: usize, j: usize| {
            let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            m[a][c] * m[b][d] - m[a][d] * m[b][c]
        };
        let determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
        let rows: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant));
        let finite = rows.iter().flatten().chain(&origin).all(|x| x.is_finite());
        // Written so that what is not a number is refused.
        (finite && norm(&m) * norm(&rows) <= MAX_CONDITION).then_some(Self { rows, origin })
    }

    fn apply(&self, v: [f64; 3]) -> Vec3 {
        Vec3::from(self.rows.map(|r| (r[0] * v[0] + r[1] * v[1] + r[2] * v[2]) as f32))
    }

    /// The ray in the prototype's coordinates, its parameter kept.
    pub fn ray(&self, ray: &Ray) -> Ray {
        let from_origin = std::array::from_fn(|k| f64::from(ray.origin[k]) - self.origin[k]);
        Ray { origin: self.apply(from_origin), dir: self.apply(ray.dir.to_array().map(f64::from)), ..*ray }
    }
}

/// Bounds of a transformed box, padded by what a ray loses on its way into the box's coordinates: 64 roundings of the
/// size and 4 of the place. Empty where the box is.
pub(crate) fn world_bounds(local: &Aabb, transform: &Affine3A) -> Aabb {
    if local.is_empty() {
        return Aabb::EMPTY;
    }
    let (rows, origin) = (rows(transform), transform.translation.to_array().map(f64::from));
    let (low, high) = (local.min.to_array().map(f64::from), local.max.to_array().map(f64::from));
    let mut cell = Cell { low: origin, high: origin };
    for k in 0..3 {
        for j in 0..3 {
            let (a, b) = (rows[k][j] * low[j], rows[k][j] * high[j]);
            cell.low[k] += a.min(b);
            cell.high[k] += a.max(b);
        }
    }
    let slack = f64::from(SLAB_SLACK);
    let size: f64 = (0..3).map(|k| cell.high[k] - cell.low[k]).sum();
    for k in 0..3 {
        let pad = 4.0 * slack * size + 0.25 * slack * cell.low[k].abs().max(cell.high[k].abs());
        cell.low[k] -= pad;
        cell.high[k] += pad;
    }
    cell.outward()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    #[test]
    fn inverses_undo_transforms() {
        let transform = Affine3A::from_scale_rotation_translation(
            Vec3::new(2.0, -0.5, 3.0),
            Quat::from_xyzw(0.1, 0.7, -0.2, 0.6).normalize(),
            Vec3::new(4.0, 5.0, -6.0),
        );
        let inverse = Inverse::of(&transform).unwrap();
        let p = Vec3::new(0.3, -0.8, 0.9);
        let ray = Ray::new(transform.transform_point3(p), transform.transform_vector3(Vec3::Y));
        let local = inverse.ray(&ray);
        assert!((local.origin - p).length() < 1e-6 && (local.dir - Vec3::Y).length() < 1e-6, "{local:?}");
        let identity = Inverse::of(&Affine3A::IDENTITY).unwrap();
        assert_eq!(identity.ray(&ray), ray);
    }

    #[test]
    fn what_cannot_be_undone_is_refused() {
        for matrix in [
            Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0)),
            Affine3A::from_scale(Vec3::new(1.0, 1e-8, 1.0)),
            Affine3A::from_scale(Vec3::NAN),
            Affine3A::from_translation(Vec3::INFINITY),
        ] {
            assert_eq!(Inverse::of(&matrix), None, "{matrix:?}");
        }
        // Small as a whole is not flat.
        assert!(Inverse::of(&Affine3A::from_scale(Vec3::splat(1e-12))).is_some());
    }

    #[test]
    fn bounds_hold_every_transformed_corner() {
        let local = Aabb { min: Vec3::new(-1.0, 2.0, 0.0), max: Vec3::new(1.0, 3.0, 0.0) };
        let transform = Affine3A::from_scale_rotation_translation(
            Vec3::new(1.0, 2.0, 3.0),
            Quat::from_xyzw(0.3, 0.1, 0.5, 0.8).normalize(),
            Vec3::splat(100.0),
        );
        let world = world_bounds(&local, &transform);
        let corners = (0..8).map(|i| {
            let pick = |k: usize| if i >> k & 1 == 0 { local.min[k] } else { local.max[k] };
            transform.transform_point3(Vec3::new(pick(0), pick(1), pick(2)))
        });
        let tight = Aabb::around(corners);
        assert!(world.contains(tight.min) && world.contains(tight.max));
        assert!((world.size() - tight.size()).max_element() < 1e-2);
        assert!(world_bounds(&Aabb::EMPTY, &transform).is_empty());
    }
}
