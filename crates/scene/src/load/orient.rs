//! Which side of a face is outside: decided by vertex normals, or for closed bodies by their volume.

use super::weld::weld;
use crate::Mesh;

/// Turns faces over whose vertex normals all lie on the other side, and returns how many those were.
///
/// Light leaves and glass begins on the face's side; where winding and normals disagree the normals are what the
/// modeller saw.
pub(super) fn face_along_normals(mesh: &mut Mesh) -> usize {
    if mesh.normals.is_empty() {
        return 0;
    }
    let mut turned = 0;
    for t in &mut mesh.triangles {
        let p = t.map(|v| mesh.positions[v as usize]);
        let face = (p[1] - p[0]).cross(p[2] - p[0]);
        if t.iter().all(|&v| face.dot(mesh.normals[v as usize]) < 0.0) {
            t.swap(1, 2);
            turned += 1;
        }
    }
    turned
}

/// Turns a closed mesh inside out where it encloses a negative volume, normals included, and says whether it did.
///
/// Hollow bodies keep their inner walls turned to the hollow: the whole counts, not its parts.
pub(super) fn face_outwards(mesh: &mut Mesh) -> bool {
    if mesh.triangles.is_empty() || !is_closed(mesh) || signed_volume(mesh) >= 0.0 {
        return false;
    }
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    mesh.normals.iter_mut().for_each(|n| *n = -*n);
    true
}

/// Whether every edge is used as often in one direction as in the other.
fn is_closed(mesh: &Mesh) -> bool {
    let points = weld(&mesh.positions).ids;
    let mut edges: Vec<(u32, u32, i32)> = Vec::with_capacity(3 * mesh.triangles.len());
    for t in &mesh.triangles {
        let t = t.map(|v| points[v as usize]);
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            edges.push((a.min(b), a.max(b), if a < b { 1 } else { -1 }));
        }
    }
    edges.retain(|e| e.0 != e.1);
    edges.sort_unstable();
    edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)).all(|same| same.iter().map(|e| e.2).sum::<i32>() == 0)
}

/// Six times the enclosed volume, positive where faces point outwards (divergence theorem).
fn signed_volume(mesh: &Mesh) -> f64 {
    let origin = mesh.positions[0];
    let at = |v: u32| -> [f64; 3] { (mesh.positions[v as usize] - origin).to_array().map(f64::from) };
    let mut volume = 0.0;
    for &[a, b, c] in &mesh.triangles {
        let (a, b, c) = (at(a), at(b), at(c));
        volume += a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    volume
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;

    fn tetrahedron() -> Mesh {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        Mesh { positions, triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], ..Mesh::default() }
    }

    #[test]
    fn closed_bodies_face_outwards() {
        let good = tetrahedron();
        assert!(!face_outwards(&mut good.clone()));
        let mut inverted = good.clone();
        inverted.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        inverted.normals = vec![Vec3::X; 4];
        assert!(face_outwards(&mut inverted));
        assert_eq!((inverted.triangles, inverted.normals[0]), (good.triangles.clone(), Vec3::NEG_X));
        let mut open = good.clone();
        open.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        open.triangles.pop();
        assert!(!face_outwards(&mut open), "an open surface has no outside");
        // A smaller, inverted body inside is a hollow.
        let mut hollow = good.clone();
        hollow.positions.extend(good.positions.iter().map(|p| *p * 0.5 + 0.1));
        hollow.triangles.extend(good.triangles.iter().map(|t| [t[0] + 4, t[2] + 4, t[1] + 4]));
        assert!(!face_outwards(&mut hollow));
    }

    #[test]
    fn faces_follow_their_normals() {
        let mut mesh = tetrahedron();
        assert_eq!(face_along_normals(&mut mesh), 0);
        mesh.normals = mesh.positions.iter().map(|p| Vec3::splat(0.25) - *p).collect();
        assert_eq!(face_along_normals(&mut mesh), 4);
        assert_eq!(mesh.triangles[0], [0, 1, 2]);
        // Where only some normals disagree, the face stays.
        mesh.normals[0] = -mesh.normals[0];
        assert_eq!(face_along_normals(&mut mesh), 0);
    }
}
