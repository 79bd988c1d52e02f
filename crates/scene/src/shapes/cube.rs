//! A cube with a picture on each face.

use crate::Mesh;
use photinus_geometry::{Vec2, Vec3};

/// Directions of the picture's right and up on each face; their cross product is the face's normal.
const FACES: [(Vec3, Vec3); 6] = [
    (Vec3::Z, Vec3::NEG_X),
    (Vec3::NEG_X, Vec3::Z),
    (Vec3::Y, Vec3::Z),
    (Vec3::Y, Vec3::NEG_X),
    (Vec3::Y, Vec3::NEG_Z),
    (Vec3::NEG_Y, Vec3::NEG_X),
];

/// The cube from (-1, -1, -1) to (1, 1, 1), facing outwards: 24 vertices, 12 triangles, each face a whole picture as
/// Mitsuba lays it.
pub fn cube() -> Mesh {
    let mut mesh = Mesh::default();
    for (right, up) in FACES {
        let first = mesh.positions.len() as u32;
        for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            mesh.positions.push(right.cross(up) + right * (2.0 * u - 1.0) + up * (2.0 * v - 1.0));
            mesh.uvs.push(Vec2::new(u, v));
        }
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh
}
