//! The kernels with 256-bit vectors: two vectors a block.
//!
//! No fused multiply-add: every operation rounds as the scalar kernel's does. Masks are vectors of all ones or zeros.

use super::blocks::{Block, Boxes, LANES};
use super::candidates::{Candidates, key};
use super::even;
use super::facing::{ALL, cones, is_unit};
use super::kernels::{CONE, CONSTANT, EPANECHNIKOV, GAUSSIAN, NormalMemo, Selected, VectorKernels, kernel_index};
use super::kth::{kth_least, pad};
use super::shared;
use crate::Gathered;
use crate::flux::{MANTISSA_MASKS, PLACED_UNITS, RAW_SCALE_MASK};
use crate::inclusion::PreparedQuery;
use crate::kernel::GAUSSIAN as GAUSSIAN_COEFFICIENTS;
use crate::photon::{LOW_MASK, NORMAL_MAX};
use photinus_geometry::Vec3;
use std::arch::x86_64::*;
use std::ops::Range;

/// Lanes of a vector.
const HALF: usize = 8;

/// These kernels, where the processor has what they need.
pub(crate) fn kernels() -> Option<VectorKernels> {
    let has_all =
        is_x86_feature_detected!("avx2") && is_x86_feature_detected!("popcnt") && is_x86_feature_detected!("bmi1");
    let shared = shared::avx2::KERNELS;
    has_all.then_some(VectorKernels {
        name: "avx2",
        cull,
        facing,
        prefetch,
        gather,
        select,
        scan,
        kth,
        gather_selected,
        shared,
    })
}

fn cull(boxes: &Boxes, ranges: &[Range<u32>], position: Vec3, r2: f32, facing: u32, hits: &mut Vec<u32>) {
    // SAFETY: `kernels` hands this function out only where the processor has AVX2, POPCNT and BMI1.
    unsafe { cull_boxes(boxes, ranges, position, r2, facing, hits) }
}

fn facing(normal: Vec3) -> u32 {
    // SAFETY: as above.
    unsafe { facing_ways(normal) }
}

fn prefetch(blocks: &[Block], hits: &[u32]) {
    for block in hits {
        let block = &blocks[*block as usize];
        for line in [block.x.as_ptr(), block.y.as_ptr(), block.z.as_ptr()] {
            // SAFETY: a prefetch reads nothing that the program sees, and every processor of this family has it.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(line.cast()) };
        }
        for line in [block.flux.as_ptr(), block.surface.as_ptr()] {
            // SAFETY: as above.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(line.cast()) };
        }
    }
}

fn gather(blocks: &[Block], hits: &[u32], query: &PreparedQuery, memo: &mut NormalMemo) -> Gathered {
    // SAFETY: as above.
    unsafe {
        match kernel_index(query.kernel.kernel) {
            CONSTANT => gather_kernel::<CONSTANT>(blocks, hits, query, memo),
            CONE => gather_kernel::<CONE>(blocks, hits, query, memo),
            EPANECHNIKOV => gather_kernel::<EPANECHNIKOV>(blocks, hits, query, memo),
            _ => gather_kernel::<GAUSSIAN>(blocks, hits, query, memo),
        }
    }
}

fn select(blocks: &[Block], hits: &[u32], query: &PreparedQuery, memo: &mut NormalMemo, found: &mut Vec<Selected>) {
    // SAFETY: as above.
    unsafe { select_blocks(blocks, hits, query, memo, found) }
}

fn scan(blocks: &[Block], ids: &[[u32; LANES]], hits: &[u32], position: Vec3, r2: f32, candidates: &mut Candidates) {
    // SAFETY: as above.
    unsafe { scan_blocks(blocks, ids, hits, position, r2, candidates) }
}

fn kth(selected: &[Selected], k: usize, distances: &mut Vec<f32>) -> f32 {
    // SAFETY: as above.
    unsafe { kth_distance(selected, k, distances) }
}

fn gather_selected(blocks: &[Block], selected: &[Selected], query: &PreparedQuery) -> Gathered {
    // SAFETY: as above.
    unsafe {
        match kernel_index(query.kernel.kernel) {
            CONSTANT => even_selected(blocks, selected, query.r2),
            CONE => selected_kernel::<CONE>(blocks, selected, query),
            EPANECHNIKOV => selected_kernel::<EPANECHNIKOV>(blocks, selected, query),
            _ => selected_kernel::<GAUSSIAN>(blocks, selected, query),
        }
    }
}

/// Half of a block's field as a vector.
#[inline]
#[target_feature(enable = "avx2")]
fn floats(lanes: &[f32; LANES], half: usize) -> __m256 {
    let lanes = &lanes[half * HALF..][..HALF];
    // SAFETY: the slice covers the 32 bytes read; no alignment is asked for.
    unsafe { _mm256_loadu_ps(lanes.as_ptr()) }
}

/// Half of a block's field as a vector.
#[inline]
#[target_feature(enable = "avx2")]
fn words(lanes: &[u32; LANES], half: usize) -> __m256i {
    let lanes = &lanes[half * HALF..][..HALF];
    // SAFETY: the slice covers the 32 bytes read; no alignment is asked for.
    unsafe { _mm256_loadu_si256(lanes.as_ptr().cast()) }
}

#[inline]
#[target_feature(enable = "avx2")]
fn splat(position: Vec3) -> [__m256; 3] {
    [_mm256_set1_ps(position.x), _mm256_set1_ps(position.y), _mm256_set1_ps(position.z)]
}

#[inline]
#[target_feature(enable = "avx2")]
fn dot(a: [__m256; 3], b: [__m256; 3]) -> __m256 {
    let xy = _mm256_add_ps(_mm256_mul_ps(a[0], b[0]), _mm256_mul_ps(a[1], b[1]));
    _mm256_add_ps(xy, _mm256_mul_ps(a[2], b[2]))
}

#[inline]
#[target_feature(enable = "avx2")]
fn distances_sq(block: &Block, half: usize, position: [__m256; 3]) -> __m256 {
    let d = [
        _mm256_sub_ps(floats(&block.x, half), position[0]),
        _mm256_sub_ps(floats(&block.y, half), position[1]),
        _mm256_sub_ps(floats(&block.z, half), position[2]),
    ];
    dot(d, d)
}

/// Lanes whose normal is within 60 degrees of `normal`.
#[inline]
#[target_feature(enable = "avx2")]
fn normals_within_60(surface: __m256i, normal: [__m256; 3]) -> __m256 {
    let zero = _mm256_setzero_ps();
    let sign_bit = _mm256_set1_ps(-0.0);
    let x = _mm256_cvtepi32_ps(_mm256_srai_epi32::<20>(surface));
    let y = _mm256_cvtepi32_ps(_mm256_srai_epi32::<20>(_mm256_slli_epi32::<12>(surface)));
    let abs = |v: __m256| _mm256_andnot_ps(sign_bit, v);
    let z = _mm256_sub_ps(_mm256_sub_ps(_mm256_set1_ps(NORMAL_MAX as f32), abs(x)), abs(y));
    let fold = abs(_mm256_max_ps(_mm256_sub_ps(zero, z), zero));
    let signed = |v: __m256| _mm256_or_ps(fold, _mm256_and_ps(v, sign_bit));
    let v = [_mm256_sub_ps(x, signed(x)), _mm256_sub_ps(y, signed(y)), z];
    let cos = dot(v, normal);
    let bound = _mm256_mul_ps(_mm256_set1_ps(0.25), dot(v, v));
    let front = _mm256_cmp_ps::<_CMP_GT_OQ>(cos, zero);
    _mm256_and_ps(front, _mm256_cmp_ps::<_CMP_GE_OQ>(_mm256_mul_ps(cos, cos), bound))
}

#[inline]
#[target_feature(enable = "avx2")]
fn weights<const KERNEL: u8>(d2: __m256, inv_r2: __m256, inv_k: __m256) -> __m256 {
    let one = _mm256_set1_ps(1.0);
    let u = _mm256_mul_ps(d2, inv_r2);
    match KERNEL {
        CONSTANT => one,
        CONE => _mm256_sub_ps(one, _mm256_mul_ps(_mm256_sqrt_ps(u), inv_k)),
        EPANECHNIKOV => _mm256_sub_ps(one, u),
        _ => {
            let [rest @ .., last] = GAUSSIAN_COEFFICIENTS;
            rest.iter()
                .rev()
                .fold(_mm256_set1_ps(last), |sum, c| _mm256_add_ps(_mm256_mul_ps(sum, u), _mm256_set1_ps(*c)))
        }
    }
}

/// The sixteen lanes in the fixed tree of the scalar kernel.
#[inline]
#[target_feature(enable = "avx2")]
fn tree_sum([low, high]: [__m256; 2]) -> f32 {
    let v = _mm256_add_ps(low, high);
    let v = _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps::<1>(v));
    let v = _mm_add_ps(v, _mm_movehl_ps(v, v));
    _mm_cvtss_f32(_mm_add_ss(v, _mm_shuffle_ps::<1>(v, v)))
}

#[target_feature(enable = "avx2")]
fn facing_ways(normal: Vec3) -> u32 {
    if !is_unit(normal) {
        return ALL;
    }
    let (cones, normal) = (cones(), splat(normal));
    let ways = |part: usize| {
        // SAFETY: all four parts of the 32 numbers are 32 bytes.
        let load = |row: &[f32; 32]| unsafe { _mm256_loadu_ps(row[part * HALF..].as_ptr()) };
        let middle = [load(&cones.middles[0]), load(&cones.middles[1]), load(&cones.middles[2])];
        (_mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GE_OQ>(dot(normal, middle), load(&cones.limits))) as u32)
            << (part * HALF)
    };
    ways(0) | ways(1) | ways(2) | ways(3)
}

#[target_feature(enable = "avx2,bmi1")]
fn cull_boxes(boxes: &Boxes, ranges: &[Range<u32>], position: Vec3, r2: f32, facing: u32, hits: &mut Vec<u32>) {
    let position = splat(position);
    let facing = _mm256_set1_epi32(facing as i32);
    let r2 = _mm256_set1_ps(r2);
    let zero = _mm256_setzero_ps();
    for range in ranges {
        for first in range.clone().step_by(HALF) {
            let side = |side: usize| {
                let lanes = &boxes.bounds[side][first as usize..][..HALF];
                // SAFETY: the slice covers the 32 bytes read.
                unsafe { _mm256_loadu_ps(lanes.as_ptr()) }
            };
            let axis = |axis: usize| {
                let (min, max) = (side(axis), side(axis + 3));
                let outside = _mm256_max_ps(_mm256_sub_ps(min, position[axis]), _mm256_sub_ps(position[axis], max));
                _mm256_max_ps(outside, zero)
            };
            let d = [axis(0), axis(1), axis(2)];
            let lanes = &boxes.facing[first as usize..][..HALF];
            // SAFETY: the slice covers the 32 bytes read.
            let ways = unsafe { _mm256_loadu_si256(lanes.as_ptr().cast()) };
            let away = _mm256_cmpeq_epi32(_mm256_and_si256(ways, facing), _mm256_setzero_si256());
            let near = _mm256_andnot_ps(_mm256_castsi256_ps(away), _mm256_cmp_ps::<_CMP_LE_OQ>(dot(d, d), r2));
            let near = _mm256_movemask_ps(near) as u32;
            let mut near = near & ((1u32 << (range.end - first).min(HALF as u32)) - 1);
            while near != 0 {
                hits.push(first + near.trailing_zeros());
                near &= near - 1;
            }
        }
    }
}

/// The inclusion test of a query.
struct Inclusion<'a> {
    position: [__m256; 3],
    normal: [__m256; 3],
    r2: __m256,
    /// The largest low byte of a surface word where the photon's depth is small enough.
    low_limit: __m256i,
    memo: &'a mut NormalMemo,
}

impl<'a> Inclusion<'a> {
    #[inline]
    #[target_feature(enable = "avx2,popcnt,bmi1")]
    fn new(query: &PreparedQuery, memo: &'a mut NormalMemo) -> Self {
        memo.turn_to(query);
        Self {
            position: splat(query.position),
            normal: splat(query.normal),
            r2: _mm256_set1_ps(query.r2),
            low_limit: _mm256_set1_epi32(query.low_limit as i32),
            memo,
        }
    }

    /// The lanes found, as masks, and the squared distances of all, for half a block.
    #[inline]
    #[target_feature(enable = "avx2,popcnt,bmi1")]
    fn test(&mut self, block: &Block, half: usize) -> (__m256, __m256) {
        let d2 = distances_sq(block, half, self.position);
        let near = _mm256_cmp_ps::<_CMP_LE_OQ>(d2, self.r2);
        let surface = words(&block.surface, half);
        let low = _mm256_and_si256(surface, _mm256_set1_epi32(LOW_MASK as i32));
        let too_deep = _mm256_castsi256_ps(_mm256_cmpgt_epi32(low, self.low_limit));
        let mut found = _mm256_andnot_ps(too_deep, near);
        let normals = _mm256_sub_epi32(surface, low);
        let known = _mm256_castsi256_ps(_mm256_cmpeq_epi32(normals, _mm256_set1_epi32(self.memo.word as i32)));
        let others = _mm256_movemask_ps(_mm256_andnot_ps(known, found));
        if others != 0 || !self.memo.passes {
            found = _mm256_and_ps(found, normals_within_60(surface, self.normal));
            let learnt = _mm256_movemask_ps(found) & others;
            if learnt != 0 {
                self.memo.learn(block.surface[half * HALF + learnt.trailing_zeros() as usize]);
            }
        }
        (found, d2)
    }
}

/// Weighted flux by lane.
struct Sums<const KERNEL: u8> {
    inv_r2: __m256,
    inv_k: __m256,
    mantissa_masks: [__m256i; 3],
    flux: [[__m256; 2]; 3],
    count: u32,
}

impl<const KERNEL: u8> Sums<KERNEL> {
    #[inline]
    #[target_feature(enable = "avx2,popcnt")]
    fn new(query: &PreparedQuery) -> Self {
        Self {
            inv_r2: _mm256_set1_ps(query.kernel.inv_r2),
            inv_k: _mm256_set1_ps(query.kernel.inv_k),
            mantissa_masks: MANTISSA_MASKS.map(|mask| _mm256_set1_epi32(mask as i32)),
            flux: [[_mm256_setzero_ps(); 2]; 3],
            count: 0,
        }
    }

    #[inline]
    #[target_feature(enable = "avx2,popcnt")]
    fn add(&mut self, block: &Block, half: usize, found: __m256, d2: __m256) {
        let flux = words(&block.flux, half);
        let scale = _mm256_and_si256(_mm256_srli_epi32::<2>(flux), _mm256_set1_epi32(RAW_SCALE_MASK as i32));
        let weight = _mm256_mul_ps(_mm256_castsi256_ps(scale), weights::<KERNEL>(d2, self.inv_r2, self.inv_k));
        for (sum, mask) in self.flux.iter_mut().zip(self.mantissa_masks) {
            let mantissa = _mm256_cvtepi32_ps(_mm256_and_si256(flux, mask));
            // Sums are never -0, so that adding +0 in the other lanes leaves them as they are.
            sum[half] = _mm256_add_ps(sum[half], _mm256_and_ps(found, _mm256_mul_ps(mantissa, weight)));
        }
        self.count += _mm256_movemask_ps(found).count_ones();
    }

    #[inline]
    #[target_feature(enable = "avx2,popcnt")]
    fn gathered(self) -> Gathered {
        Gathered { flux: Vec3::from_array(self.flux.map(|sum| tree_sum(sum))) * PLACED_UNITS, count: self.count }
    }
}

#[target_feature(enable = "avx2,popcnt,bmi1")]
fn gather_kernel<const KERNEL: u8>(
    blocks: &[Block],
    hits: &[u32],
    query: &PreparedQuery,
    memo: &mut NormalMemo,
) -> Gathered {
    let mut inclusion = Inclusion::new(query, memo);
    let mut sums = Sums::<KERNEL>::new(query);
    for block in hits {
        let block = &blocks[*block as usize];
        for half in 0..2 {
            let (found, d2) = inclusion.test(block, half);
            sums.add(block, half, found, d2);
        }
    }
    sums.gathered()
}

/// The lanes of half a block whose bits are set, as masks.
#[inline]
#[target_feature(enable = "avx2")]
fn lane_masks(lanes: u32, half: usize) -> __m256 {
    let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    let lanes = _mm256_set1_epi32((lanes >> (half * HALF)) as i32);
    _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(lanes, bits), bits))
}

#[target_feature(enable = "avx2,popcnt,bmi1")]
fn even_selected(blocks: &[Block], selected: &[Selected], r2: f32) -> Gathered {
    even::gather_selected(blocks, selected, r2)
}

#[target_feature(enable = "avx2,popcnt,bmi1")]
fn selected_kernel<const KERNEL: u8>(blocks: &[Block], selected: &[Selected], query: &PreparedQuery) -> Gathered {
    let r2 = _mm256_set1_ps(query.r2);
    let mut sums = Sums::<KERNEL>::new(query);
    for selected in selected {
        for half in 0..2 {
            let d2 = floats(&selected.distances_sq, half);
            let near = _mm256_cmp_ps::<_CMP_LE_OQ>(d2, r2);
            let found = _mm256_and_ps(near, lane_masks(selected.lanes, half));
            sums.add(&blocks[selected.block as usize], half, found, d2);
        }
    }
    sums.gathered()
}

#[target_feature(enable = "avx2,popcnt,bmi1")]
fn select_blocks(
    blocks: &[Block],
    hits: &[u32],
    query: &PreparedQuery,
    memo: &mut NormalMemo,
    selected: &mut Vec<Selected>,
) {
    let mut inclusion = Inclusion::new(query, memo);
    for &block in hits {
        let photons = &blocks[block as usize];
        let [low, high] = [0, 1].map(|half| inclusion.test(photons, half));
        let lanes = _mm256_movemask_ps(low.0) | _mm256_movemask_ps(high.0) << HALF;
        if lanes != 0 {
            let distances_sq = stored([low.1, high.1]);
            selected.push(Selected { block, lanes: lanes as u32, distances_sq });
        }
    }
}

/// Two vectors as the lanes of a block.
#[inline]
#[target_feature(enable = "avx2")]
fn stored([low, high]: [__m256; 2]) -> [f32; LANES] {
    let mut lanes = [0.0; LANES];
    // SAFETY: each store writes 32 bytes of the 64 of `lanes`.
    unsafe {
        _mm256_storeu_ps(lanes.as_mut_ptr(), low);
        _mm256_storeu_ps(lanes.as_mut_ptr().add(HALF), high);
    }
    lanes
}

#[target_feature(enable = "avx2,bmi1")]
fn scan_blocks(
    blocks: &[Block],
    ids: &[[u32; LANES]],
    hits: &[u32],
    position: Vec3,
    r2: f32,
    candidates: &mut Candidates,
) {
    let position = splat(position);
    let mut limit = r2;
    for &block in hits {
        let photons = &blocks[block as usize];
        let d2 = [0, 1].map(|half| distances_sq(photons, half, position));
        let near = d2.map(|d2| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(d2, _mm256_set1_ps(limit))) as u32);
        let mut near = near[0] | near[1] << HALF;
        if near == 0 {
            continue;
        }
        let lanes = stored(d2);
        let free = candidates.free(LANES);
        let mut count = 0;
        while near != 0 {
            let lane = near.trailing_zeros() as usize;
            free[count] = key(lanes[lane], ids[block as usize][lane]);
            count += 1;
            near &= near - 1;
        }
        limit = candidates.push(count).unwrap_or(limit);
    }
}

#[target_feature(enable = "avx2,bmi1")]
fn kth_distance(selected: &[Selected], k: usize, distances: &mut Vec<f32>) -> f32 {
    distances.clear();
    for selected in selected {
        let mut lanes = selected.lanes;
        while lanes != 0 {
            distances.push(selected.distances_sq[lanes.trailing_zeros() as usize]);
            lanes &= lanes - 1;
        }
    }
    pad(distances);
    kth_least(distances, -1.0, k)
}
