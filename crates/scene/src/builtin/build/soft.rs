//! Soft bodies: rounded boxes and cushions.

use super::{Part, Place};
use photinus_geometry::Vec3;
use std::collections::BTreeMap;

/// A box rounded like a cushion: the surface |x/a|^p + |y/b|^p + |z/c|^p = 1 around the origin, `cells` cells along
/// each axis. `power` 2 is an ellipsoid, 4 a pillow, 10 almost a box.
///
/// A cube's grid is drawn onto it from the middle, so that cells stay even; 4 (xy + yz + zx) triangles.
pub fn soft_box(half: [f32; 3], power: f32, cells: [usize; 3]) -> Part {
    let half = Vec3::from(half);
    let mut part = Part::default();
    // A vertex by its exact integer place on the cube's grid, and by its side, which has texture coordinates of its own.
    let mut known: BTreeMap<(usize, [i64; 3]), u32> = BTreeMap::new();
    for axis in 0..3 {
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        for sign in [-1i64, 1] {
            let side = axis * 2 + (sign > 0) as usize;
            for j in 0..cells[b] {
                for i in 0..cells[a] {
                    let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| {
                        let mut grid = [0i64; 3];
                        grid[axis] = sign * cells[axis] as i64;
                        grid[a] = 2 * i as i64 - cells[a] as i64;
                        grid[b] = 2 * j as i64 - cells[b] as i64;
                        *known.entry((side, grid)).or_insert_with(|| {
                            let cube = Vec3::from([0, 1, 2].map(|k| grid[k] as f32 / cells[k] as f32));
                            let (p, n) = onto(cube, half, power);
                            part.vertex(p, n, [p[a], p[b]])
                        })
                    });
                    let [c0, c1, c2, c3] =
                        if sign > 0 { corners } else { [corners[0], corners[3], corners[2], corners[1]] };
                    let near = (part.position(c0) - part.position(c2)).length();
                    let far = (part.position(c1) - part.position(c3)).length();
                    if near <= far {
                        part.triangle(c0, c1, c2);
                        part.triangle(c0, c2, c3);
                    } else {
                        part.triangle(c0, c1, c3);
                        part.triangle(c1, c2, c3);
                    }
                }
            }
        }
    }
    part
}

/// The point of the rounded box in the direction of `cube`, and the normal there.
fn onto(cube: Vec3, half: Vec3, power: f32) -> (Vec3, Vec3) {
    let pow = |x: f32, e: f32| libm::powf(x.abs(), e);
    let sum = pow(cube.x, power) + pow(cube.y, power) + pow(cube.z, power);
    let unit = cube / libm::powf(sum, 1.0 / power);
    let slope = Vec3::from([0, 1, 2].map(|k| unit[k].signum() * pow(unit[k], power - 1.0) / half[k]));
    (unit * half, slope / slope.length())
}

/// A scatter cushion in the xy plane, thick along z, with pinched corners and a seam all around.
///
/// `cells` along each side, even and at least 4; 4 cells² triangles.
pub fn cushion(width: f32, height: f32, thickness: f32, cells: usize) -> Part {
    let mut front = Part::default();
    let at = |i: usize, j: usize| {
        let (x, y) = (2.0 * i as f32 / cells as f32 - 1.0, 2.0 * j as f32 / cells as f32 - 1.0);
        let (ex, ey) = (1.0 - x * x, 1.0 - y * y);
        // Sides are drawn in between the corners, and the filling is round from seam to seam.
        let bulge = libm::powf((ex * ey).max(0.0), 0.55);
        Vec3::new(0.5 * width * x * (1.0 - 0.07 * ey), 0.5 * height * y * (1.0 - 0.07 * ex), 0.5 * thickness * bulge)
    };
    for j in 0..=cells {
        for i in 0..=cells {
            front.vertex(at(i, j), Vec3::Z, [i as f32 / cells as f32, j as f32 / cells as f32]);
        }
    }
    let index = |i: usize, j: usize| (j * (cells + 1) + i) as u32;
    for j in 0..cells {
        for i in 0..cells {
            let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
            // Diagonals run towards the middle: at a corner the other one would lie flat in the seam.
            if (2 * i < cells) == (2 * j < cells) {
                front.triangle(a, b, c);
                front.triangle(a, c, d);
            } else {
                front.triangle(a, b, d);
                front.triangle(b, c, d);
            }
        }
    }
    // Each side is smooth in itself; the seam is a crease.
    let front = front.smoothed();
    let back = front.clone().placed(Place::HERE.scale(1.0, 1.0, -1.0));
    front.and(back)
}
