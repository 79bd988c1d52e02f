//! Shading normals made from faces, as Mitsuba makes them.

use crate::Mesh;
use photinus_geometry::Vec3;

/// Gives every vertex the mean of its faces' normals, weighted by the angle at the vertex (Thürmer and Wüthrich,
/// "Computing vertex normals from polygonal facets", JGT 3(1), 1998). Vertices of degenerate faces only get +z.
pub fn smooth_normals(mesh: &mut Mesh) {
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for t in &mesh.triangles {
        let p = t.map(|v| mesh.positions[v as usize]);
        let n = (p[1] - p[0]).cross(p[2] - p[0]);
        let length = n.length();
        if !(length > 0.0) || !length.is_finite() {
            continue;
        }
        let n = n / length;
        for i in 0..3 {
            let (a, b) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
            let scale = a.length() * b.length();
            if scale > 0.0 && scale.is_finite() {
                let cosine = (a.dot(b) / scale).clamp(-1.0, 1.0);
                sums[t[i] as usize] += n * libm::acosf(cosine);
            }
        }
    }
    mesh.normals = sums.into_iter().map(|n| n.try_normalize().unwrap_or(Vec3::Z)).collect();
}
