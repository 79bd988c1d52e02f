//! What the kernels with registers of eight lanes share: tests of a packet's beam, and rays by component.

use crate::structures::wide_bvh::beam::Beam;
use crate::structures::wide_bvh::layout::{Node, TriangleBlock, WIDTH};
use crate::structures::wide_bvh::packet::Packet;
use photinus_geometry::Ray;
use std::arch::x86_64::*;

/// Where the beam enters and leaves the boxes of a node, and which slots they are, all from far to near.
///
/// # Safety
///
/// The machine must have AVX2.
#[inline(always)]
pub unsafe fn beam(beam: &Beam, node: &Node) -> (__m256, __m256, __m256i) {
    // SAFETY: as the caller promises; the loads are of eight words each, and `near` and `far` are places of bounds below 6 x 8.
    unsafe {
        let spread = |x: f32| _mm256_set1_ps(x);
        let bounds = node.bounds.as_ptr().cast::<f32>();
        let mut entry = spread(beam.start);
        let mut exit = spread(beam.end);
        for axis in 0..3 {
            let near = _mm256_loadu_ps(bounds.add(beam.near[axis] as usize));
            let far = _mm256_loadu_ps(bounds.add(beam.far[axis] as usize));
            let enter = _mm256_sub_ps(near, spread(beam.near_origin[axis]));
            let leave = _mm256_sub_ps(far, spread(beam.far_origin[axis]));
            let ([a, b], [c, d]) = (beam.near_inv[axis], beam.far_inv[axis]);
            let (a, b) = (_mm256_mul_ps(enter, spread(a)), _mm256_mul_ps(enter, spread(b)));
            let (c, d) = (_mm256_mul_ps(leave, spread(c)), _mm256_mul_ps(leave, spread(d)));
            entry = _mm256_max_ps(_mm256_min_ps(a, b), entry);
            exit = _mm256_min_ps(_mm256_max_ps(c, d), exit);
        }
        // The order of slots, each index in its own lane; the permutations look at the lowest three bits.
        let order = _mm256_set1_epi32(node.orders[beam.octant % 8] as i32);
        let order = _mm256_srlv_epi32(order, _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21));
        (_mm256_permutevar8x32_ps(entry, order), _mm256_permutevar8x32_ps(exit, order), order)
    }
}

/// See [`Kernel::packet_block`](super::Kernel::packet_block).
///
/// # Safety
///
/// The machine must have AVX2.
#[inline(always)]
pub unsafe fn packet_block(packet: &Packet, block: &TriangleBlock) -> u32 {
    // SAFETY: as the caller promises; the loads are of eight words each, and axes are below 3.
    unsafe {
        let spread = |x: f32| _mm256_set1_ps(x);
        let [kx, ky, kz] = packet.axes;
        let axes = [kx % 3, ky % 3, kz % 3];
        let vertices = block.vertices.as_ptr().cast::<f32>();
        let zero = _mm256_setzero_ps();
        let every = _mm256_castsi256_ps(_mm256_set1_epi32(-1));
        let (mut above, mut below) = ([every; 2], [every; 2]);
        let (mut beyond, mut before) = (every, every);
        for v in 0..3 {
            // Differences to the greatest and the least start.
            let from = |k: usize| {
                let at = _mm256_loadu_ps(vertices.add((3 * v + axes[k]) * WIDTH));
                let [low, high] = packet.bounds.origin[axes[k]];
                (_mm256_sub_ps(at, spread(high)), _mm256_sub_ps(at, spread(low)))
            };
            let (z_low, z_high) = from(2);
            beyond = _mm256_and_ps(beyond, _mm256_cmp_ps::<_CMP_GT_OQ>(z_low, spread(packet.reach[1])));
            before = _mm256_and_ps(before, _mm256_cmp_ps::<_CMP_LT_OQ>(z_high, spread(packet.reach[0])));
            for k in 0..2 {
                let (low, high) = from(k);
                let [s, t] = packet.bounds.shear[k];
                let (a, b) = (_mm256_mul_ps(spread(s), z_low), _mm256_mul_ps(spread(s), z_high));
                let (c, d) = (_mm256_mul_ps(spread(t), z_low), _mm256_mul_ps(spread(t), z_high));
                let least = _mm256_min_ps(_mm256_min_ps(a, b), _mm256_min_ps(c, d));
                let most = _mm256_max_ps(_mm256_max_ps(a, b), _mm256_max_ps(c, d));
                let (least, most) = (_mm256_sub_ps(low, most), _mm256_sub_ps(high, least));
                above[k] = _mm256_and_ps(above[k], _mm256_cmp_ps::<_CMP_GT_OQ>(least, zero));
                below[k] = _mm256_and_ps(below[k], _mm256_cmp_ps::<_CMP_LT_OQ>(most, zero));
            }
        }
        let beside = _mm256_or_ps(_mm256_or_ps(above[0], above[1]), _mm256_or_ps(below[0], below[1]));
        // Lanes without a triangle hold no numbers.
        let first = _mm256_loadu_ps(vertices);
        let unused = _mm256_cmp_ps::<_CMP_UNORD_Q>(first, first);
        let out = _mm256_or_ps(_mm256_or_ps(beside, unused), _mm256_or_ps(beyond, before));
        !_mm256_movemask_ps(out) as u32 & 0xFF
    }
}

/// Components of eight rays by ray: eight rows of eight, turned over their diagonal.
///
/// # Safety
///
/// The machine must have AVX2, and `rays` must be eight.
#[inline(always)]
pub unsafe fn components(rays: &[Ray]) -> [__m256; 8] {
    const { assert!(size_of::<Ray>() == 8 * size_of::<f32>()) }
    // SAFETY: as the caller promises; a ray is eight numbers without gaps.
    unsafe {
        let ray = |i: usize| _mm256_loadu_ps(rays.as_ptr().add(i).cast());
        // Pairs of rays, then fours, then all eight.
        let zero = _mm256_setzero_ps();
        let mut pairs = [zero; 8];
        for i in [0, 2, 4, 6] {
            (pairs[i], pairs[i + 1]) = (_mm256_unpacklo_ps(ray(i), ray(i + 1)), _mm256_unpackhi_ps(ray(i), ray(i + 1)));
        }
        let mut fours = [zero; 8];
        for (i, half) in [(0, 0), (2, 1), (4, 4), (6, 5)] {
            fours[i] = _mm256_shuffle_ps::<0x44>(pairs[half], pairs[half + 2]);
            fours[i + 1] = _mm256_shuffle_ps::<0xEE>(pairs[half], pairs[half + 2]);
        }
        let mut all = [zero; 8];
        for i in 0..4 {
            all[i] = _mm256_permute2f128_ps::<0x20>(fours[i], fours[i + 4]);
            all[i + 4] = _mm256_permute2f128_ps::<0x31>(fours[i], fours[i + 4]);
        }
        all
    }
}
