//! The two tests of the hot loop, eight lanes wide, once per instruction set.
//!
//! Both are filters: a box may be entered in vain, a triangle that passes is finished in doubles by
//! [`photinus_intersect::methods::woop::finish`]. What they let through of the hits is everything, so the results do
//! not depend on the kernel.

use super::layout::{Node, TriangleBlock, WIDTH};
use super::ray_setup::RaySetup;

/// A kernel: the tests of one instruction set.
pub trait Kernel: Copy {
    /// Boxes of `node` that the ray may enter at a parameter up to `t_max`, as a mask of lanes, with the entry
    /// parameters of all lanes in `entries`.
    fn node(self, ray: &RaySetup, node: &Node, t_max: f32, entries: &mut [f32; WIDTH]) -> u32;

    /// Triangles of `block` that the ray may hit, as a mask of lanes.
    fn block(self, ray: &RaySetup, block: &TriangleBlock) -> u32;
}

/// Plain Rust: the twin that the others are tested against.
#[derive(Clone, Copy)]
pub struct Scalar;

/// The larger; `b` where `a` is not a number.
#[inline(always)]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller; `b` where `a` is not a number.
#[inline(always)]
fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

impl Kernel for Scalar {
    #[inline(always)]
    fn node(self, ray: &RaySetup, node: &Node, t_max: f32, entries: &mut [f32; WIDTH]) -> u32 {
        *entries = [ray.t_min; WIDTH];
        let mut exits = [t_max; WIDTH];
        for axis in 0..3 {
            let near = &node.bounds[ray.near_plane[axis]];
            let far = &node.bounds[ray.near_plane[axis] ^ 1];
            for lane in 0..WIDTH {
                entries[lane] = max((near[lane] - ray.near_origin[axis]) * ray.near_inv[axis], entries[lane]);
                exits[lane] = min((far[lane] - ray.far_origin[axis]) * ray.far_inv[axis], exits[lane]);
            }
        }
        (0..WIDTH).fold(0, |mask, lane| mask | u32::from(entries[lane] <= exits[lane]) << lane)
    }

    #[inline(always)]
    fn block(self, ray: &RaySetup, block: &TriangleBlock) -> u32 {
        let [kx, ky, kz] = ray.woop.axes;
        let (mut x, mut y) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        for v in 0..3 {
            for lane in 0..WIDTH {
                let z = block.vertices[3 * v + kz][lane] - ray.woop.origin[kz];
                x[v][lane] = block.vertices[3 * v + kx][lane] - ray.woop.origin[kx] - ray.woop.shear[0] * z;
                y[v][lane] = block.vertices[3 * v + ky][lane] - ray.woop.origin[ky] - ray.woop.shear[1] * z;
            }
        }
        let mut mask = 0;
        for lane in 0..WIDTH {
            let edge = |i: usize, j: usize| x[i][lane] * y[j][lane] - y[i][lane] * x[j][lane];
            let (u, v, w) = (edge(2, 1), edge(0, 2), edge(1, 0));
            let negative = u < 0.0 || v < 0.0 || w < 0.0;
            let positive = u > 0.0 || v > 0.0 || w > 0.0;
            mask |= u32::from(!(negative && positive)) << lane;
        }
        mask
    }
}
