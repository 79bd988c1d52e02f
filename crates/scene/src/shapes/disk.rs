//! A disk in the xy plane.

use crate::Mesh;
use photinus_geometry::{Vec2, Vec3};
use std::f64::consts::TAU;

/// The unit disk around the origin, facing +z, as a fan of `segments` triangles (at least 3). Texture coordinates are
/// the radius and, downwards from 1, the angle from +x over a full turn.
pub fn disk(segments: u32) -> Mesh {
    let n = segments.max(3);
    let mut mesh = Mesh::default();
    for i in 0..=n {
        let turn = f64::from(i) / f64::from(n);
        // The ends meet in the same point to the last bit.
        let angle = if i == n { 0.0 } else { TAU * turn };
        mesh.positions.push(Vec3::new(libm::cos(angle) as f32, libm::sin(angle) as f32, 0.0));
        mesh.uvs.push(Vec2::new(1.0, (1.0 - turn) as f32));
    }
    for i in 0..n {
        // The middle has every angle: one vertex for each triangle.
        let turn = (f64::from(i) + 0.5) / f64::from(n);
        mesh.positions.push(Vec3::ZERO);
        mesh.uvs.push(Vec2::new(0.0, (1.0 - turn) as f32));
        mesh.triangles.push([n + 1 + i, i, i + 1]);
    }
    mesh
}
