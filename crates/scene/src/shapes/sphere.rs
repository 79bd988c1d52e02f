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

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

    /// Largest distance between a sphere and its triangles, at corners, edge middles and face middles.
    fn error(mesh: &Mesh, sphere: Sphere) -> f32 {
        let off = |p: Vec3| ((p - sphere.center).length() - sphere.radius).abs();
        let of_face = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
            [a, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5, (a + b + c) / 3.0].map(off).into_iter().fold(0.0, f32::max)
        };
        mesh.triangles.iter().map(of_face).fold(0.0, f32::max)
    }

    #[test]
    fn the_error_is_kept() {
        for radius in [0.01, 1.0, 300.0] {
            let sphere = Sphere { center: Vec3::new(1.0, -2.0, 3.0), radius };
            for relative in [0.1, 0.01, 1e-3] {
                let segments = sphere_segments(radius, relative * radius);
                let mesh = sphere_mesh(sphere, AXES, false, segments);
                assert!(error(&mesh, sphere) <= 1.01 * relative * radius, "{radius} {relative} {segments}");
            }
        }
        for (radius, error) in [(1.0, 0.0), (1.0, f32::NAN), (f32::MAX, 1e-30), (1e-30, f32::INFINITY)] {
            assert!((8..=4096).contains(&sphere_segments(radius, error)), "{radius} {error}");
        }
    }

    #[test]
    fn spheres_are_closed_and_look_the_right_way() {
        let sphere = Sphere { center: Vec3::ZERO, radius: 1.0 };
        for (axes, mirrored) in [(AXES, false), ([Vec3::Y, Vec3::X, Vec3::Z], true)] {
            for flip in [false, true] {
                let mesh = sphere_mesh(sphere, axes, flip, 64);
                assert_eq!(mesh.triangles.len(), 64 * 2 * 31);
                let sign = if flip { -1.0 } else { 1.0 };
                for t in &mesh.triangles {
                    let p = t.map(|v| mesh.positions[v as usize]);
                    let face = (p[1] - p[0]).cross(p[2] - p[0]);
                    assert!(sign * face.dot(p[0] + p[1] + p[2]) > 0.0, "{mirrored} {flip}");
                    assert!(t.iter().all(|&v| mesh.normals[v as usize].dot(face) > 0.0));
                }
                // The volume of a closed surface that is nearly the sphere's.
                let six: f32 = mesh
                    .triangles
                    .iter()
                    .map(|t| t.map(|v| mesh.positions[v as usize]))
                    .map(|p| p[0].dot(p[1].cross(p[2])))
                    .sum();
                assert!((sign * six / 6.0 / (4.0 / 3.0 * std::f32::consts::PI) - 1.0).abs() < 5e-3);
            }
        }
    }

    #[test]
    fn texture_coordinates_are_those_of_the_exact_sphere() {
        let axes = [Vec3::Z, Vec3::X, Vec3::Y];
        let mesh = sphere_mesh(Sphere { center: Vec3::ONE, radius: 2.0 }, axes, false, 16);
        for (p, uv) in mesh.positions.iter().zip(&mesh.uvs) {
            let d = (*p - Vec3::ONE) / 2.0;
            let local = Vec3::new(d.dot(axes[0]), d.dot(axes[1]), d.dot(axes[2]));
            let v = 1.0 - libm::acosf(local.z.clamp(-1.0, 1.0)) / std::f32::consts::PI;
            assert!((v - uv.y).abs() < 1e-3, "{local} {uv}");
            if local.truncate().length() > 1e-3 {
                let u = libm::atan2f(local.y, local.x) / std::f32::consts::TAU;
                let off = u - uv.x;
                assert!((off - off.round()).abs() < 1e-4, "{local} {uv}");
            }
        }
    }

    #[test]
    fn all_spheres_of_a_scene_become_triangles() {
        let mut scene = crate::builtin::build("two-spheres").expect("the default scene");
        let before = scene.bounds();
        assert_eq!(tessellate_spheres(&mut scene, 1e-3), 2);
        assert_eq!(tessellate_spheres(&mut scene, 1e-3), 0);
        assert!((scene.bounds().size() - before.size()).length() < 1e-2);
    }
}
