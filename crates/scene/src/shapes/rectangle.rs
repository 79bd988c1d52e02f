//! A square in the xy plane.

use crate::Mesh;
use photinus_geometry::{Vec2, Vec3};

/// The square from (-1, -1, 0) to (1, 1, 0), facing +z. The picture's left edge is at x = -1 and its top at y = -1, as
/// Mitsuba lays it.
pub fn rectangle() -> Mesh {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    Mesh {
        positions: corners.iter().map(|&(x, y)| Vec3::new(x, y, 0.0)).collect(),
        uvs: corners.iter().map(|&(x, y)| Vec2::new(0.5 * (x + 1.0), 0.5 * (1.0 - y))).collect(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}
