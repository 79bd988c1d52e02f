//! Rays from inside of closed meshes at their vertices and edges: how many hit nothing.

use crate::Figure;
use crate::common::{closed_mesh, randoms};
use photinus_geometry::{Hit, Primitives, Ray, Vec3};
use photinus_intersect::MethodInfo;

/// A box of exact coordinates, eight squares along each edge of it, every triangle beginning at a vertex of chance.
fn exact_box(seed: u64) -> Primitives {
    const N: u32 = 8;
    let mut mesh = Primitives::default();
    for side in 0..6 {
        let base = mesh.positions.len() as u32;
        for (i, j) in (0..=N).flat_map(|j| (0..=N).map(move |i| (i, j))) {
            let at = |k: u32| k as f32 / 4.0 - 1.0;
            let mut p = [at(i), at(j), if side < 3 { -1.0 } else { 1.0 }];
            p.rotate_right(side as usize % 3);
            mesh.positions.push(Vec3::from(p));
        }
        for (i, j) in (0..N).flat_map(|j| (0..N).map(move |i| (i, j))) {
            let a = base + (N + 1) * j + i;
            for mut triangle in [[a, a + 1, a + N + 2], [a, a + N + 2, a + N + 1]] {
                let turn = randoms::<1>(seed, mesh.triangles.len() as u32)[0] * 1.5 + 1.5;
                triangle.rotate_left(turn as usize);
                mesh.triangles.push(triangle);
            }
        }
    }
    mesh
}

/// Rays along an axis from the middle of the box that meet edges and vertices exactly.
fn exact_rays(mesh: &Primitives) -> Vec<Ray> {
    let mut rays = Vec::new();
    for triangle in 0..mesh.triangle_count() {
        let [a, b, c] = mesh.triangle(triangle);
        for target in [a, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5] {
            for axis in Vec3::AXES.into_iter().filter(|axis| target.dot(*axis).abs() == 1.0) {
                rays.push(Ray::new(target - axis * target.dot(axis), axis * target.dot(axis)));
            }
        }
    }
    rays
}

/// Rays from inside of a bumpy ball at its vertices and at points of its edges.
fn ball_rays(mesh: &Primitives, offset: Vec3, size: f32, seed: u64) -> Vec<Ray> {
    let mut targets = mesh.positions.clone();
    for i in 0..mesh.triangle_count() {
        let [a, b, c] = mesh.triangle(i);
        targets.extend([(a + b) * 0.5, (b + c) * 0.5, a + (c - a) * 0.3]);
    }
    let mut rays = Vec::new();
    for (i, target) in targets.iter().enumerate() {
        for k in 0..8 {
            let [x, y, z] = randoms::<3>(seed, (8 * i + k) as u32).map(|x| x as f32);
            let inside = offset + Vec3::new(x, y, z) * size * 0.2;
            rays.push(Ray::new(inside, *target - inside));
        }
    }
    rays
}

/// Leaks through the box, and through the ball in three places.
pub fn count(method: &MethodInfo, seed: u64) -> Vec<Figure> {
    let through = |mesh: &Primitives, rays: &[Ray]| {
        let tester = (method.leaf_tester)(mesh);
        let ids: Vec<u32> = (0..mesh.triangle_count() as u32).collect();
        let leaks = rays.iter().filter(|ray| {
            let mut hit = Hit::MISS;
            tester.closest_hit(ray, &ids, &mut hit);
            !hit.is_hit()
        });
        leaks.count() as f64
    };
    let mesh = exact_box(seed);
    let rays = exact_rays(&mesh);
    let mut figures = vec![(format!("leaks of {} rays: exact box", rays.len()), through(&mesh, &rays))];
    for (name, offset, size) in
        [("ball", Vec3::ZERO, 1.0), ("ball at 1000", Vec3::splat(1e3), 1.0), ("ball at 1e6", Vec3::splat(1e6), 100.0)]
    {
        let mesh = closed_mesh(offset, size);
        let rays = ball_rays(&mesh, offset, size, seed);
        figures.push((format!("leaks of {} rays: {name}", rays.len()), through(&mesh, &rays)));
    }
    figures
}
