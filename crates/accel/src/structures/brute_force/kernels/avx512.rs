//! AVX-512: sixteen lanes in one register, comparisons in mask registers.

use super::Kernel;
use crate::reach::Reach;
use crate::structure::RayCounters;
use crate::structures::brute_force::blocked::Blocked;
use crate::structures::brute_force::layout::{Boxes, CHUNK, LANES, Vertices};
use crate::structures::brute_force::sieve::Sieve;
use photinus_geometry::{Hit, Ray};
use photinus_intersect::methods::woop::Started;
use std::arch::x86_64::*;

/// The kernel.
#[derive(Clone, Copy)]
pub struct Avx512(());

impl Avx512 {
    /// The kernel, where the machine can run it.
    pub fn detect() -> Option<Self> {
        let has = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("popcnt")
            && is_x86_feature_detected!("lzcnt");
        has.then_some(Self(()))
    }

    /// [`Blocked::trace`] compiled for this instruction set.
    pub fn trace<const ANY: bool>(
        self,
        blocked: &Blocked,
        rays: &[Ray],
        set: impl FnMut(usize, Hit),
        counters: &mut RayCounters,
    ) {
        // SAFETY: `self` proves that the machine has the features that the function is compiled for.
        unsafe { trace::<ANY>(self, blocked, rays, set, counters) }
    }
}

#[target_feature(enable = "avx512f,avx512bw,avx512vl,avx512dq,bmi1,bmi2,popcnt,lzcnt")]
fn trace<const ANY: bool>(
    kernel: Avx512,
    blocked: &Blocked,
    rays: &[Ray],
    set: impl FnMut(usize, Hit),
    counters: &mut RayCounters,
) {
    blocked.trace::<_, ANY>(kernel, rays, set, counters);
}

impl Kernel for Avx512 {
    #[inline(always)]
    fn sift(self, sieve: &Sieve, boxes: &[Boxes]) -> u64 {
        // Which lanes of each block pass: stored as they are, which takes no port that computes.
        let mut lanes = [0u16; CHUNK];
        // SAFETY: `self` proves that the machine has AVX-512F and BW; the loads from boxes are of sixteen words each, from
        // places that are at most 5 x 16 in a block of 6 x 16, `side` at most 4 x 16, and those from `lanes` of 32 of 64.
        unsafe {
            let spread = |x: [f32; 2]| x.map(|x| _mm512_set1_ps(x));
            let (shear, most, least) = (spread(sieve.shear), spread(sieve.most), spread(sieve.least));
            for (block, lanes) in boxes.iter().zip(&mut lanes) {
                let load = |place: usize| _mm512_load_ps(block.bounds.as_ptr().cast::<f32>().add(place));
                let lower =
                    |i: usize| _mm512_sub_ps(load(sieve.side[i]), _mm512_mul_ps(shear[i], load(sieve.with_lower[i])));
                let upper = |i: usize| {
                    _mm512_sub_ps(load(sieve.side[i] + LANES), _mm512_mul_ps(shear[i], load(sieve.with_upper[i])))
                };
                // Each comparison takes up the mask of the one before. What is not a number is neither above nor below.
                let mask = _mm512_cmp_ps_mask::<_CMP_NGT_UQ>(lower(0), most[0]);
                let mask = _mm512_mask_cmp_ps_mask::<_CMP_NLT_UQ>(mask, upper(0), least[0]);
                let mask = _mm512_mask_cmp_ps_mask::<_CMP_NGT_UQ>(mask, lower(1), most[1]);
                *lanes = _mm512_mask_cmp_ps_mask::<_CMP_NLT_UQ>(mask, upper(1), least[1]);
            }
            let half = |first: usize| {
                let lanes = _mm512_loadu_si512(lanes.as_ptr().add(first).cast());
                u64::from(_mm512_test_epi16_mask(lanes, lanes))
            };
            half(0) | half(CHUNK / 2) << (CHUNK / 2)
        }
    }

    #[inline(always)]
    fn filter(self, ray: &Started<f32>, reach: &Reach, block: &Vertices) -> u16 {
        // SAFETY: `self` proves that the machine has AVX-512F; the loads are of sixteen words each, and axes are below 3.
        unsafe {
            let [kx, ky, kz] = ray.axes.map(|k| k % 3);
            let spread = |x: f32| _mm512_set1_ps(x);
            let origin = [spread(ray.origin[kx]), spread(ray.origin[ky]), spread(ray.origin[kz])];
            let shear_by = [spread(ray.shear[0]), spread(ray.shear[1])];
            let rows = block.rows.as_ptr().cast::<f32>();
            let load = |v: usize, k: usize| _mm512_load_ps(rows.add((3 * v + k) * LANES));
            let mut x = [_mm512_setzero_ps(); 3];
            let mut y = x;
            let mut z = x;
            for v in 0..3 {
                z[v] = _mm512_sub_ps(load(v, kz), origin[2]);
                let shear = |k: usize, i: usize| {
                    _mm512_sub_ps(_mm512_sub_ps(load(v, k), origin[i]), _mm512_mul_ps(shear_by[i], z[v]))
                };
                x[v] = shear(kx, 0);
                y[v] = shear(ky, 1);
            }
            let edge = |i: usize, j: usize| _mm512_sub_ps(_mm512_mul_ps(x[i], y[j]), _mm512_mul_ps(y[i], x[j]));
            let edges = [edge(2, 1), edge(0, 2), edge(1, 0)];
            // Of the minimum and the maximum the second operand is taken where either is not a number: the least of some
            // edges that is below zero is that of all, too.
            let least = |x: [__m512; 3]| _mm512_min_ps(_mm512_min_ps(x[0], x[1]), x[2]);
            let most = |x: [__m512; 3]| _mm512_max_ps(_mm512_max_ps(x[0], x[1]), x[2]);
            let zero = _mm512_setzero_ps();
            let below = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(least(edges), zero);
            let straddles = _mm512_mask_cmp_ps_mask::<_CMP_GT_OQ>(below, most(edges), zero);
            let beyond = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(least(z), spread(reach.high))
                | _mm512_cmp_ps_mask::<_CMP_LT_OQ>(most(z), spread(reach.low));
            !straddles & !beyond
        }
    }
}
