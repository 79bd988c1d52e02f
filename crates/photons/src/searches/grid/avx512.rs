//! The kernels with 512-bit vectors: one block a vector.
//!
//! No fused multiply-add: every operation rounds as the scalar kernel's does.

use super::blocks::{Block, Boxes, LANES};
use super::candidates::Candidates;
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

/// These kernels, where the processor has what they need.
pub(crate) fn kernels() -> Option<VectorKernels> {
    let has_all =
        is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("popcnt") && is_x86_feature_detected!("bmi1");
    let shared = shared::avx512::KERNELS;
    has_all.then_some(VectorKernels {
        name: "avx512",
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
    // SAFETY: `kernels` hands this function out only where the processor has AVX-512F, POPCNT and BMI1.
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

/// A block's field as a vector.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn floats(lanes: &[f32; LANES]) -> __m512 {
    // SAFETY: the reference covers the 64 bytes read; no alignment is asked for.
    unsafe { _mm512_loadu_ps(lanes.as_ptr()) }
}

/// A block's field as a vector.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn words(lanes: &[u32; LANES]) -> __m512i {
    // SAFETY: the reference covers the 64 bytes read; no alignment is asked for.
    unsafe { _mm512_loadu_si512(lanes.as_ptr().cast()) }
}

#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn splat(position: Vec3) -> [__m512; 3] {
    [_mm512_set1_ps(position.x), _mm512_set1_ps(position.y), _mm512_set1_ps(position.z)]
}

#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn dot(a: [__m512; 3], b: [__m512; 3]) -> __m512 {
    let xy = _mm512_add_ps(_mm512_mul_ps(a[0], b[0]), _mm512_mul_ps(a[1], b[1]));
    _mm512_add_ps(xy, _mm512_mul_ps(a[2], b[2]))
}

#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn distances_sq(block: &Block, position: [__m512; 3]) -> __m512 {
    let d = [
        _mm512_sub_ps(floats(&block.x), position[0]),
        _mm512_sub_ps(floats(&block.y), position[1]),
        _mm512_sub_ps(floats(&block.z), position[2]),
    ];
    dot(d, d)
}

/// Normals of surface words, of any length.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn normals(surface: __m512i) -> [__m512; 3] {
    let zero = _mm512_setzero_ps();
    let sign_bit = _mm512_castsi512_ps(_mm512_set1_epi32(i32::MIN));
    let (sign_bits, x, y) = (
        _mm512_castps_si512(sign_bit),
        _mm512_cvtepi32_ps(_mm512_srai_epi32::<20>(surface)),
        _mm512_cvtepi32_ps(_mm512_srai_epi32::<20>(_mm512_slli_epi32::<12>(surface))),
    );
    let z = _mm512_sub_ps(_mm512_sub_ps(_mm512_set1_ps(NORMAL_MAX as f32), _mm512_abs_ps(x)), _mm512_abs_ps(y));
    let fold = _mm512_castps_si512(_mm512_max_ps(_mm512_sub_ps(zero, z), zero));
    // fold with the sign of v: bits of the second where the first is set, of the third elsewhere.
    let signed =
        |v: __m512| _mm512_castsi512_ps(_mm512_ternarylogic_epi32::<0xCA>(sign_bits, _mm512_castps_si512(v), fold));
    [_mm512_sub_ps(x, signed(x)), _mm512_sub_ps(y, signed(y)), z]
}

/// Lanes whose normal is within 60 degrees of `normal`.
#[inline]
#[target_feature(enable = "avx512f")]
fn normals_within_60(surface: __m512i, normal: [__m512; 3]) -> __mmask16 {
    let (v, zero) = (normals(surface), _mm512_setzero_ps());
    let cos = dot(v, normal);
    let bound = _mm512_mul_ps(_mm512_set1_ps(0.25), dot(v, v));
    let front = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(cos, zero);
    _mm512_mask_cmp_ps_mask::<_CMP_GE_OQ>(front, _mm512_mul_ps(cos, cos), bound)
}

#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn weights<const KERNEL: u8>(d2: __m512, inv_r2: __m512, inv_k: __m512) -> __m512 {
    let one = _mm512_set1_ps(1.0);
    let u = _mm512_mul_ps(d2, inv_r2);
    match KERNEL {
        CONSTANT => one,
        CONE => _mm512_sub_ps(one, _mm512_mul_ps(_mm512_sqrt_ps(u), inv_k)),
        EPANECHNIKOV => _mm512_sub_ps(one, u),
        _ => {
            let [rest @ .., last] = GAUSSIAN_COEFFICIENTS;
            rest.iter()
                .rev()
                .fold(_mm512_set1_ps(last), |sum, c| _mm512_add_ps(_mm512_mul_ps(sum, u), _mm512_set1_ps(*c)))
        }
    }
}

/// The sixteen lanes in the fixed tree of the scalar kernel.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn tree_sum(v: __m512) -> f32 {
    let v = _mm512_add_ps(v, _mm512_shuffle_f32x4::<0b01_00_11_10>(v, v));
    let v = _mm512_add_ps(v, _mm512_shuffle_f32x4::<0b10_11_00_01>(v, v));
    let v = _mm512_castps512_ps128(v);
    let v = _mm_add_ps(v, _mm_movehl_ps(v, v));
    _mm_cvtss_f32(_mm_add_ss(v, _mm_shuffle_ps::<1>(v, v)))
}

#[target_feature(enable = "avx512f")]
fn facing_ways(normal: Vec3) -> u32 {
    if !is_unit(normal) {
        return ALL;
    }
    let (cones, normal) = (cones(), splat(normal));
    let ways = |half: usize| {
        // SAFETY: both halves of the 32 numbers are 64 bytes.
        let load = |row: &[f32; 32]| unsafe { _mm512_loadu_ps(row[half * LANES..].as_ptr()) };
        let middle = [load(&cones.middles[0]), load(&cones.middles[1]), load(&cones.middles[2])];
        u32::from(_mm512_cmp_ps_mask::<_CMP_GE_OQ>(dot(normal, middle), load(&cones.limits)))
    };
    ways(0) | ways(1) << LANES
}

#[target_feature(enable = "avx512f,popcnt")]
fn cull_boxes(boxes: &Boxes, ranges: &[Range<u32>], position: Vec3, r2: f32, facing: u32, hits: &mut Vec<u32>) {
    let position = splat(position);
    let facing = _mm512_set1_epi32(facing as i32);
    let r2 = _mm512_set1_ps(r2);
    let zero = _mm512_setzero_ps();
    let ascending = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for range in ranges {
        for first in range.clone().step_by(LANES) {
            let side = |side: usize| {
                let lanes = &boxes.bounds[side][first as usize..][..LANES];
                // SAFETY: the slice covers the 64 bytes read.
                unsafe { _mm512_loadu_ps(lanes.as_ptr()) }
            };
            let axis = |axis: usize| {
                let (min, max) = (side(axis), side(axis + 3));
                let outside = _mm512_max_ps(_mm512_sub_ps(min, position[axis]), _mm512_sub_ps(position[axis], max));
                _mm512_max_ps(outside, zero)
            };
            let d = [axis(0), axis(1), axis(2)];
            let in_range = _mm512_cmplt_epu32_mask(ascending, _mm512_set1_epi32((range.end - first) as i32));
            let near = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(in_range, dot(d, d), r2);
            let lanes = &boxes.facing[first as usize..][..LANES];
            // SAFETY: the slice covers the 64 bytes read.
            let ways = unsafe { _mm512_loadu_si512(lanes.as_ptr().cast()) };
            let near = _mm512_mask_test_epi32_mask(near, ways, facing);
            let ids = _mm512_add_epi32(ascending, _mm512_set1_epi32(first as i32));
            hits.reserve(LANES);
            // SAFETY: there is room for sixteen more, of which the first ones, as many as `near` has bits, are kept.
            unsafe {
                let end = hits.as_mut_ptr().add(hits.len());
                _mm512_storeu_si512(end.cast(), _mm512_maskz_compress_epi32(near, ids));
                hits.set_len(hits.len() + near.count_ones() as usize);
            }
        }
    }
}

/// The inclusion test of a query.
struct Inclusion<'a> {
    position: [__m512; 3],
    normal: [__m512; 3],
    r2: __m512,
    /// Low bytes of surface words are below this where the photon's depth is small enough.
    low_end: __m512i,
    /// A normal that passes ...
    known: __m512i,
    /// ... and `low_end`, or zero where none is known.
    known_end: __m512i,
    memo: &'a mut NormalMemo,
    /// One normal is learnt a query, lest every block wait for the one before where all normals differ.
    has_learnt: bool,
}

impl<'a> Inclusion<'a> {
    #[inline]
    #[target_feature(enable = "avx512f,popcnt,bmi1")]
    fn new(query: &PreparedQuery, memo: &'a mut NormalMemo) -> Self {
        memo.turn_to(query);
        let low_end = _mm512_set1_epi32(query.low_limit as i32 + 1);
        Self {
            position: splat(query.position),
            normal: splat(query.normal),
            r2: _mm512_set1_ps(query.r2),
            low_end,
            known: _mm512_set1_epi32(memo.word as i32),
            known_end: if memo.passes { low_end } else { _mm512_setzero_si512() },
            memo,
            has_learnt: false,
        }
    }

    /// The lanes found and the squared distances of all.
    #[inline]
    #[target_feature(enable = "avx512f,popcnt,bmi1")]
    fn test(&mut self, block: &Block) -> (__mmask16, __m512) {
        let d2 = distances_sq(block, self.position);
        let near = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(d2, self.r2);
        let surface = words(&block.surface);
        // The known normal leaves only the low byte, which is small enough where the depth is.
        let mut found = _mm512_mask_cmplt_epu32_mask(near, _mm512_xor_si512(surface, self.known), self.known_end);
        if found != near {
            let low = _mm512_and_si512(surface, _mm512_set1_epi32(LOW_MASK as i32));
            let shallow = _mm512_mask_cmplt_epu32_mask(near & !found, low, self.low_end);
            let others = normals_within_60(surface, self.normal) & shallow;
            if others != 0 && !self.has_learnt {
                self.has_learnt = true;
                self.memo.learn(block.surface[others.trailing_zeros() as usize]);
                (self.known, self.known_end) = (_mm512_set1_epi32(self.memo.word as i32), self.low_end);
            }
            found |= others;
        }
        (found, d2)
    }
}

/// Weighted flux by lane.
struct Sums<const KERNEL: u8> {
    inv_r2: __m512,
    inv_k: __m512,
    mantissa_masks: [__m512i; 3],
    flux: [__m512; 3],
    count: u32,
}

impl<const KERNEL: u8> Sums<KERNEL> {
    #[inline]
    #[target_feature(enable = "avx512f,popcnt")]
    fn new(query: &PreparedQuery) -> Self {
        Self {
            inv_r2: _mm512_set1_ps(query.kernel.inv_r2),
            inv_k: _mm512_set1_ps(query.kernel.inv_k),
            mantissa_masks: MANTISSA_MASKS.map(|mask| _mm512_set1_epi32(mask as i32)),
            flux: [_mm512_setzero_ps(); 3],
            count: 0,
        }
    }

    #[inline]
    #[target_feature(enable = "avx512f,popcnt")]
    fn add(&mut self, block: &Block, found: __mmask16, d2: __m512) {
        let flux = words(&block.flux);
        let scale = _mm512_and_si512(_mm512_srli_epi32::<2>(flux), _mm512_set1_epi32(RAW_SCALE_MASK as i32));
        let weight = _mm512_mul_ps(_mm512_castsi512_ps(scale), weights::<KERNEL>(d2, self.inv_r2, self.inv_k));
        for (sum, mask) in self.flux.iter_mut().zip(self.mantissa_masks) {
            let mantissa = _mm512_cvtepi32_ps(_mm512_and_si512(flux, mask));
            *sum = _mm512_mask_add_ps(*sum, found, *sum, _mm512_mul_ps(mantissa, weight));
        }
        self.count += found.count_ones();
    }

    #[inline]
    #[target_feature(enable = "avx512f,popcnt")]
    fn gathered(self) -> Gathered {
        Gathered { flux: Vec3::from_array(self.flux.map(|sum| tree_sum(sum))) * PLACED_UNITS, count: self.count }
    }
}

#[target_feature(enable = "avx512f,popcnt,bmi1")]
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
        let (found, d2) = inclusion.test(block);
        sums.add(block, found, d2);
    }
    sums.gathered()
}

#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn even_selected(blocks: &[Block], selected: &[Selected], r2: f32) -> Gathered {
    even::gather_selected(blocks, selected, r2)
}

#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn selected_kernel<const KERNEL: u8>(blocks: &[Block], selected: &[Selected], query: &PreparedQuery) -> Gathered {
    let r2 = _mm512_set1_ps(query.r2);
    let mut sums = Sums::<KERNEL>::new(query);
    for selected in selected {
        let d2 = floats(&selected.distances_sq);
        let found = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(selected.lanes as u16, d2, r2);
        if found != 0 {
            sums.add(&blocks[selected.block as usize], found, d2);
        }
    }
    sums.gathered()
}

#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn select_blocks(
    blocks: &[Block],
    hits: &[u32],
    query: &PreparedQuery,
    memo: &mut NormalMemo,
    selected: &mut Vec<Selected>,
) {
    let mut inclusion = Inclusion::new(query, memo);
    for &block in hits {
        let (found, d2) = inclusion.test(&blocks[block as usize]);
        if found != 0 {
            let mut distances_sq = [0.0; LANES];
            // SAFETY: the array holds the 64 bytes written.
            unsafe { _mm512_storeu_ps(distances_sq.as_mut_ptr(), d2) };
            selected.push(Selected { block, lanes: found.into(), distances_sq });
        }
    }
}

#[target_feature(enable = "avx512f,popcnt")]
fn scan_blocks(
    blocks: &[Block],
    ids: &[[u32; LANES]],
    hits: &[u32],
    position: Vec3,
    r2: f32,
    candidates: &mut Candidates,
) {
    let position = splat(position);
    let mut limit = _mm512_set1_ps(r2);
    for &block in hits {
        let d2 = distances_sq(&blocks[block as usize], position);
        let near = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(d2, limit);
        if near == 0 {
            continue;
        }
        let (d2, ids) = (_mm512_castps_si512(d2), words(&ids[block as usize]));
        // Keys of 64 bits: the distance's bits above the id.
        let key = |d2: __m256i, id: __m256i| {
            _mm512_or_si512(_mm512_slli_epi64::<32>(_mm512_cvtepu32_epi64(d2)), _mm512_cvtepu32_epi64(id))
        };
        let low = key(_mm512_castsi512_si256(d2), _mm512_castsi512_si256(ids));
        let high = key(_mm512_extracti64x4_epi64::<1>(d2), _mm512_extracti64x4_epi64::<1>(ids));
        let (near_low, near_high) = (near as u8, (near >> 8) as u8);
        let free = candidates.free(LANES);
        let (first_count, second_count) = (near_low.count_ones() as usize, near_high.count_ones() as usize);
        // SAFETY: `free` holds at least 16 keys: the second store begins at most 8 keys in.
        unsafe {
            _mm512_storeu_si512(free.as_mut_ptr().cast(), _mm512_maskz_compress_epi64(near_low, low));
            let second = free.as_mut_ptr().add(first_count);
            _mm512_storeu_si512(second.cast(), _mm512_maskz_compress_epi64(near_high, high));
        }
        if let Some(closer) = candidates.push(first_count + second_count) {
            limit = _mm512_set1_ps(closer);
        }
    }
}

#[target_feature(enable = "avx512f,popcnt")]
fn kth_distance(selected: &[Selected], k: usize, distances: &mut Vec<f32>) -> f32 {
    distances.clear();
    distances.reserve((selected.len() + 1) * LANES);
    for selected in selected {
        let (found, d2) = (selected.lanes as u16, floats(&selected.distances_sq));
        // SAFETY: there is room for sixteen an entry, of which the first ones, as many as `found` has bits, are kept.
        unsafe {
            let end = distances.as_mut_ptr().add(distances.len());
            _mm512_storeu_ps(end, _mm512_maskz_compress_ps(found, d2));
            distances.set_len(distances.len() + found.count_ones() as usize);
        }
    }
    pad(distances);
    kth_least(distances, -1.0, k)
}
