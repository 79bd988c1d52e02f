//! Shading normals made from faces, as Mitsuba makes them.

use crate::Mesh;
use photinus_geometry::Vec3;

/// Gives every vertex the mean of its faces' normals, weighted by the angle at the vertex (Thürmer and Wüthrich,
/// "Computing vertex normals from polygonal facets", JGT 3(1), 1998).
///
/// `points` names the surface point of each vertex: vertices with the same number get the same normal. Empty: each
/// vertex is its own point. Points of degenerate faces only get +z.
pub fn smooth_normals(mesh: &mut Mesh, points: &[u32]) {
    let point_of = |v: u32| if points.is_empty() { v as usize } else { points[v as usize] as usize };
    let count = (0..mesh.positions.len() as u32).map(|v| point_of(v) + 1).max().unwrap_or(0);
    let mut sums = vec![Vec3::ZERO; count];
    for t in &mesh.triangles {
        let p = t.map(|v| mesh.positions[v as usize]);
        let Some(n) = face_normal(p) else { continue };
        for i in 0..3 {
            sums[point_of(t[i])] += n * corner_angle(p, i);
        }
    }
    mesh.normals =
        (0..mesh.positions.len() as u32).map(|v| sums[point_of(v)].try_normalize().unwrap_or(Vec3::Z)).collect();
}

/// Unit normal of a triangle; none where it is degenerate.
pub fn face_normal(p: [Vec3; 3]) -> Option<Vec3> {
    (p[1] - p[0]).cross(p[2] - p[0]).try_normalize()
}

/// Angle of the triangle at its corner `i`, 0 where it has none.
fn corner_angle(p: [Vec3; 3], i: usize) -> f32 {
    let (a, b) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
    let scale = a.length() * b.length();
    if scale > 0.0 && scale.is_finite() { libm::acosf((a.dot(b) / scale).clamp(-1.0, 1.0)) } else { 0.0 }
}
