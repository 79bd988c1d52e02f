//! Books: two covers, a rounded back and a block of pages.

use super::{Faces, Join, Part, cuboid, patch, place::sin_cos_degrees};
use photinus_geometry::Vec3;

/// A closed book, by what it is made of.
pub struct Book {
    /// Covers and back.
    pub binding: Part,
    /// The pages: head, tail and fore edge, all that one can see of them.
    pub pages: Part,
}

/// A book standing on the xz plane: its back faces +z, its thickness runs along x, all around the origin's y axis.
/// 36 triangles of binding and 6 of pages.
pub fn book(thickness: f32, height: f32, depth: f32) -> Book {
    let board = (0.08 * thickness).clamp(0.12, 0.3);
    let (x, z) = (0.5 * thickness, 0.5 * depth);
    let inset = 0.03 * height;
    let cover = |x0: f32, x1: f32| cuboid([x0, 0.0, -z], [x1, height, z], Faces::All);
    let mut binding = cover(-x, -x + board).and(cover(x - board, x));
    // The back is a shallow arch from one cover to the other, starting within their thickness.
    binding.add(patch(6, 1, Join::Open, |u, v| {
        let (sin, cos) = sin_cos_degrees(180.0 * u);
        Vec3::new(-0.97 * x * cos, height * v, z + 0.35 * x * sin)
    }));
    let (l, r, b, t, f) = (-x + board, x - board, inset, height - inset, -z + inset);
    let mut pages = Part::default();
    for face in [
        [[l, t, z], [r, t, z], [r, t, f], [l, t, f]],
        [[l, b, f], [r, b, f], [r, b, z], [l, b, z]],
        [[r, b, f], [l, b, f], [l, t, f], [r, t, f]],
    ] {
        pages.quad(face.map(Vec3::from), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    }
    Book { binding, pages }
}
