//! What lies of a triangle within a cell: convex polygons, cut in doubles, with the margin that a hit may be off by.
//!
//! A ray hits a triangle at a point that is within the padding of [`crate::bounds`] of it (and within a part of the
//! ray's length, which the walks allow for). A primitive belongs to a cell if any point of it does, give or take that
//! padding: planes are therefore moved outward by it before they cut.

use crate::bounds::pad;
use arrayvec::ArrayVec;
use photinus_geometry::{Aabb, Primitives};

/// Corners of a polygon at most; one that would have more stays whole.
const MAX_CORNERS: usize = 16;

/// A point.
pub(crate) type Point = [f64; 3];

/// A convex polygon; empty where it has no corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Polygon {
    corners: ArrayVec<Point, MAX_CORNERS>,
}

impl Polygon {
    /// Triangle `id`; `None` for a sphere.
    pub fn of(primitives: &Primitives, id: usize) -> Option<Self> {
        let corner = |v: photinus_geometry::Vec3| v.to_array().map(f64::from);
        (id < primitives.triangle_count())
            .then(|| Self { corners: primitives.triangle(id).map(corner).into_iter().collect() })
    }

    /// Whether nothing is left.
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// Its corners.
    pub fn corners(&self) -> &[Point] {
        &self.corners
    }

    /// The part where `height` is zero or more: a function that is linear in the point.
    pub fn above(&self, height: impl Fn(&Point) -> f64) -> Self {
        let mut out = Self::default();
        let Some(mut last) = self.corners.last() else { return out };
        let mut last_height = height(last);
        for corner in &self.corners {
            let this_height = height(corner);
            if (last_height < 0.0) != (this_height < 0.0) {
                let part = last_height / (last_height - this_height);
                let between = std::array::from_fn(|k| last[k] + (corner[k] - last[k]) * part);
                if out.corners.try_push(between).is_err() {
                    return self.clone();
                }
            }
            if !(this_height < 0.0) && out.corners.try_push(*corner).is_err() {
                return self.clone();
            }
            (last, last_height) = (corner, this_height);
        }
        out
    }

    /// The part between two limits along an axis.
    pub fn between(&self, axis: usize, low: f64, high: f64) -> Self {
        let part =
            if self.corners.iter().all(|p| p[axis] >= low) { self.clone() } else { self.above(|p| p[axis] - low) };
        if part.corners.iter().all(|p| p[axis] <= high) { part } else { part.above(|p| high - p[axis]) }
    }

    /// Least and greatest coordinate along an axis; the reverse where the polygon is empty.
    pub fn range(&self, axis: usize) -> (f64, f64) {
        let fold = |(low, high): (f64, f64), p: &Point| (low.min(p[axis]), high.max(p[axis]));
        self.corners.iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold)
    }
}

/// How far along each axis a hit of primitive `id` may lie outside of it: what [`pad`] adds.
pub(crate) fn margins(primitives: &Primitives, id: usize) -> Point {
    let (bare, padded) = (primitives.bounds_of(id), pad(primitives.bounds_of(id)));
    std::array::from_fn(|k| {
        let (below, above) =
            (f64::from(bare.min[k]) - f64::from(padded.min[k]), f64::from(padded.max[k]) - f64::from(bare.max[k]));
        below.max(above)
    })
}

/// Bounds of what lies of primitive `id` within `cell`, give or take its margins, within `known` bounds of it; `None`
/// where nothing does. Of spheres their bounds are taken.
pub(crate) fn bounds_within(primitives: &Primitives, id: usize, cell: &Aabb, known: &Aabb) -> Option<Aabb> {
    let mut out = Aabb { min: known.min.max(cell.min), max: known.max.min(cell.max) };
    if let Some(mut polygon) = Polygon::of(primitives, id) {
        let margins = margins(primitives, id);
        for axis in 0..3 {
            let (low, high) = (f64::from(cell.min[axis]), f64::from(cell.max[axis]));
            polygon = polygon.between(axis, low - margins[axis], high + margins[axis]);
        }
        for axis in 0..3 {
            let (low, high) = polygon.range(axis);
            // Outward by what the margin gains in rounding to floats; the reverse where nothing is left.
            out.min[axis] = out.min[axis].max(((low - margins[axis]) as f32).next_down());
            out.max[axis] = out.max[axis].min(((high + margins[axis]) as f32).next_up());
        }
    }
    (!out.is_empty()).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;

    fn one(triangle: [Vec3; 3]) -> Primitives {
        Primitives { positions: triangle.to_vec(), triangles: vec![[0, 1, 2]], spheres: Vec::new() }
    }

    #[test]
    fn polygons_are_cut_by_planes() {
        let primitives = one([Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 4.0]);
        let polygon = Polygon::of(&primitives, 0).unwrap();
        let corner = polygon.between(0, 1.0, 2.0);
        assert_eq!((corner.corners().len(), corner.range(0), corner.range(1)), (4, (1.0, 2.0), (0.0, 3.0)));
        assert!(polygon.between(0, 5.0, 6.0).is_empty() && polygon.between(2, 0.5, 1.0).is_empty());
        assert_eq!(polygon.between(1, -1.0, 9.0), polygon);
        let oblique = polygon.above(|p| p[0] + p[1] - 3.0);
        assert_eq!((oblique.corners().len(), oblique.range(0)), (4, (0.0, 4.0)));
        assert!(Polygon::of(&primitives, 1).is_none());
    }

    #[test]
    fn bounds_within_a_cell_are_those_of_the_part() {
        let primitives = one([Vec3::ZERO, Vec3::new(4.0, 4.0, 0.0), Vec3::new(4.0, 4.0, 1.0)]);
        let known = pad(primitives.bounds_of(0));
        let cell = |min: [f32; 3], max: [f32; 3]| Aabb { min: Vec3::from(min), max: Vec3::from(max) };
        // The triangle stands on the diagonal: beside it there is nothing, though its box is there.
        assert_eq!(bounds_within(&primitives, 0, &cell([3.0, 0.0, 0.0], [4.0, 1.0, 1.0]), &known), None);
        let part = bounds_within(&primitives, 0, &cell([0.0; 3], [2.0, 3.0, 1.0]), &known).unwrap();
        assert!(part.max.abs_diff_eq(Vec3::new(2.0, 2.0, 0.5), 1e-4) && part.max.y > 2.0, "{part:?}");
        let touching = bounds_within(&primitives, 0, &cell([4.0, 4.0, 0.0], [5.0, 5.0, 1.0]), &known).unwrap();
        assert!(touching.min.x >= 4.0 && touching.max.x > 4.0);
    }
}
