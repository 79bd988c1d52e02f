//! Parts of primitives inside boxes, in doubles: what a cell, or one side of a split, answers for.
//!
//! The ray-triangle test sees vertices displaced by some roundings of the triangle's size (see [`crate::bounds`]).
//! Parts of a triangle are therefore padded by as much as the whole.

use super::volume::PaddedPoint;
use crate::bounds::{SLAB_SLACK, padded_bounds};
use photinus_geometry::{Aabb, Primitives};

/// A box in doubles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    /// Lower corner.
    pub low: [f64; 3],
    /// Upper corner.
    pub high: [f64; 3],
}

impl Cell {
    /// The same box.
    pub fn of(b: &Aabb) -> Self {
        Self { low: b.min.to_array().map(f64::from), high: b.max.to_array().map(f64::from) }
    }

    /// The smallest box of floats around this one; finite.
    pub fn outward(&self) -> Aabb {
        let down = |x: f64| if f64::from(x as f32) > x { (x as f32).next_down() } else { x as f32 };
        let up = |x: f64| if f64::from(x as f32) < x { (x as f32).next_up() } else { x as f32 };
        Aabb { min: self.low.map(|x| down(x).max(f32::MIN)).into(), max: self.high.map(|x| up(x).min(f32::MAX)).into() }
    }

    /// One of the eight parts: bit `k` of `octant` says whether it lies above along axis `k`.
    pub fn octant(&self, octant: usize) -> Self {
        let mut out = *self;
        for axis in 0..3 {
            let middle = f64::midpoint(self.low[axis], self.high[axis]);
            if octant >> axis & 1 == 0 {
                out.high[axis] = middle;
            } else {
                out.low[axis] = middle;
            }
        }
        out
    }
}

/// Vertices of triangle `id` in doubles, and how far its parts are padded.
fn triangle(primitives: &Primitives, id: usize) -> ([[f64; 3]; 3], f64) {
    let vertices = primitives.triangle(id).map(|v| v.to_array().map(f64::from));
    let size = |axis: usize| {
        let [a, b, c] = vertices.map(|v| v[axis]);
        a.max(b).max(c) - a.min(b).min(c)
    };
    (vertices, f64::from(SLAB_SLACK) * (size(0) + size(1) + size(2)))
}

/// Where the edge from `a` to `b` meets the plane at `position` across `axis`; its ends lie on different sides.
fn crossing(a: &[f64; 3], b: &[f64; 3], axis: usize, position: f64) -> [f64; 3] {
    let s = (position - a[axis]) / (b[axis] - a[axis]);
    std::array::from_fn(|k| {
        if k == axis { position } else { (a[k] + (b[k] - a[k]) * s).clamp(a[k].min(b[k]), a[k].max(b[k])) }
    })
}

/// Clips polygons; its lists are used again and again.
#[derive(Default)]
pub(crate) struct Clipper {
    polygon: Vec<[f64; 3]>,
    next: Vec<[f64; 3]>,
}

impl Clipper {
    /// Keeps what lies on one side of a plane, the plane included.
    fn keep(&mut self, axis: usize, position: f64, above: bool) {
        let inside = |p: &[f64; 3]| if above { p[axis] >= position } else { p[axis] <= position };
        self.next.clear();
        for (i, a) in self.polygon.iter().enumerate() {
            let b = &self.polygon[(i + 1) % self.polygon.len()];
            if inside(a) {
                self.next.push(*a);
            }
            if inside(a) != inside(b) {
                self.next.push(crossing(a, b, axis, position));
            }
        }
        std::mem::swap(&mut self.polygon, &mut self.next);
    }

    /// Appends points whose padded hull holds the part of a hittable primitive in a cell; false where it has none
    /// there. Of a sphere the part is that of its bounds.
    pub fn part(&mut self, primitives: &Primitives, id: usize, cell: &Cell, points: &mut Vec<PaddedPoint>) -> bool {
        if id >= primitives.triangle_count() {
            let Some(bounds) = padded_bounds(primitives, id) else { return false };
            let mut part = Cell::of(&bounds);
            for axis in 0..3 {
                part.low[axis] = part.low[axis].max(cell.low[axis]);
                part.high[axis] = part.high[axis].min(cell.high[axis]);
                if part.low[axis] > part.high[axis] {
                    return false;
                }
            }
            let corner = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 0 { part.low[k] } else { part.high[k] });
            points.extend((0..8).map(|i| PaddedPoint { at: corner(i), pad: 0.0 }));
            return true;
        }
        let (vertices, pad) = triangle(primitives, id);
        self.polygon.clear();
        self.polygon.extend(vertices);
        for axis in 0..3 {
            if vertices.iter().any(|v| v[axis] < cell.low[axis]) {
                self.keep(axis, cell.low[axis], true);
            }
            if vertices.iter().any(|v| v[axis] > cell.high[axis]) {
                self.keep(axis, cell.high[axis], false);
            }
        }
        points.extend(self.polygon.iter().map(|&at| PaddedPoint { at, pad }));
        !self.polygon.is_empty()
    }

    /// Padded bounds of the part of a hittable primitive within `part`, itself such bounds, and within a slab across
    /// an axis; `None` where nothing of it lies there.
    pub fn slab(
        &mut self,
        primitives: &Primitives,
        id: usize,
        part: &Aabb,
        axis: usize,
        slab: [f64; 2],
    ) -> Option<Aabb> {
        let [low, high] = slab;
        let mut out = *part;
        if id < primitives.triangle_count() {
            let (vertices, pad) = triangle(primitives, id);
            self.polygon.clear();
            self.polygon.extend(vertices);
            if vertices.iter().any(|v| v[axis] < low) {
                self.keep(axis, low, true);
            }
            if vertices.iter().any(|v| v[axis] > high) {
                self.keep(axis, high, false);
            }
            let mut cell = Cell { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
            for p in &self.polygon {
                for k in 0..3 {
                    cell.low[k] = cell.low[k].min(p[k] - pad);
                    cell.high[k] = cell.high[k].max(p[k] + pad);
                }
            }
            let cell = (!self.polygon.is_empty()).then(|| cell.outward())?;
            out = Aabb { min: part.min.max(cell.min), max: part.max.min(cell.max) };
        } else {
            let slab = Cell { low: [low; 3], high: [high; 3] }.outward();
            out.min[axis] = out.min[axis].max(slab.min[axis]);
            out.max[axis] = out.max[axis].min(slab.max[axis]);
        }
        (!out.is_empty()).then_some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::{Sphere, Vec3};

    fn one_triangle() -> Primitives {
        let positions = vec![Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 2.0)];
        let spheres = vec![Sphere { center: Vec3::ONE, radius: 1.0 }];
        Primitives { positions, triangles: vec![[0, 1, 2]], spheres }
    }

    #[test]
    fn parts_lie_in_their_cells_and_cover_the_triangle() {
        let primitives = one_triangle();
        let whole = Cell { low: [0.0; 3], high: [4.0; 3] };
        let mut clipper = Clipper::default();
        let mut areas = 0.0;
        for octant in 0..8 {
            let cell = whole.octant(octant);
            let mut points = Vec::new();
            if !clipper.part(&primitives, 0, &cell, &mut points) {
                assert!(points.is_empty());
                continue;
            }
            for p in &points {
                assert!((0..3).all(|k| p.at[k] >= cell.low[k] && p.at[k] <= cell.high[k]), "{p:?} {cell:?}");
                assert!(p.pad > 0.0);
            }
            // A fan over the part; seen along z the triangle's area is 8.
            for w in points[1..].windows(2) {
                let (u, v) =
                    ([0, 1].map(|k| w[0].at[k] - points[0].at[k]), [0, 1].map(|k| w[1].at[k] - points[0].at[k]));
                areas += 0.5 * (u[0] * v[1] - u[1] * v[0]).abs();
            }
        }
        assert!((areas - 8.0).abs() < 1e-9, "{areas}");
    }

    #[test]
    fn slabs_cut_bounds_and_never_grow_them() {
        let primitives = one_triangle();
        let whole = padded_bounds(&primitives, 0).unwrap();
        let mut clipper = Clipper::default();
        let left = clipper.slab(&primitives, 0, &whole, 0, [f64::NEG_INFINITY, 1.0]).unwrap();
        let right = clipper.slab(&primitives, 0, &whole, 0, [1.0, f64::INFINITY]).unwrap();
        assert!(left.max.x >= 1.0 && left.max.x < 1.001 && left.max.y >= 4.0);
        assert!(right.min.x <= 1.0 && right.min.x > 0.999 && right.max.y < 3.001);
        assert!(whole.contains(left.min) && whole.contains(left.max) && whole.contains(right.max));
        assert!(primitives.positions.iter().all(|v| left.union(right).contains(*v)));
        assert_eq!(clipper.slab(&primitives, 0, &whole, 0, [5.0, 6.0]), None);
        let ball = padded_bounds(&primitives, 1).unwrap();
        let half = clipper.slab(&primitives, 1, &ball, 2, [f64::NEG_INFINITY, 0.5]).unwrap();
        assert_eq!((half.max.z, half.max.x), (0.5, ball.max.x));
        assert_eq!(clipper.slab(&primitives, 1, &ball, 2, [2.5, 3.0]), None);
    }
}
