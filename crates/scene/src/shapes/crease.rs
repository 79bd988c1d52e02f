//! Normals that are smooth across flat edges and sharp across steep ones.

use crate::Mesh;
use photinus_geometry::Vec3;
use std::collections::HashMap;

/// Faces around one point beyond which its corners stay flat: the work grows with their square.
const MAX_FACES_PER_POINT: usize = 512;

/// Replaces the normals: at each corner, the mean of the normals of those faces around the same point that are within
/// `max_degrees` of the corner's own face, weighted by area. Vertices are split where corners differ.
pub fn crease_normals(mesh: &mut Mesh, max_degrees: f32) {
    let min_cosine = libm::cosf(max_degrees.clamp(0.0, 180.0).to_radians());
    let faces: Vec<Vec3> = mesh
        .triangles
        .iter()
        .map(|t| {
            let p = t.map(|v| mesh.positions[v as usize]);
            (p[1] - p[0]).cross(p[2] - p[0])
        })
        .collect();
    // Points are told apart by the bits of their position; -0 counts as 0.
    let mut point_ids: HashMap<[u32; 3], u32> = HashMap::new();
    let mut around: Vec<Vec<u32>> = Vec::new();
    let point_of: Vec<u32> = mesh
        .positions
        .iter()
        .map(|p| {
            let key = (*p + Vec3::ZERO).to_array().map(f32::to_bits);
            *point_ids.entry(key).or_insert_with(|| {
                around.push(Vec::new());
                around.len() as u32 - 1
            })
        })
        .collect();
    for (f, t) in mesh.triangles.iter().enumerate() {
        for &v in t {
            around[point_of[v as usize] as usize].push(f as u32);
        }
    }
    let mut split: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    let old = std::mem::take(mesh);
    for (f, t) in old.triangles.iter().enumerate() {
        let own = faces[f].normalize_or_zero();
        let corners = t.map(|v| {
            let near = &around[point_of[v as usize] as usize];
            let mut sum = Vec3::ZERO;
            if near.len() <= MAX_FACES_PER_POINT {
                for &g in near {
                    let other = faces[g as usize];
                    if other.normalize_or_zero().dot(own) >= min_cosine {
                        sum += other;
                    }
                }
            }
            let normal = sum.try_normalize().or(own.try_normalize()).unwrap_or(Vec3::Z);
            *split.entry((v, normal.to_array().map(f32::to_bits))).or_insert_with(|| {
                let v = v as usize;
                mesh.positions.push(old.positions[v]);
                mesh.normals.push(normal);
                mesh.uvs.extend(old.uvs.get(v));
                mesh.colors.extend(old.colors.get(v));
                mesh.positions.len() as u32 - 1
            })
        });
        mesh.triangles.push(corners);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{cube, sphere_mesh};
    use photinus_geometry::Sphere;

    #[test]
    fn a_cube_stays_sharp_and_a_sphere_becomes_smooth() {
        let mut sharp = cube();
        crease_normals(&mut sharp, 30.0);
        assert_eq!(sharp.positions.len(), 24);
        for t in &sharp.triangles {
            let p = t.map(|v| sharp.positions[v as usize]);
            let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize();
            assert!(t.iter().all(|&v| sharp.normals[v as usize].dot(face) > 0.9999));
        }
        let mut round = sphere_mesh(Sphere { center: Vec3::ZERO, radius: 2.0 }, [Vec3::X, Vec3::Y, Vec3::Z], false, 64);
        round.normals.clear();
        crease_normals(&mut round, 30.0);
        for (p, n) in round.positions.iter().zip(&round.normals) {
            assert!(p.normalize().dot(*n) > 0.995, "{p} {n}");
        }
    }
}
