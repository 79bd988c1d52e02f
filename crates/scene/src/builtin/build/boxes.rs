//! Boxes and frames.

use super::{Part, Place};
use photinus_geometry::Vec3;

/// Which faces a plain box has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Faces {
    /// All six.
    All,
    /// All but the one below, for what stands on something.
    NoBottom,
}

/// The corner of a box, chosen by bits: x, y, z.
fn corner(min: Vec3, max: Vec3, bits: usize) -> Vec3 {
    let pick = |axis: usize| if bits >> axis & 1 == 1 { max[axis] } else { min[axis] };
    Vec3::new(pick(0), pick(1), pick(2))
}

/// The corners of the face that looks along `axis` (`sign` 0 down, 1 up), counter-clockwise from outside.
fn face(axis: usize, sign: usize) -> [usize; 4] {
    let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
    let base = sign << axis;
    let around = [base, base | 1 << a, base | 1 << a | 1 << b, base | 1 << b];
    if sign == 1 { around } else { [around[0], around[3], around[2], around[1]] }
}

/// Texture coordinates of a point on a face across `axis`, in scene units; the grain of wood (v) runs along the
/// longer side of the face.
fn face_uv(p: Vec3, axis: usize, size: Vec3) -> [f32; 2] {
    let (a, b) = match axis {
        0 => (2, 1),
        1 => (0, 2),
        _ => (0, 1),
    };
    if size[b] >= size[a] { [p[a], p[b]] } else { [p[b], p[a]] }
}

/// A box with sharp edges: 12 triangles, or 10 without its bottom. Texture coordinates are in scene units.
pub fn cuboid(min: [f32; 3], max: [f32; 3], faces: Faces) -> Part {
    let (min, max) = (Vec3::from(min), Vec3::from(max));
    let mut part = Part::default();
    for axis in 0..3 {
        for sign in 0..2 {
            if faces == Faces::NoBottom && axis == 1 && sign == 0 {
                continue;
            }
            let corners = face(axis, sign).map(|bits| corner(min, max, bits));
            part.quad(corners, corners.map(|p| face_uv(p, axis, max - min)));
        }
    }
    part
}

/// A box whose edges are cut by a bevel that shades as if round: 44 triangles. Texture coordinates are in scene units.
pub fn bevelled(min: [f32; 3], max: [f32; 3], bevel: f32) -> Part {
    let (min, max) = (Vec3::from(min), Vec3::from(max));
    let size = max - min;
    let mut part = Part::default();
    // The vertex of a face's flat middle nearest to a corner of the box.
    let point = |axis: usize, bits: usize| {
        let inset = Vec3::from([0, 1, 2].map(|k| {
            let inward = if bits >> k & 1 == 1 { -bevel } else { bevel };
            if k == axis { 0.0 } else { inward }
        }));
        corner(min, max, bits) + inset
    };
    let out = |axis: usize, bits: usize| {
        let mut n = Vec3::ZERO;
        n[axis] = if bits >> axis & 1 == 1 { 1.0 } else { -1.0 };
        n
    };
    let facing = |part: &mut Part, corners: &[(usize, usize)], uv_axis: usize| {
        let middle = (min + max) * 0.5;
        let v: Vec<u32> = corners
            .iter()
            .map(|&(axis, bits)| {
                let p = point(axis, bits);
                part.vertex(p, out(axis, bits), face_uv(p, uv_axis, size))
            })
            .collect();
        let [a, b, c] = [0, 1, 2].map(|i| part.position(v[i]));
        let outward = (b - a).cross(c - a).dot((a + b + c) / 3.0 - middle) > 0.0;
        for i in 1..v.len() - 1 {
            if outward { part.triangle(v[0], v[i], v[i + 1]) } else { part.triangle(v[0], v[i + 1], v[i]) }
        }
    };
    for axis in 0..3 {
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        for sign in 0..2 {
            facing(&mut part, &face(axis, sign).map(|bits| (axis, bits)), axis);
        }
        // The four edges along this axis lie between the faces across the other two.
        for side in 0..4 {
            let bits = (side & 1) << a | (side >> 1) << b;
            facing(&mut part, &[(a, bits), (a, bits | 1 << axis), (b, bits | 1 << axis), (b, bits)], a);
        }
    }
    for bits in 0..8 {
        facing(&mut part, &[(0, bits), (1, bits), (2, bits)], 0);
    }
    part
}

/// A bevelled box around a place: `size` wide, high and deep, standing on the place's origin.
pub fn standing(size: [f32; 3], bevel: f32) -> Part {
    let [w, h, d] = size;
    bevelled([-0.5 * w, 0.0, -0.5 * d], [0.5 * w, h, 0.5 * d], bevel)
}

/// A rectangular frame in the xy plane around an opening of `width` x `height` whose middle is the origin.
///
/// `outline` is a closed loop of (distance outward from the opening, height along z) points, counter-clockwise when
/// outward is to the right and z up; the first point is not repeated. 8 triangles a point.
pub fn frame(width: f32, height: f32, outline: &[[f32; 2]]) -> Part {
    let mut part = Part::default();
    let sides = [(0.0, width, height), (90.0, height, width), (180.0, width, height), (270.0, height, width)];
    for (degrees, length, across) in sides {
        let place = Place::HERE.roll(degrees);
        // This side runs along x below the opening: outward is -y.
        for k in 0..outline.len() {
            let (p, q) = (outline[k], outline[(k + 1) % outline.len()]);
            let at = |[out, z]: [f32; 2], end: f32| {
                place.point(Vec3::new(end * (0.5 * length + out), -0.5 * across - out, z))
            };
            let corners = [at(p, 1.0), at(q, 1.0), at(q, -1.0), at(p, -1.0)];
            let step = ((q[0] - p[0]) * (q[0] - p[0]) + (q[1] - p[1]) * (q[1] - p[1])).sqrt();
            part.quad(corners, [[0.0, length], [step, length], [step, 0.0], [0.0, 0.0]]);
        }
    }
    part
}
