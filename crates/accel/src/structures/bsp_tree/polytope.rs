//! Convex cells with flat faces: their area, and that of both parts when a plane cuts them.
//!
//! Areas guide the build and nothing else: where a cell is too thin for doubles they may be off, and hits are not.

use crate::fragment::Point;
use photinus_geometry::Aabb;

pub(super) fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn minus(a: &Point, b: &Point) -> Point {
    std::array::from_fn(|k| a[k] - b[k])
}

pub(super) fn cross(a: &Point, b: &Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A plane in doubles: above are the points x with `normal . x` greater than `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Knife {
    pub normal: Point,
    pub offset: f64,
}

impl Knife {
    pub fn height(&self, p: &Point) -> f64 {
        dot(&self.normal, p) - self.offset
    }
}

/// Corners of a face, counter-clockwise seen from outside.
type Corners = Vec<Point>;

/// A face.
#[derive(Clone, Debug)]
struct Face {
    corners: Corners,
    /// See [`twice_area`].
    twice_area: Point,
    /// Length of that.
    size: f64,
}

impl Face {
    fn new(corners: Corners) -> Self {
        let twice_area = twice_area(&corners);
        Self { corners, twice_area, size: length(&twice_area) }
    }
}

/// A convex cell.
#[derive(Clone, Debug)]
pub(super) struct Polytope {
    faces: Vec<Face>,
}

/// Twice the area of a face, along its outward normal.
fn twice_area(face: &[Point]) -> Point {
    let mut sum = [0.0; 3];
    let Some((first, rest)) = face.split_first() else { return sum };
    for pair in rest.windows(2) {
        let part = cross(&minus(&pair[0], first), &minus(&pair[1], first));
        sum = std::array::from_fn(|k| sum[k] + part[k]);
    }
    sum
}

fn length(v: &Point) -> f64 {
    dot(v, v).sqrt()
}

/// Hands out the corners of the part of a face above a plane, and whether an edge crosses the plane there.
#[inline(always)]
fn part_above(face: &[Point], height: impl Fn(&Point) -> f64, mut corner_at: impl FnMut(Point, bool)) {
    let Some(mut last) = face.last() else { return };
    let mut last_height = height(last);
    for corner in face {
        let this_height = height(corner);
        if (last_height < 0.0) != (this_height < 0.0) {
            let part = last_height / (last_height - this_height);
            corner_at(std::array::from_fn(|k| last[k] + (corner[k] - last[k]) * part), true);
        }
        if !(this_height < 0.0) {
            corner_at(*corner, false);
        }
        (last, last_height) = (corner, this_height);
    }
}

/// [`twice_area`] of the part of a face above a plane.
fn twice_area_above(face: &[Point], knife: &Knife) -> Point {
    let (mut sum, mut first, mut last) = ([0.0; 3], None, [0.0; 3]);
    part_above(
        face,
        |p| knife.height(p),
        |p, _| {
            match &first {
                None => first = Some(p),
                Some(first) => {
                    let part = cross(&minus(&last, first), &minus(&p, first));
                    sum = std::array::from_fn(|k| sum[k] + part[k]);
                }
            }
            last = p;
        },
    );
    sum
}

impl Polytope {
    /// A box.
    pub fn of(cell: &Aabb) -> Self {
        let (min, max) = (cell.min.to_array().map(f64::from), cell.max.to_array().map(f64::from));
        let mut faces = Vec::with_capacity(6);
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |at: f64, pu: f64, pv: f64| {
                let mut p = [at; 3];
                (p[u], p[v]) = (pu, pv);
                p
            };
            let around = |at: f64| {
                vec![
                    corner(at, min[u], min[v]),
                    corner(at, max[u], min[v]),
                    corner(at, max[u], max[v]),
                    corner(at, min[u], max[v]),
                ]
            };
            faces.push(Face::new(around(max[axis])));
            faces.push(Face::new(around(min[axis]).into_iter().rev().collect()));
        }
        Self { faces }
    }

    /// Twice its surface area.
    pub fn twice_area(&self) -> f64 {
        self.faces.iter().map(|face| face.size).sum()
    }

    /// Twice the surface areas of the parts below and above a plane, the cut counted in both.
    pub fn twice_areas(&self, knife: &Knife) -> [f64; 2] {
        let [mut below, mut above] = [0.0; 2];
        // The outward areas of a closed body add up to nothing: what is missing is the cut.
        let mut open = [0.0; 3];
        for face in &self.faces {
            let heights = face.corners.iter().map(|p| knife.height(p));
            let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            if high <= 0.0 {
                below += face.size;
                continue;
            }
            let part = if low >= 0.0 { face.twice_area } else { twice_area_above(&face.corners, knife) };
            open = std::array::from_fn(|k| open[k] + part[k]);
            // Parts of a face lie in one plane: their sizes add up.
            let size = if low >= 0.0 { face.size } else { length(&part) };
            above += size;
            below += face.size - size;
        }
        let cut = length(&open);
        [below + cut, above + cut]
    }

    /// The parts below and above a plane.
    pub fn cut(&self, knife: &Knife) -> [Self; 2] {
        let mut rim = Vec::new();
        let part = |sign: f64, rim: &mut Vec<Point>| {
            let faces = self.faces.iter().map(|face| {
                let mut corners = Corners::with_capacity(face.corners.len() + 1);
                part_above(
                    &face.corners,
                    |p| sign * knife.height(p),
                    |p, crossed| {
                        corners.push(p);
                        if crossed {
                            rim.push(p);
                        }
                    },
                );
                corners
            });
            faces.filter(|corners| corners.len() >= 3).map(Face::new).collect::<Vec<_>>()
        };
        let mut below = part(-1.0, &mut Vec::new());
        let mut above = part(1.0, &mut rim);
        if rim.len() >= 3 {
            let cut = around(&knife.normal, rim);
            above.push(Face::new(cut.iter().rev().copied().collect()));
            below.push(Face::new(cut));
        }
        [Self { faces: below }, Self { faces: above }]
    }
}

/// Points of a convex rim in counter-clockwise order seen against the normal.
fn around(normal: &Point, mut points: Vec<Point>) -> Corners {
    let inv_count = 1.0 / points.len() as f64;
    let center: Point = std::array::from_fn(|k| points.iter().map(|p| p[k]).sum::<f64>() * inv_count);
    let least = (0..3).min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let u = cross(&axis, normal);
    let v = cross(normal, &u);
    let angle = |p: &Point| {
        let from_center = minus(p, &center);
        libm::atan2(dot(&from_center, &v) / length(&v), dot(&from_center, &u) / length(&u))
    };
    points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;

    #[test]
    fn areas_of_a_cut_cube_are_known() {
        let cube = Polytope::of(&Aabb { min: Vec3::ZERO, max: Vec3::ONE });
        assert!((cube.twice_area() - 12.0).abs() < 1e-12);
        let half = 0.5f64.sqrt();
        // Through two opposite edges; across an axis at a quarter; a corner off; outside.
        let third = (1.0f64 / 3.0).sqrt();
        let corner_area = 3.0 * 0.5 * 0.25 + 3f64.sqrt() / 4.0 * 0.5;
        for (normal, offset, expected) in [
            ([half, half, 0.0], half, [3.0 + 2f64.sqrt(), 3.0 + 2f64.sqrt()]),
            ([0.0, 1.0, 0.0], 0.25, [3.0, 5.0]),
            ([third; 3], 0.5 * third, [corner_area, 6.0 - 3.0 * 0.125 + 3f64.sqrt() / 4.0 * 0.5]),
            ([1.0, 0.0, 0.0], 2.0, [6.0, 0.0]),
        ] {
            let knife = Knife { normal, offset };
            let areas = cube.twice_areas(&knife);
            let parts = cube.cut(&knife);
            for side in 0..2 {
                assert!((areas[side] - 2.0 * expected[side]).abs() < 1e-9, "{normal:?}: {areas:?}, not {expected:?}");
                assert!((parts[side].twice_area() - areas[side]).abs() < 1e-9, "{normal:?}: {parts:?}");
            }
        }
    }

    #[test]
    fn parts_of_parts_are_closed() {
        let mut cell = Polytope::of(&Aabb { min: Vec3::ZERO, max: Vec3::new(3.0, 2.0, 1.0) });
        for (normal, offset) in [([0.6, 0.8, 0.0], 1.7), ([0.0, -0.6, 0.8], -0.2), ([0.48, 0.6, -0.64], 0.9)] {
            let knife = Knife { normal, offset };
            let areas = cell.twice_areas(&knife);
            let [below, above] = cell.cut(&knife);
            for (part, area) in [(&below, areas[0]), (&above, areas[1])] {
                let sum = part
                    .faces
                    .iter()
                    .map(|f| f.twice_area)
                    .fold([0.0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
                assert!(length(&sum) < 1e-9 && (part.twice_area() - area).abs() < 1e-9, "{normal:?}: {sum:?}");
            }
            cell = below;
        }
    }
}
