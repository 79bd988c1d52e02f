//! Exact spheres turned into triangles, for members that know triangles only and for comparisons like with like.

use crate::{Geometry, Mesh, Scene};
use photinus_geometry::{Sphere, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Segments around a sphere: never fewer, and never more (the latter makes 16.8 million triangles).
const SEGMENTS: std::ops::RangeInclusive<u32> = 8..=4096;

/// What was replaced.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tessellated {
    /// Spheres replaced.
    pub spheres: u64,
    /// Triangles that stand for them.
    pub triangles: u64,
    /// Largest distance of a triangle from its sphere, scene units.
    pub deviation: f32,
}

/// Replaces every sphere by a mesh with its vertices on the sphere and its triangles at most `max_deviation` scene
/// units inside. Normals and texture coordinates stay those of the sphere.
///
/// None where a sphere would need more segments than the limit: `max_deviation` is too small for its radius.
pub fn spheres(scene: &mut Scene, max_deviation: f32) -> Option<Tessellated> {
    let mut done = Tessellated::default();
    for shape in &mut scene.shapes {
        if let Geometry::Sphere { sphere, flip_normals, axes } = shape.geometry {
            let segments = segments(sphere.radius, max_deviation)?;
            let mesh = mesh(sphere, flip_normals, axes, segments);
            done.spheres += 1;
            done.triangles += mesh.triangles.len() as u64;
            done.deviation = done.deviation.max(deviation(sphere.radius, segments));
            shape.geometry = Geometry::Mesh(mesh);
        }
    }
    Some(done)
}

/// Segments around the equator, twice as many as between the poles. A face spans an angle of at most
/// sqrt(2) pi / n from its middle to its corners, so that its plane is within r (1 - cos(sqrt(2) pi / n)) of the sphere.
fn segments(radius: f32, max_deviation: f32) -> Option<u32> {
    let mut n = *SEGMENTS.start();
    while deviation(radius, n) > max_deviation {
        n += 2;
        if n > *SEGMENTS.end() {
            return None;
        }
    }
    Some(n)
}

fn deviation(radius: f32, segments: u32) -> f32 {
    let angle = f64::from(std::f32::consts::SQRT_2 * PI) / f64::from(segments);
    // 1 - cos x without cancellation.
    let half_sine = libm::sin(0.5 * angle);
    (f64::from(radius) * 2.0 * half_sine * half_sine) as f32
}

fn mesh(sphere: Sphere, flip_normals: bool, axes: [Vec3; 3], segments: u32) -> Mesh {
    let (columns, rows) = (segments, segments / 2);
    let mut mesh = Mesh::default();
    let [x, y, z] = axes;
    let sign = if flip_normals { -1.0 } else { 1.0 };
    // The seam's vertices exist twice, and so do the poles' for each column, as their texture coordinates differ.
    for row in 0..=rows {
        let v = row as f32 / rows as f32;
        let (sin_theta, cos_theta) = libm::sincosf(PI * (1.0 - v));
        let pole = row == 0 || row == rows;
        for column in 0..=columns {
            let u = (column as f32 + if pole { 0.5 } else { 0.0 }) / columns as f32;
            let (sin_phi, cos_phi) = libm::sincosf(TAU * (column % columns) as f32 / columns as f32);
            let sin_theta = if pole { 0.0 } else { sin_theta };
            let outward = x * (sin_theta * cos_phi) + y * (sin_theta * sin_phi) + z * cos_theta;
            mesh.positions.push(sphere.center + outward * sphere.radius);
            mesh.normals.push(outward * sign);
            mesh.uvs.push(Vec2::new(u, v));
        }
    }
    let vertex = |row: u32, column: u32| row * (columns + 1) + column;
    // Axes that mirror the sphere turn the winding around.
    let outwards = (x.cross(y).dot(z) > 0.0) != flip_normals;
    let mut triangle = |a: u32, b: u32, c: u32| mesh.triangles.push(if outwards { [a, b, c] } else { [a, c, b] });
    for row in 0..rows {
        for column in 0..columns {
            let (a, b) = (vertex(row, column), vertex(row, column + 1));
            let (c, d) = (vertex(row + 1, column + 1), vertex(row + 1, column));
            if row > 0 {
                triangle(a, b, c);
            }
            if row + 1 < rows {
                triangle(a, c, d);
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin;

    fn distance_to_origin(p: [Vec3; 3]) -> f32 {
        let n = (p[1] - p[0]).cross(p[2] - p[0]).normalize();
        n.dot(p[0]).abs()
    }

    #[test]
    fn a_tessellated_sphere_is_closed_near_and_faces_the_right_way() {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        for (flip, axes) in [(false, axes), (true, axes), (false, [Vec3::Y, Vec3::X, Vec3::Z])] {
            let sphere = Sphere { center: Vec3::ZERO, radius: 2.0 };
            let n = segments(2.0, 0.01).unwrap();
            let mesh = mesh(sphere, flip, axes, n);
            assert_eq!(mesh.triangles.len() as u32, n * (n / 2 - 1) * 2);
            let mut area = 0.0;
            for t in &mesh.triangles {
                let p = t.map(|v| mesh.positions[v as usize]);
                let normal = t.iter().fold(Vec3::ZERO, |sum, v| sum + mesh.normals[*v as usize]);
                let face = (p[1] - p[0]).cross(p[2] - p[0]);
                assert!(face.dot(normal) > 0.0, "flip {flip}: a face looks the other way");
                assert!(distance_to_origin(p) >= 2.0 - 0.01, "a face is too far inside");
                area += 0.5 * face.length();
            }
            // Closed: nearly the area of the sphere, from below.
            let exact = 4.0 * PI * 4.0;
            assert!(area < exact && area > 0.98 * exact, "area {area} of {exact}");
        }
    }

    #[test]
    fn scenes_lose_their_spheres_and_absurd_wishes_are_refused() {
        let mut scene = builtin::build("two-spheres").unwrap();
        let before = scene.triangle_count() as u64;
        let done = spheres(&mut scene, 1e-3).unwrap();
        assert_eq!(done.spheres, 2);
        assert!(done.deviation > 0.0 && done.deviation <= 1e-3);
        assert_eq!(scene.triangle_count() as u64, before + done.triangles);
        assert!(spheres(&mut builtin::build("two-spheres").unwrap(), 1e-12).is_none());
    }
}
