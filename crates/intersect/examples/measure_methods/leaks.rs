//! Rays from inside of closed meshes at their vertices and edges: how many hit nothing.

use crate::Figure;
use crate::common::{closed_mesh, exact_box, exact_rays, randoms};
use photinus_geometry::{Hit, Primitives, Ray, Vec3};
use photinus_intersect::MethodInfo;

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
