//! AVX2: eight lanes in one register.

use super::four::AvxFour;
use super::sixteen::avx2::Two;
use super::{Kernel, Lanes, Reach, SET_LANES, eight};
use crate::structure::RayCounters;
use crate::structures::wide_bvh::WideBvh;
use crate::structures::wide_bvh::beam::{Beam, BeamSlots};
use crate::structures::wide_bvh::layout::{Child, Node, TriangleBlock, WIDTH};
use crate::structures::wide_bvh::packet::{PACKET, Packet};
use crate::structures::wide_bvh::ray_setup::RaySetup;
use photinus_geometry::{Hit, Ray};
use std::arch::x86_64::*;

/// The kernel.
#[derive(Clone, Copy)]
pub struct Avx2(());

impl Avx2 {
    /// The kernel, where the machine can run it.
    pub fn detect() -> Option<Self> {
        let has = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("popcnt")
            && is_x86_feature_detected!("lzcnt");
        has.then_some(Self(()))
    }

    /// [`WideBvh::trace_packets`] and [`WideBvh::trace`] compiled for this instruction set.
    pub fn trace<const ANY: bool, const COUNT: bool>(
        self,
        tree: &WideBvh,
        rays: &[Ray],
        mut set: impl FnMut(usize, Hit),
        counters: &mut RayCounters,
    ) {
        // SAFETY: `self` proves that the machine has the features that the functions are compiled for.
        unsafe {
            let done = trace_packets::<ANY, COUNT>(self, tree, rays, &mut set, counters);
            trace::<ANY, COUNT>(self, tree, rays, done, set, counters);
        }
    }
}

#[target_feature(enable = "avx2,bmi1,bmi2,popcnt,lzcnt")]
fn trace_packets<const ANY: bool, const COUNT: bool>(
    kernel: Avx2,
    tree: &WideBvh,
    rays: &[Ray],
    set: &mut impl FnMut(usize, Hit),
    counters: &mut RayCounters,
) -> Vec<bool> {
    tree.trace_packets::<_, ANY, COUNT>(kernel, rays, set, counters)
}

#[target_feature(enable = "avx2,bmi1,bmi2,popcnt,lzcnt")]
fn trace<const ANY: bool, const COUNT: bool>(
    kernel: Avx2,
    tree: &WideBvh,
    rays: &[Ray],
    done: Vec<bool>,
    set: impl FnMut(usize, Hit),
    counters: &mut RayCounters,
) {
    tree.trace::<_, ANY, COUNT>(kernel, rays, done, set, counters);
}

impl Kernel for Avx2 {
    type Sixteen = Two;
    type Four = AvxFour;

    #[inline(always)]
    fn node(self, ray: &RaySetup, node: &Node, t_max: f32, out: Lanes<'_>) -> usize {
        // SAFETY: `self` proves that the machine has AVX2; the loads and stores are of eight words each, and
        // `near` and `far` are places of bounds below 6 x 8.
        unsafe {
            let spread = |x: f32| _mm256_set1_ps(x);
            let bounds = node.bounds.as_ptr().cast::<f32>();
            let mut entry = _mm256_set1_ps(ray.t_min);
            let mut exit = _mm256_set1_ps(t_max);
            for axis in 0..3 {
                let near = _mm256_loadu_ps(bounds.add(ray.near[axis] as usize));
                let far = _mm256_loadu_ps(bounds.add(ray.far[axis] as usize));
                let t_near =
                    _mm256_mul_ps(_mm256_sub_ps(near, spread(ray.near_origin[axis])), spread(ray.near_inv[axis]));
                let t_far = _mm256_mul_ps(_mm256_sub_ps(far, spread(ray.far_origin[axis])), spread(ray.far_inv[axis]));
                // The second operand is taken where the first is not a number.
                entry = _mm256_max_ps(t_near, entry);
                exit = _mm256_min_ps(t_far, exit);
            }
            // The order of slots, each index in its own lane; the permutations look at the lowest three bits.
            let order = _mm256_set1_epi32(node.orders[ray.octant % 8] as i32);
            let order = _mm256_srlv_epi32(order, _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21));
            let entry = _mm256_permutevar8x32_ps(entry, order);
            let exit = _mm256_permutevar8x32_ps(exit, order);
            let children = _mm256_loadu_si256(node.children.as_ptr().cast());
            let children = _mm256_permutevar8x32_epi32(children, order);
            let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(entry, exit)) as usize;
            let kept = _mm256_cvtepu8_epi32(_mm_loadl_epi64(SET_LANES[mask].as_ptr().cast()));
            _mm256_storeu_ps(out.entries.as_mut_ptr(), _mm256_permutevar8x32_ps(entry, kept));
            _mm256_storeu_si256(out.children.as_mut_ptr().cast(), _mm256_permutevar8x32_epi32(children, kept));
            mask.count_ones() as usize
        }
    }

    #[inline(always)]
    fn block(self, ray: &RaySetup, reach: &Reach, block: &TriangleBlock) -> u32 {
        // SAFETY: `self` proves that the machine has AVX2; the loads are of eight words each, and axes are below 3.
        unsafe {
            let [kx, ky, kz] = ray.woop.axes;
            let spread = |x: f32| _mm256_set1_ps(x);
            let origin = [spread(ray.woop.origin[kx]), spread(ray.woop.origin[ky]), spread(ray.woop.origin[kz])];
            let shear_by = [spread(ray.woop.shear[0]), spread(ray.woop.shear[1])];
            let vertices = block.vertices.as_ptr().cast::<f32>();
            let load = |v: usize, k: usize| _mm256_loadu_ps(vertices.add((3 * v + k) * WIDTH));
            let mut x = [_mm256_setzero_ps(); 3];
            let mut y = x;
            let mut z = x;
            for v in 0..3 {
                z[v] = _mm256_sub_ps(load(v, kz), origin[2]);
                let shear = |k: usize, i: usize| {
                    _mm256_sub_ps(_mm256_sub_ps(load(v, k), origin[i]), _mm256_mul_ps(shear_by[i], z[v]))
                };
                x[v] = shear(kx, 0);
                y[v] = shear(ky, 1);
            }
            let edge = |i: usize, j: usize| _mm256_sub_ps(_mm256_mul_ps(x[i], y[j]), _mm256_mul_ps(y[i], x[j]));
            let edges = [edge(2, 1), edge(0, 2), edge(1, 0)];
            let zero = _mm256_setzero_ps();
            // Of the minimum and the maximum the second operand is taken where either is not a number.
            let least = _mm256_min_ps(_mm256_min_ps(z[0], z[1]), z[2]);
            let most = _mm256_max_ps(_mm256_max_ps(z[0], z[1]), z[2]);
            let (low, high) = (_mm256_set1_ps(reach.low), _mm256_set1_ps(reach.high));
            let below = edges.map(|e| _mm256_cmp_ps::<_CMP_LT_OQ>(e, zero));
            let above = edges.map(|e| _mm256_cmp_ps::<_CMP_GT_OQ>(e, zero));
            let below = _mm256_or_ps(_mm256_or_ps(below[0], below[1]), below[2]);
            let above = _mm256_or_ps(_mm256_or_ps(above[0], above[1]), above[2]);
            // Lanes without a triangle hold no numbers.
            let unused = _mm256_cmp_ps::<_CMP_NLE_UQ>(least, most);
            let beyond = _mm256_or_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(least, high), _mm256_cmp_ps::<_CMP_LT_OQ>(most, low));
            let out = _mm256_or_ps(_mm256_or_ps(_mm256_and_ps(below, above), unused), beyond);
            !_mm256_movemask_ps(out) as u32 & 0xFF
        }
    }

    #[inline(always)]
    fn keep(self, from: Lanes<'_>, t_max: f32) -> ([f32; WIDTH], [Child; WIDTH], u8) {
        let (mut entries, mut children) = ([0.0; WIDTH], [Child::END; WIDTH]);
        // SAFETY: `self` proves that the machine has AVX2; the loads and stores are of eight words each.
        let mask = unsafe {
            let old = _mm256_loadu_ps(from.entries.as_ptr());
            let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(old, _mm256_set1_ps(t_max))) as usize;
            let kept = _mm256_cvtepu8_epi32(_mm_loadl_epi64(SET_LANES[mask].as_ptr().cast()));
            _mm256_storeu_ps(entries.as_mut_ptr(), _mm256_permutevar8x32_ps(old, kept));
            let old = _mm256_loadu_si256(from.children.as_ptr().cast());
            _mm256_storeu_si256(children.as_mut_ptr().cast(), _mm256_permutevar8x32_epi32(old, kept));
            mask
        };
        (entries, children, mask as u8)
    }

    #[inline(always)]
    fn beam(self, beam: &Beam, node: &Node, out: &mut BeamSlots) -> usize {
        // SAFETY: `self` proves that the machine has AVX2; the stores are of eight words each.
        unsafe {
            let (entry, exit, order) = eight::beam(beam, node);
            let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(entry, exit)) as usize;
            let kept = _mm256_cvtepu8_epi32(_mm_loadl_epi64(SET_LANES[mask].as_ptr().cast()));
            _mm256_storeu_si256(out.slots.as_mut_ptr().cast(), _mm256_permutevar8x32_epi32(order, kept));
            _mm256_storeu_ps(out.entries.as_mut_ptr(), _mm256_permutevar8x32_ps(entry, kept));
            mask.count_ones() as usize
        }
    }

    #[inline(always)]
    fn packet_block(self, packet: &Packet, block: &TriangleBlock) -> u32 {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { eight::packet_block(packet, block) }
    }

    #[inline(always)]
    fn zeros(self) -> Two {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Two::zeros() }
    }

    #[inline(always)]
    fn four(self) -> AvxFour {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { AvxFour::zeros() }
    }

    #[inline(always)]
    fn components(self, rays: &[Ray; PACKET]) -> [Two; 8] {
        let (first, second) = rays.split_at(WIDTH);
        // SAFETY: `self` proves that the machine has AVX2; both halves are of eight rays.
        unsafe {
            let (a, b) = (eight::components(first), eight::components(second));
            let mut out = [Two::zeros(); 8];
            for i in 0..8 {
                out[i] = Two::from_halves(a[i], b[i]);
            }
            out
        }
    }

    #[inline(always)]
    fn prefetch(self, start: *const u8, lines: usize) {
        for line in 0..lines {
            // SAFETY: a prefetch reads nothing that the program could notice, at any address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.wrapping_add(64 * line).cast()) };
        }
    }
}
