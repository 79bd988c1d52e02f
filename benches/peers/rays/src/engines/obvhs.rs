//! obvhs: a compressed eight-wide tree in Rust alone, its preset for the fastest traversal.

use super::Engine;
use crate::Arguments;
use crate::meshes::Mesh;
use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::ray::{Ray as TheirRay, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use photinus_geometry::{Hit, Ray, Vec3};
use std::time::Duration;

struct Obvhs {
    tree: CwBvh,
    /// In the order of the tree.
    triangles: Vec<RtTriangle>,
}

fn vector(v: Vec3) -> Vec3A {
    Vec3A::new(v.x, v.y, v.z)
}

/// Builds the tree.
pub fn build(mesh: &Mesh, _: &Arguments) -> Result<Box<dyn Engine>, String> {
    let triangle = |i| {
        let [v0, v1, v2] = mesh.primitives.triangle(i).map(vector);
        Triangle { v0, v1, v2 }
    };
    let triangles: Vec<Triangle> = (0..mesh.primitives.triangle_count()).map(triangle).collect();
    let tree = build_cwbvh_from_tris(&triangles, BvhBuildParams::very_slow_build(), &mut Duration::default());
    let triangles = tree.primitive_indices.iter().map(|i| RtTriangle::from(&triangles[*i as usize])).collect();
    Ok(Box::new(Obvhs { tree, triangles }))
}

impl Engine for Obvhs {
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (ray, hit) in rays.iter().zip(hits) {
            let mut found = RayHit::none();
            let theirs = TheirRay::new(vector(ray.origin), vector(ray.dir), ray.t_min, ray.t_max);
            let any = self.tree.ray_traverse(theirs, &mut found, |ray, id| self.triangles[id].intersect(ray));
            *hit = Hit::MISS;
            if any {
                hit.t = found.t;
                hit.prim = self.tree.primitive_indices[found.primitive_id as usize];
            }
        }
    }

    fn any(&self, rays: &[Ray], occluded: &mut [bool]) -> bool {
        for (ray, occluded) in rays.iter().zip(occluded) {
            let theirs = TheirRay::new(vector(ray.origin), vector(ray.dir), ray.t_min, ray.t_max);
            *occluded = !self.tree.ray_traverse_miss(theirs, |ray, id| self.triangles[id].intersect(ray));
        }
        true
    }
}
