//! A cylinder's side.

use crate::Mesh;
use photinus_geometry::{Frame, Vec2, Vec3};
use std::f64::consts::TAU;

/// The side of the cylinder around the line from `p0` to `p1`, without its ends, facing outwards, with smooth normals:
/// `2 * segments` triangles (at least 3 segments). Texture coordinates are the angle over a full turn and, downwards
/// from 1, the place along the line. Nothing where the two points are one.
pub fn cylinder(p0: Vec3, p1: Vec3, radius: f32, segments: u32) -> Mesh {
    let Some(axis) = (p1 - p0).try_normalize() else { return Mesh::default() };
    let frame = Frame::from_normal(axis);
    let n = segments.max(3);
    let mut mesh = Mesh::default();
    for i in 0..=n {
        let turn = f64::from(i) / f64::from(n);
        let angle = if i == n { 0.0 } else { TAU * turn };
        let out = frame.s * libm::cos(angle) as f32 + frame.t * libm::sin(angle) as f32;
        mesh.positions.extend([p0 + out * radius, p1 + out * radius]);
        mesh.normals.extend([out, out]);
        mesh.uvs.extend([Vec2::new(turn as f32, 1.0), Vec2::new(turn as f32, 0.0)]);
    }
    for i in 0..n {
        let [a, b, c, d] = [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1];
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    mesh
}
