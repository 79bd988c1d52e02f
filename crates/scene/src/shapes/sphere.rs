//! Spheres as triangles, for members that have no exact spheres and for ellipsoids.

use crate::{Geometry, Mesh, Scene};
use photinus_geometry::{Sphere, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// Fewest and most segments around a sphere.
const SEGMENTS: std::ops::RangeInclusive<u32> = 8..=4096;

/// How many segments around a sphere of this radius keep its triangles within `max_error` of it: 8 to 4096.
///
/// A chord of angle a is off by r (1 - cos(a / 2)); a patch of the mesh has two chords to cross.
pub fn sphere_segments(radius: f32, max_error: f32) -> u32 {
    let relative = (0.5 * f64::from(max_error) / f64::from(radius)).clamp(1e-9, 1.0);
    let half_angle = libm::acos(1.0 - relative);
    ((PI / half_angle).ceil() as u32).next_multiple_of(2).clamp(*SEGMENTS.start(), *SEGMENTS.end())
}

/// A sphere as triangles: `segments` around the local z axis (at least 3) and half as many from pole to pole, vertices
/// on the sphere, smooth normals, the texture coordinates of [`Geometry::Sphere`].
pub fn sphere_mesh(sphere: Sphere, axes: [Vec3; 3], flip_normals: bool, segments: u32) -> Mesh {
    let columns = segments.max(3);
    let rows = (columns / 2).max(2);
    let mut mesh = Mesh::default();
    for j in 0..=rows {
        let v = f64::from(j) / f64::from(rows);
        // From the south pole (v = 0) up; the poles are exact.
        let (sin, cos) = match j {
            0 => (0.0, -1.0),
            _ if j == rows => (0.0, 1.0),
            _ => (libm::sin(PI * v), -libm::cos(PI * v)),
        };
        let is_pole = j == 0 || j == rows;
        for i in 0..=columns {
            let turn = f64::from(i) / f64::from(columns);
            let angle = if i == columns { 0.0 } else { TAU * turn };
            let local = [sin * libm::cos(angle), sin * libm::sin(angle), cos];
            let out = axes[0] * local[0] as f32 + axes[1] * local[1] as f32 + axes[2] * local[2] as f32;
            let u = if is_pole { (f64::from(i) + 0.5) / f64::from(columns) } else { turn };
            mesh.positions.push(sphere.center + out * sphere.radius);
            mesh.normals.push(if flip_normals { -out } else { out });
            mesh.uvs.push(Vec2::new(u as f32, v as f32));
        }
    }
    // Axes that mirror, or normals that point inwards, turn the triangles round; both together do not.
    let mirrored = axes[0].cross(axes[1]).dot(axes[2]) < 0.0;
    let mut add = |t: [u32; 3]| mesh.triangles.push(if mirrored != flip_normals { [t[0], t[2], t[1]] } else { t });
    for j in 0..rows {
        for i in 0..columns {
            let a = j * (columns + 1) + i;
            let c = a + columns + 1;
            if j == 0 {
                add([a, c + 1, c]);
            } else if j == rows - 1 {
                add([a, a + 1, c]);
            } else {
                add([a, a + 1, c + 1]);
                add([a, c + 1, c]);
            }
        }
    }
    mesh
}

/// Turns every exact sphere of a scene into triangles that stay within `max_error` scene units of it; says how many.
pub fn tessellate_spheres(scene: &mut Scene, max_error: f32) -> usize {
    let mut count = 0;
    for shape in &mut scene.shapes {
        if let Geometry::Sphere { sphere, flip_normals, axes } = shape.geometry {
            let segments = sphere_segments(sphere.radius, max_error);
            shape.geometry = Geometry::Mesh(sphere_mesh(sphere, axes, flip_normals, segments));
            count += 1;
        }
    }
    count
}
