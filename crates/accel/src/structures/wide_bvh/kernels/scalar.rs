//! Plain Rust: the twin that the other kernels are tested against.

use super::sixteen::scalar::Plain;
use super::{Kernel, Lanes, Reach};
use crate::structures::wide_bvh::beam::{Beam, BeamSlots};
use crate::structures::wide_bvh::layout::{Child, Node, TriangleBlock, WIDTH};
use crate::structures::wide_bvh::packet::{PACKET, Packet};
use crate::structures::wide_bvh::ray_setup::RaySetup;
use photinus_geometry::Ray;
use photinus_intersect::doubles;

/// The kernel.
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
    type Sixteen = Plain;
    type Four = doubles::Lanes<4>;

    #[inline(always)]
    fn node(self, ray: &RaySetup, node: &Node, t_max: f32, out: Lanes<'_>) -> usize {
        let mut entries = [ray.t_min; WIDTH];
        let mut exits = [t_max; WIDTH];
        for axis in 0..3 {
            let near = &node.bounds[ray.near[axis] as usize / WIDTH];
            let far = &node.bounds[ray.far[axis] as usize / WIDTH];
            for lane in 0..WIDTH {
                entries[lane] = max((near[lane] - ray.near_origin[axis]) * ray.near_inv[axis], entries[lane]);
                exits[lane] = min((far[lane] - ray.far_origin[axis]) * ray.far_inv[axis], exits[lane]);
            }
        }
        let order = node.orders[ray.octant % 8];
        let mut count = 0;
        for i in 0..WIDTH {
            let lane = (order >> (3 * i)) as usize % WIDTH;
            // Written always and kept where it is entered: a branch would be guessed wrong too often.
            out.entries[count % WIDTH] = entries[lane];
            out.children[count % WIDTH] = node.children[lane];
            count += usize::from(entries[lane] <= exits[lane]);
        }
        count
    }

    #[inline(always)]
    fn block(self, ray: &RaySetup, reach: &Reach, block: &TriangleBlock) -> u32 {
        let [kx, ky, kz] = ray.woop.axes;
        let (mut x, mut y, mut z) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        for v in 0..3 {
            for lane in 0..WIDTH {
                z[v][lane] = block.vertices[3 * v + kz][lane] - ray.woop.origin[kz];
                x[v][lane] = block.vertices[3 * v + kx][lane] - ray.woop.origin[kx] - ray.woop.shear[0] * z[v][lane];
                y[v][lane] = block.vertices[3 * v + ky][lane] - ray.woop.origin[ky] - ray.woop.shear[1] * z[v][lane];
            }
        }
        let mut mask = 0;
        for lane in 0..WIDTH {
            let edge = |i: usize, j: usize| x[i][lane] * y[j][lane] - y[i][lane] * x[j][lane];
            let (u, v, w) = (edge(2, 1), edge(0, 2), edge(1, 0));
            let negative = u < 0.0 || v < 0.0 || w < 0.0;
            let positive = u > 0.0 || v > 0.0 || w > 0.0;
            let least = min(min(z[0][lane], z[1][lane]), z[2][lane]);
            let most = max(max(z[0][lane], z[1][lane]), z[2][lane]);
            let beyond = least > reach.high || most < reach.low;
            // Lanes without a triangle hold no numbers.
            let used = least <= most;
            mask |= u32::from(used && !beyond && !(negative && positive)) << lane;
        }
        mask
    }

    #[inline(always)]
    fn keep(self, from: Lanes<'_>, t_max: f32) -> ([f32; WIDTH], [Child; WIDTH], u8) {
        let (mut entries, mut children) = ([0.0; WIDTH], [Child::END; WIDTH]);
        let (mut mask, mut count) = (0, 0);
        for lane in 0..WIDTH {
            entries[count % WIDTH] = from.entries[lane];
            children[count % WIDTH] = from.children[lane];
            let is_kept = from.entries[lane] <= t_max;
            mask |= u8::from(is_kept) << lane;
            count += usize::from(is_kept);
        }
        (entries, children, mask)
    }

    #[inline(always)]
    fn beam(self, beam: &Beam, node: &Node, out: &mut BeamSlots) -> usize {
        let mut entries = [beam.start; WIDTH];
        let mut exits = [beam.end; WIDTH];
        for axis in 0..3 {
            let near = &node.bounds[beam.near[axis] as usize / WIDTH];
            let far = &node.bounds[beam.far[axis] as usize / WIDTH];
            let ([near_a, near_b], [far_a, far_b]) = (beam.near_inv[axis], beam.far_inv[axis]);
            for lane in 0..WIDTH {
                let (enter, leave) = (near[lane] - beam.near_origin[axis], far[lane] - beam.far_origin[axis]);
                entries[lane] = max(min(enter * near_a, enter * near_b), entries[lane]);
                exits[lane] = min(max(leave * far_a, leave * far_b), exits[lane]);
            }
        }
        let order = node.orders[beam.octant % 8];
        let mut count = 0;
        for i in 0..WIDTH {
            let lane = (order >> (3 * i)) as usize % WIDTH;
            out.slots[count % WIDTH] = lane as u32;
            out.entries[count % WIDTH] = entries[lane];
            count += usize::from(entries[lane] <= exits[lane]);
        }
        count
    }

    #[inline(always)]
    fn packet_block(self, packet: &Packet, block: &TriangleBlock) -> u32 {
        let ([kx, ky, kz], bounds) = (packet.axes, &packet.bounds);
        (0..WIDTH).fold(0, |mask, lane| {
            let from = |v: usize, k: usize| {
                let [least, most] = bounds.origin[k];
                [block.vertices[3 * v + k][lane] - most, block.vertices[3 * v + k][lane] - least]
            };
            let vertex = |v: usize| {
                let z = from(v, kz);
                let sheared = |k: usize, i: usize| {
                    let [[a, b], [c, d]] = bounds.shear[i].map(|s| z.map(|z| s * z));
                    let x = from(v, k);
                    [x[0] - max(max(a, b), max(c, d)), x[1] - min(min(a, b), min(c, d))]
                };
                [sheared(kx, 0), sheared(ky, 1), z]
            };
            let v = [vertex(0), vertex(1), vertex(2)];
            let beside = (0..2).any(|k| v.iter().all(|v| v[k][0] > 0.0) || v.iter().all(|v| v[k][1] < 0.0));
            let beyond = v.iter().all(|v| v[2][0] > packet.reach[1]) || v.iter().all(|v| v[2][1] < packet.reach[0]);
            let used = !block.vertices[0][lane].is_nan();
            mask | u32::from(used && !beside && !beyond) << lane
        })
    }

    #[inline(always)]
    fn zeros(self) -> Plain {
        Plain([0.0; PACKET])
    }

    #[inline(always)]
    fn four(self) -> doubles::Lanes<4> {
        doubles::Lanes([0.0; 4])
    }

    #[inline(always)]
    fn components(self, rays: &[Ray; PACKET]) -> [Plain; 8] {
        let of = |get: fn(&Ray) -> f32| Plain(rays.each_ref().map(get));
        [
            of(|ray| ray.origin.x),
            of(|ray| ray.origin.y),
            of(|ray| ray.origin.z),
            of(|ray| ray.t_min),
            of(|ray| ray.dir.x),
            of(|ray| ray.dir.y),
            of(|ray| ray.dir.z),
            of(|ray| ray.t_max),
        ]
    }

    #[inline(always)]
    fn prefetch(self, _start: *const u8, _lines: usize) {}
}
