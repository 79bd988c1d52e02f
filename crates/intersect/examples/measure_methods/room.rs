//! Nearest hits in a room along the axes with two spheres of triangles, against all triangles in doubles.

use crate::Figure;
use crate::common::{oracle, randoms};
use photinus_geometry::{Hit, Primitives, Ray, Vec3};
use photinus_intersect::MethodInfo;

const RAYS: u32 = 10_000;

/// The room with its rays and where they end.
pub struct Room {
    mesh: Primitives,
    rays: Vec<Ray>,
    /// The nearest t of each ray, in doubles.
    t: Vec<f64>,
}

impl Room {
    /// 1824 triangles: six walls of 16 squares, two spheres of 24 sectors in 18 rings.
    pub fn new(seed: u64) -> Self {
        let mut mesh = Primitives::default();
        for side in 0..6 {
            let wall = |i: u32, j: u32| {
                let at = |k: u32| k as f32 * 2.5 - 5.0;
                let mut p = [at(i), at(j), if side < 3 { -5.0 } else { 5.0 }];
                p.rotate_right(side as usize % 3);
                Vec3::from(p)
            };
            patch(&mut mesh, 4, 4, wall);
        }
        for (middle, radius) in [(Vec3::new(0.0, -3.0, 1.5), 2.0), (Vec3::new(2.5, -3.5, 0.0), 1.5)] {
            let ball = |i: u32, j: u32| {
                let (phi, theta) =
                    (f64::from(i) * std::f64::consts::TAU / 24.0, f64::from(j) * std::f64::consts::PI / 18.0);
                let [x, y, z] =
                    [libm::sin(theta) * libm::cos(phi), libm::cos(theta), libm::sin(theta) * libm::sin(phi)];
                middle + Vec3::new(x as f32, y as f32, z as f32) * radius
            };
            patch(&mut mesh, 24, 18, ball);
        }
        let vec3 = |i: u32| Vec3::from(randoms::<3>(seed, i).map(|x| x as f32));
        let rays: Vec<Ray> = (0..RAYS)
            .map(|i| Ray::new(Vec3::new(0.0, 2.0, 0.0) + vec3(2 * i) * 2.5, vec3(2 * i + 1).normalize()))
            .collect();
        let double = |v: Vec3| v.to_array().map(f64::from);
        let vertices: Vec<_> = (0..mesh.triangle_count()).map(|i| mesh.triangle(i).map(double)).collect();
        let nearest = |ray: &Ray| {
            let hits = vertices.iter().map(|v| oracle(double(ray.origin), double(ray.dir), *v));
            hits.filter(|([t, ..], least)| *least >= 0.0 && *t >= 0.0)
                .map(|([t, ..], _)| t)
                .fold(f64::INFINITY, f64::min)
        };
        let t = rays.iter().map(nearest).collect();
        Self { mesh, rays, t }
    }

    /// Rays that end elsewhere than in doubles.
    pub fn count(&self, method: &MethodInfo) -> Vec<Figure> {
        let tester = (method.leaf_tester)(&self.mesh);
        let ids: Vec<u32> = (0..self.mesh.triangle_count() as u32).collect();
        let wrong = self.rays.iter().zip(&self.t).filter(|(ray, t)| {
            let mut hit = Hit::MISS;
            tester.closest_hit(ray, &ids, &mut hit);
            // Not so written that an infinite difference passes.
            !((f64::from(hit.t) - **t).abs() <= 0.01)
        });
        vec![(format!("room of {} triangles: wrong of {RAYS} rays", self.mesh.triangle_count()), wrong.count() as f64)]
    }
}

/// A grid of points as triangles; those without extent, at the poles of a sphere, are left out.
fn patch(mesh: &mut Primitives, columns: u32, rows: u32, at: impl Fn(u32, u32) -> Vec3) {
    for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
        let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            let [p, q, r] = [corners[a], corners[b], corners[c]];
            if (p - q).length() > 1e-5 && (q - r).length() > 1e-5 && (r - p).length() > 1e-5 {
                let base = mesh.positions.len() as u32;
                mesh.positions.extend([p, q, r]);
                mesh.triangles.push([base, base + 1, base + 2]);
            }
        }
    }
}
