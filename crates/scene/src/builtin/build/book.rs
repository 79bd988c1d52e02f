//! Books: two covers, a rounded back and a block of pages.

use super::{Faces, Join, Part, cuboid, patch, place::sin_cos_degrees};
use photinus_geometry::Vec3;

/// The two materials' worth of a closed book.
pub struct Book {
    /// Covers and back.
    pub binding: Part,
    /// The pages.
    pub pages: Part,
}

/// A book standing on the xz plane: its back faces +z, its thickness runs along x, all around the origin's y axis.
/// 52 triangles of binding and 12 of pages.
pub fn book(thickness: f32, height: f32, depth: f32) -> Book {
    let board = (0.08 * thickness).clamp(0.12, 0.3);
    let (x, z) = (0.5 * thickness, 0.5 * depth);
    let inset = 0.03 * height;
    let cover = |x0: f32, x1: f32| cuboid([x0, 0.0, -z], [x1, height, z], Faces::All);
    let mut binding = cover(-x, -x + board).and(cover(x - board, x));
    // The back: a shallow arch, from one cover to the other, with its inner side and the rims above and below.
    let arch = |s: f32, inner: f32| {
        let (sin, cos) = sin_cos_degrees(180.0 * s);
        [-(x - inner) * cos, z + (0.35 * x - inner) * sin]
    };
    binding.add(patch(7, 2, Join::Open, |u, v| {
        let [px, pz] = arch(u, 0.0);
        Vec3::new(px, height * v, pz)
    }));
    let pages = cuboid([-x + board, inset, -z + inset], [x - board, height - inset, z], Faces::All);
    Book { binding, pages }
}
