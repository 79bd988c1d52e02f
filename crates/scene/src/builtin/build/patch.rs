//! Curved surfaces over the unit square.

use super::Part;
use photinus_geometry::Vec3;

/// Which edges of the unit square are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// None: a sheet.
    Open,
    /// u = 0 with u = 1: a pipe.
    U,
    /// Both pairs: a ring.
    Both,
}

/// The surface `f(u, v)` in `nu` x `nv` cells, smooth; its outside is the side of df/du x df/dv.
///
/// A row (v = 0 or v = 1) that is a single point becomes a fan. 2 nu nv triangles, less nu for each such row.
pub fn patch(nu: usize, nv: usize, join: Join, f: impl Fn(f32, f32) -> Vec3) -> Part {
    let columns = if join == Join::Open { nu + 1 } else { nu };
    let rows = if join == Join::Both { nv } else { nv + 1 };
    let points: Vec<Vec<Vec3>> =
        (0..rows).map(|j| (0..columns).map(|i| f(i as f32 / nu as f32, j as f32 / nv as f32)).collect()).collect();
    let at = |i: usize, j: usize| points[j % rows][i % columns];
    let is_point = |j: usize| points[j % rows].iter().all(|&p| p == points[j % rows][0]);
    let pole = [is_point(0), is_point(nv)];

    // Faces first, as corner pairs (i, j), so that normals can be gathered over joined edges.
    let mut faces: Vec<[[usize; 2]; 3]> = Vec::with_capacity(2 * nu * nv);
    for j in 0..nv {
        for i in 0..nu {
            let [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            if j == 0 && pole[0] {
                faces.push([a, c, d]);
            } else if j + 1 == nv && pole[1] {
                faces.push([a, b, c]);
            } else if (at(a[0], a[1]) - at(c[0], c[1])).length() <= (at(b[0], b[1]) - at(d[0], d[1])).length() {
                faces.extend([[a, b, c], [a, c, d]]);
            } else {
                faces.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    // A fan's tip is one point for the normals, whatever its column.
    let slot = |[i, j]: [usize; 2]| {
        let (row, tip) = (j % rows, (j == 0 && pole[0]) || (j == nv && pole[1]));
        row * columns + if tip { 0 } else { i % columns }
    };
    let mut sums = vec![Vec3::ZERO; rows * columns];
    for face in &faces {
        let [a, b, c] = face.map(|[i, j]| at(i, j));
        let cross = (b - a).cross(c - a);
        face.iter().for_each(|&corner| sums[slot(corner)] += cross);
    }

    let mut part = Part::default();
    for j in 0..=nv {
        for i in 0..=nu {
            let sum = sums[slot([i, j])];
            // The tip of a fan lies in the middle of its cell's edge; its last copy belongs to no face.
            let tip = (j == 0 && pole[0]) || (j == nv && pole[1]);
            let u = if tip { (i as f32 + 0.5) / nu as f32 } else { i as f32 / nu as f32 };
            part.vertex(at(i, j), sum / sum.length(), [u, j as f32 / nv as f32]);
        }
    }
    let index = |[i, j]: [usize; 2]| (j * (nu + 1) + i) as u32;
    for face in faces {
        let [a, b, c] = face;
        // The tip used by a fan's face is the copy of the face's own column.
        let own = |corner: [usize; 2]| {
            let tip = (corner[1] == 0 && pole[0]) || (corner[1] == nv && pole[1]);
            if tip { [a[0].min(b[0]).min(c[0]), corner[1]] } else { corner }
        };
        part.triangle(index(own(a)), index(own(b)), index(own(c)));
    }
    part
}
