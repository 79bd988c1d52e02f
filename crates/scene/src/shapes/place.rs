//! Meshes moved by an affine map.

use crate::Mesh;
use glam::{DAffine3, DMat3};
use photinus_geometry::Vec3;

/// Moves a mesh; a map that mirrors keeps its outside outside. `flip_normals` then turns it inside out.
///
/// Normals go with the cofactor matrix, which is defined where the map flattens the mesh, too. A map that changes
/// nothing changes no bit.
pub fn place_mesh(mesh: &mut Mesh, map: &DAffine3, flip_normals: bool) {
    let m = &map.matrix3;
    let mirrors = m.determinant() < 0.0;
    if *map != DAffine3::IDENTITY {
        for p in &mut mesh.positions {
            *p = map.transform_point3(p.as_dvec3()).as_vec3();
        }
        let sign = if mirrors { -1.0 } else { 1.0 };
        let cofactors = DMat3::from_cols(
            m.y_axis.cross(m.z_axis) * sign,
            m.z_axis.cross(m.x_axis) * sign,
            m.x_axis.cross(m.y_axis) * sign,
        );
        for n in &mut mesh.normals {
            let moved = cofactors * n.as_dvec3();
            *n = moved.try_normalize().unwrap_or_default().as_vec3();
        }
    }
    if flip_normals {
        for n in &mut mesh.normals {
            *n = -*n;
        }
    }
    if mirrors != flip_normals {
        for t in &mut mesh.triangles {
            t.swap(1, 2);
        }
    }
    replace_lost_normals(mesh);
}

/// Normals that a map without inverse takes away: the mean of the faces', or any where these have no area left.
fn replace_lost_normals(mesh: &mut Mesh) {
    if mesh.normals.iter().all(|n| *n != Vec3::ZERO) {
        return;
    }
    let mut means = vec![Vec3::ZERO; mesh.normals.len()];
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
        let face = (b - a).cross(c - a).try_normalize().unwrap_or_default();
        t.iter().for_each(|&v| means[v as usize] += face);
    }
    for (n, mean) in mesh.normals.iter_mut().zip(means) {
        if *n == Vec3::ZERO {
            *n = mean.try_normalize().unwrap_or(Vec3::Z);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{cube, sphere_mesh};
    use glam::DVec3;
    use photinus_geometry::Sphere;

    /// Twice the signed volume: positive where the faces look outwards.
    fn volume(mesh: &Mesh) -> f32 {
        let corner = |v: u32| mesh.positions[v as usize];
        mesh.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])))).sum()
    }

    #[test]
    fn flattened_meshes_keep_unit_normals() {
        for scale in [DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 1.0), DVec3::new(0.0, 0.0, 1.0), DVec3::ZERO] {
            let ball = sphere_mesh(Sphere { center: Vec3::ZERO, radius: 1.0 }, [Vec3::X, Vec3::Y, Vec3::Z], false, 16);
            for mut mesh in [cube(), ball] {
                place_mesh(&mut mesh, &DAffine3::from_scale(scale), false);
                assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5), "{scale}");
            }
        }
    }

    #[test]
    fn mirrors_keep_the_outside_outside_and_flips_turn_it() {
        for scale in [DVec3::new(2.0, 1.0, 0.5), DVec3::new(-2.0, 1.0, 0.5), DVec3::new(-1.0, -1.0, -3.0)] {
            for flip in [false, true] {
                let mut mesh = cube();
                place_mesh(&mut mesh, &DAffine3::from_scale(scale), flip);
                assert_eq!(volume(&mesh) > 0.0, !flip, "{scale} {flip}");
            }
        }
    }

    #[test]
    fn normals_stay_perpendicular_under_a_shear() {
        let mut map = DAffine3::from_scale(DVec3::new(3.0, 0.2, -1.0));
        map.matrix3.y_axis.x = 1.5;
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        let mut mesh = sphere_mesh(Sphere { center: Vec3::ZERO, radius: 1.0 }, axes, false, 64);
        place_mesh(&mut mesh, &map, false);
        for t in &mesh.triangles {
            let p = t.map(|v| mesh.positions[v as usize]);
            let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize();
            for v in t {
                let n = mesh.normals[*v as usize];
                assert!((n.length() - 1.0).abs() < 1e-5 && n.dot(face) > 0.5, "{n} {face}");
            }
        }
    }

    #[test]
    fn flattening_maps_give_finite_normals() {
        let mut mesh = sphere_mesh(Sphere { center: Vec3::ZERO, radius: 1.0 }, [Vec3::X, Vec3::Y, Vec3::Z], false, 16);
        place_mesh(&mut mesh, &DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0)), false);
        assert!(mesh.normals.iter().all(|n| n.is_finite()));
    }
}
