//! AVX2: eight lanes in one register, two registers for a block.

use super::Kernel;
use crate::reach::Reach;
use crate::structure::RayCounters;
use crate::structures::brute_force::blocked::Blocked;
use crate::structures::brute_force::layout::{Boxes, CHUNK, LANES, Vertices};
use crate::structures::brute_force::sieve::Sieve;
use photinus_geometry::{Hit, Ray};
use photinus_intersect::methods::woop::Started;
use std::arch::x86_64::*;

/// Where the second half of a row starts.
const HALF: usize = LANES / 2;

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

#[target_feature(enable = "avx2,bmi1,bmi2,popcnt,lzcnt")]
fn trace<const ANY: bool>(
    kernel: Avx2,
    blocked: &Blocked,
    rays: &[Ray],
    set: impl FnMut(usize, Hit),
    counters: &mut RayCounters,
) {
    blocked.trace::<_, ANY>(kernel, rays, set, counters);
}

impl Kernel for Avx2 {
    #[inline(always)]
    fn sift(self, sieve: &Sieve, boxes: &[Boxes]) -> u64 {
        // Of each block the lanes that are out in both halves: all bits where none passes.
        let mut lanes = [u8::MAX; CHUNK];
        // SAFETY: `self` proves that the machine has AVX2; the loads from boxes are of eight words each, from places that are
        // at most 5 x 16 + 8 in a block of 6 x 16, `side` at most 4 x 16 + 8, and those from `lanes` of 32 of 64.
        unsafe {
            let spread = |x: [f32; 2]| x.map(|x| _mm256_set1_ps(x));
            let (shear, most, least) = (spread(sieve.shear), spread(sieve.most), spread(sieve.least));
            for (block, lanes) in boxes.iter().zip(&mut lanes) {
                let out = |half: usize| {
                    let load = |place: usize| _mm256_load_ps(block.bounds.as_ptr().cast::<f32>().add(place + half));
                    let sheared = |place: usize, with: usize, i: usize| {
                        _mm256_sub_ps(load(place), _mm256_mul_ps(shear[i], load(with)))
                    };
                    let side = |i: usize| {
                        let lower = sheared(sieve.side[i], sieve.with_lower[i], i);
                        let upper = sheared(sieve.side[i] + LANES, sieve.with_upper[i], i);
                        let above = _mm256_cmp_ps::<_CMP_GT_OQ>(lower, most[i]);
                        _mm256_or_ps(above, _mm256_cmp_ps::<_CMP_LT_OQ>(upper, least[i]))
                    };
                    _mm256_or_ps(side(0), side(1))
                };
                *lanes = _mm256_movemask_ps(_mm256_and_ps(out(0), out(HALF))) as u8;
            }
            let half = |first: usize| {
                let lanes = _mm256_loadu_si256(lanes.as_ptr().add(first).cast());
                let all_out = _mm256_movemask_epi8(_mm256_cmpeq_epi8(lanes, _mm256_set1_epi8(-1)));
                u64::from(!all_out as u32)
            };
            half(0) | half(CHUNK / 2) << (CHUNK / 2)
        }
    }

    #[inline(always)]
    fn filter(self, ray: &Started<f32>, reach: &Reach, block: &Vertices) -> u16 {
        let mut mask = 0;
        // SAFETY: `self` proves that the machine has AVX2; the loads are of eight words of sixteen each, and axes are
        // below 3.
        unsafe {
            let [kx, ky, kz] = ray.axes.map(|k| k % 3);
            let spread = |x: f32| _mm256_set1_ps(x);
            let origin = [spread(ray.origin[kx]), spread(ray.origin[ky]), spread(ray.origin[kz])];
            let shear_by = [spread(ray.shear[0]), spread(ray.shear[1])];
            for half in [0, HALF] {
                let rows = block.rows.as_ptr().cast::<f32>().add(half);
                let load = |v: usize, k: usize| _mm256_load_ps(rows.add((3 * v + k) * LANES));
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
                // Of the minimum and the maximum the second operand is taken where either is not a number: the least of
                // some edges that is below zero is that of all, too.
                let least = |x: [__m256; 3]| _mm256_min_ps(_mm256_min_ps(x[0], x[1]), x[2]);
                let most = |x: [__m256; 3]| _mm256_max_ps(_mm256_max_ps(x[0], x[1]), x[2]);
                let zero = _mm256_setzero_ps();
                let below = _mm256_cmp_ps::<_CMP_LT_OQ>(least(edges), zero);
                let straddles = _mm256_and_ps(below, _mm256_cmp_ps::<_CMP_GT_OQ>(most(edges), zero));
                let beyond = _mm256_or_ps(
                    _mm256_cmp_ps::<_CMP_GT_OQ>(least(z), spread(reach.high)),
                    _mm256_cmp_ps::<_CMP_LT_OQ>(most(z), spread(reach.low)),
                );
                mask |= (!_mm256_movemask_ps(_mm256_or_ps(straddles, beyond)) as u16 & 0xFF) << half;
            }
        }
        mask
    }
}
