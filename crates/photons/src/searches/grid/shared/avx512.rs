//! Shared photons with 512-bit vectors: a row a vector.
//!
//! No fused multiply-add: every operation rounds as the scalar kernel's does.

use super::{Found, Row, Share, Shared};
use crate::Gathered;
use crate::flux::{MANTISSA_MASKS, PLACED_UNITS, RAW_SCALE_MASK};
use crate::inclusion::PreparedQuery;
use crate::photon::LOW_MASK;
use crate::searches::grid::avx512::{distances_sq, dot, floats, normals, splat, tree_sum, weights, words};
use crate::searches::grid::blocks::{Block, LANES};
use crate::searches::grid::kernels::{CONE, CONSTANT, EPANECHNIKOV, GAUSSIAN, SharedKernels, kernel_index};
use crate::searches::grid::kth::{kth_least, pad};
use photinus_geometry::Vec3;
use std::arch::x86_64::*;

/// For processors that have AVX-512F, POPCNT and BMI1.
pub(crate) const KERNELS: SharedKernels = SharedKernels { collect, nearest, gather };

/// The `k`-th squared distance is looked for between these parts of the guess first.
const BRACKET: [f32; 2] = [0.8, 1.25];

fn collect(blocks: &[Block], hits: &[u32], share: &Share, shared: &mut Shared) {
    // SAFETY: these kernels are handed out only where the processor has AVX-512F, POPCNT and BMI1.
    unsafe { collect_blocks(blocks, hits, share, shared) }
}

fn nearest(shared: &mut Shared, query: &PreparedQuery, k: usize, guess_sq: f32) -> Found {
    // SAFETY: as above.
    unsafe {
        if shared.same_normal {
            nearest_rows::<true>(shared, query, k, guess_sq)
        } else {
            nearest_rows::<false>(shared, query, k, guess_sq)
        }
    }
}

fn gather(shared: &Shared, query: &PreparedQuery) -> Gathered {
    // SAFETY: as above.
    unsafe {
        match kernel_index(query.kernel.kernel) {
            CONSTANT => gather_rows::<CONSTANT>(shared, query),
            CONE => gather_rows::<CONE>(shared, query),
            EPANECHNIKOV => gather_rows::<EPANECHNIKOV>(shared, query),
            _ => gather_rows::<GAUSSIAN>(shared, query),
        }
    }
}

/// What a row holds of a block's photons.
#[inline]
#[target_feature(enable = "avx512f")]
fn fields(block: &Block, normal: [__m512; 3], quarter: __m512) -> [__m512; 11] {
    let flux = words(&block.flux);
    let scale = _mm512_and_si512(_mm512_srli_epi32::<2>(flux), _mm512_set1_epi32(RAW_SCALE_MASK as i32));
    let [r, g, b] =
        MANTISSA_MASKS.map(|mask| _mm512_cvtepi32_ps(_mm512_and_si512(flux, _mm512_set1_epi32(mask as i32))));
    let [nx, ny, nz] = normal;
    let scale = _mm512_castsi512_ps(scale);
    [floats(&block.x), floats(&block.y), floats(&block.z), nx, ny, nz, quarter, scale, r, g, b]
}

#[inline]
#[target_feature(enable = "avx512f")]
fn set_lanes(row: &mut Row, lanes: __mmask16, fields: &[__m512; 11]) {
    let [px, py, pz] = &mut row.position;
    let [nx, ny, nz] = &mut row.normal;
    let [r, g, b] = &mut row.mantissas;
    let places = [px, py, pz, nx, ny, nz, &mut row.quarter, &mut row.scale, r, g, b];
    for (place, field) in places.into_iter().zip(fields) {
        // SAFETY: the array holds the sixteen numbers of which some are written.
        unsafe { _mm512_mask_storeu_ps(place.as_mut_ptr(), lanes, *field) };
    }
}

#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn collect_blocks(blocks: &[Block], hits: &[u32], share: &Share, shared: &mut Shared) {
    shared.start(share);
    let query = &share.query;
    let (position, facing, r2) = (splat(query.position), splat(query.normal), _mm512_set1_ps(query.r2));
    let low_limit = _mm512_set1_epi32(query.low_limit as i32);
    let mut heights = _mm512_setzero_si512();
    for block in hits {
        let block = &blocks[*block as usize];
        let near = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(distances_sq(block, position), r2);
        if near == 0 {
            continue;
        }
        let surface = words(&block.surface);
        let low = _mm512_and_si512(surface, _mm512_set1_epi32(LOW_MASK as i32));
        let mut wanted = _mm512_mask_cmple_epu32_mask(near, low, low_limit);
        let normal = normals(surface);
        let quarter = _mm512_mul_ps(_mm512_set1_ps(0.25), dot(normal, normal));
        if share.same_normal {
            wanted = within_60(wanted, normal, quarter, facing);
        }
        let fields = fields(block, normal, quarter);
        let higher = _mm512_mask_add_epi32(heights, wanted, heights, _mm512_set1_epi32(1));
        // Lanes of equal height go to one row together.
        while wanted != 0 {
            let row = shared.heights[wanted.trailing_zeros() as usize];
            if row as usize == shared.filled.len() {
                shared.add_row();
            }
            let taken = _mm512_mask_cmpeq_epi32_mask(wanted, heights, _mm512_set1_epi32(row as i32));
            set_lanes(&mut shared.rows[row as usize], taken, &fields);
            shared.filled[row as usize] |= taken;
            wanted &= !taken;
        }
        heights = higher;
        // SAFETY: the array holds the sixteen numbers written.
        unsafe { _mm512_storeu_si512(shared.heights.as_mut_ptr().cast(), heights) };
    }
}

/// Those lanes whose normals are within 60 degrees of the one that the query is facing.
#[inline]
#[target_feature(enable = "avx512f")]
fn within_60(lanes: __mmask16, normal: [__m512; 3], quarter: __m512, facing: [__m512; 3]) -> __mmask16 {
    let cos = dot(normal, facing);
    let front = _mm512_mask_cmp_ps_mask::<_CMP_GT_OQ>(lanes, cos, _mm512_setzero_ps());
    _mm512_mask_cmp_ps_mask::<_CMP_GE_OQ>(front, _mm512_mul_ps(cos, cos), quarter)
}

#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn nearest_rows<const SAME_NORMAL: bool>(shared: &mut Shared, query: &PreparedQuery, k: usize, guess_sq: f32) -> Found {
    let (position, facing, r2) = (splat(query.position), splat(query.normal), _mm512_set1_ps(query.r2));
    let low = BRACKET[0] * guess_sq;
    let (bracket_low, bracket_high) = (_mm512_set1_ps(low), _mm512_set1_ps(BRACKET[1] * guess_sq));
    let infinite = _mm512_set1_ps(f32::INFINITY);
    let rows = shared.filled.len();
    let Shared { rows: all_rows, distances_sq, some, .. } = shared;
    let all_rows = &all_rows[..rows];
    distances_sq.resize(rows, [0.0; LANES]);
    some.clear();
    some.reserve((rows + 1) * LANES);
    let (mut count, mut below, mut between) = (0, 0, 0);
    for (row, out) in all_rows.iter().zip(&mut *distances_sq) {
        let [x, y, z] = &row.position;
        let d = [
            _mm512_sub_ps(floats(x), position[0]),
            _mm512_sub_ps(floats(y), position[1]),
            _mm512_sub_ps(floats(z), position[2]),
        ];
        let d2 = dot(d, d);
        let mut found = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(d2, r2);
        if !SAME_NORMAL {
            let [x, y, z] = &row.normal;
            found = within_60(found, [floats(x), floats(y), floats(z)], floats(&row.quarter), facing);
        }
        // SAFETY: the array holds the sixteen numbers written.
        unsafe { _mm512_storeu_ps(out.as_mut_ptr(), _mm512_mask_blend_ps(found, infinite, d2)) };
        let far = _mm512_mask_cmp_ps_mask::<_CMP_GT_OQ>(found, d2, bracket_low);
        let inside = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(far, d2, bracket_high);
        // SAFETY: there is room for sixteen a row and sixteen more, of which the first ones, as many as `inside` has
        // bits, are kept.
        unsafe { _mm512_storeu_ps(some.as_mut_ptr().add(between), _mm512_maskz_compress_ps(inside, d2)) };
        count += found.count_ones();
        below += (found & !far).count_ones() as usize;
        between += inside.count_ones() as usize;
    }
    let limit_sq = if (count as usize) < k {
        farthest(distances_sq)
    } else if below < k && k <= below + between {
        // SAFETY: that many were written.
        unsafe { some.set_len(between) };
        pad(some);
        let among = Among { low, high: BRACKET[1] * guess_sq, count: between };
        kth_of_few(some, among, k - below).unwrap_or_else(|| kth_least(some, low, k - below))
    } else {
        kth_least(distances_sq.as_flattened(), -1.0, k)
    };
    Found { count, limit_sq }
}

/// Numbers spread over an interval: above `low`, up to `high`.
#[derive(Clone, Copy)]
struct Among {
    low: f32,
    high: f32,
    count: usize,
}

/// Numbers that the `k`-th may be off the place in proportion, more or less.
const ASTRAY: f32 = 6.0;

/// The `k`-th least (from 1) of full lanes of numbers, infinities behind `among.count` of them; where the numbers
/// about the place in proportion are few enough and it is one of them.
#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn kth_of_few(values: &[f32], among: Among, k: usize) -> Option<f32> {
    let (lanes, _) = values.as_chunks::<LANES>();
    let step = (among.high - among.low) / among.count as f32;
    let guess = among.low + step * (k as f32 - 0.5);
    let limit = _mm512_set1_ps(guess);
    let up_to_guess = lanes
        .iter()
        .map(|lanes| _mm512_cmp_ps_mask::<_CMP_LE_OQ>(floats(lanes), limit).count_ones() as usize)
        .sum::<usize>();
    // How many numbers farther up, or down.
    let off = k as f32 - up_to_guess as f32;
    let (low, high) =
        if off > 0.0 { (guess, guess + step * (off + ASTRAY)) } else { (guess + step * (off - ASTRAY), guess) };
    let (low, high) = (_mm512_set1_ps(low), _mm512_set1_ps(high));
    let mut few = [f32::INFINITY; 2 * LANES];
    let (mut below, mut count) = (0, 0);
    for lanes in lanes {
        let v = floats(lanes);
        let above = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(v, low);
        let inside = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(above, v, high);
        if count > LANES {
            return None;
        }
        // SAFETY: sixteen places lie behind the first `count`, which is sixteen at most.
        unsafe {
            _mm512_storeu_ps(
                few.as_mut_ptr().add(count),
                _mm512_mask_compress_ps(_mm512_set1_ps(f32::INFINITY), inside, v),
            )
        };
        below += (!above).count_ones() as usize;
        count += inside.count_ones() as usize;
    }
    if count > LANES || k <= below || k > below + count {
        return None;
    }
    // The largest of those that fewer than `k` are less than; their bits order as they do, as none is negative.
    let few: &[f32; LANES] = few.first_chunk()?;
    let all = floats(few);
    let wanted = (k - below) as u32;
    let rank = |value: f32| _mm512_cmp_ps_mask::<_CMP_LT_OQ>(all, _mm512_set1_ps(value)).count_ones();
    let kth = few.iter().map(|value| if rank(*value) < wanted { value.to_bits() } else { 0 }).max()?;
    Some(f32::from_bits(kth))
}

/// The largest finite number; 0 without any.
#[inline]
#[target_feature(enable = "avx512f")]
fn farthest(distances_sq: &[[f32; LANES]]) -> f32 {
    let infinite = _mm512_set1_ps(f32::INFINITY);
    let largest = distances_sq.iter().fold(_mm512_setzero_ps(), |largest, lanes| {
        let d2 = floats(lanes);
        _mm512_mask_max_ps(largest, _mm512_cmp_ps_mask::<_CMP_LT_OQ>(d2, infinite), largest, d2)
    });
    _mm512_reduce_max_ps(largest)
}

#[target_feature(enable = "avx512f,popcnt")]
fn gather_rows<const KERNEL: u8>(shared: &Shared, query: &PreparedQuery) -> Gathered {
    let r2 = _mm512_set1_ps(query.r2);
    let (inv_r2, inv_k) = (_mm512_set1_ps(query.kernel.inv_r2), _mm512_set1_ps(query.kernel.inv_k));
    let mut flux = [_mm512_setzero_ps(); 3];
    let mut count = 0;
    for (row, d2) in shared.rows().iter().zip(&shared.distances_sq) {
        let d2 = floats(d2);
        let found = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(d2, r2);
        let weight = _mm512_mul_ps(floats(&row.scale), weights::<KERNEL>(d2, inv_r2, inv_k));
        for (sum, mantissas) in flux.iter_mut().zip(&row.mantissas) {
            *sum = _mm512_mask_add_ps(*sum, found, *sum, _mm512_mul_ps(floats(mantissas), weight));
        }
        count += found.count_ones();
    }
    Gathered { flux: Vec3::from_array(flux.map(|sum| tree_sum(sum))) * PLACED_UNITS, count }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Values<'a> = dyn Fn(usize) -> f32 + 'a;

    /// Among numbers spread evenly, in heaps, equal or at the ends of what there is: where it finds the k-th it is
    /// that of a sort, and it finds it where they are spread evenly.
    #[test]
    fn the_kth_of_few_is_that_of_a_sort() {
        if !is_x86_feature_detected!("avx512f") || !is_x86_feature_detected!("bmi1") {
            return;
        }
        let hash = |i: usize| ((i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) as f32 / (1u32 << 24) as f32;
        let spread = |low: f32, high: f32| move |i: usize| low + (high - low) * (hash(i) * 0.998 + 0.001);
        let sets: [([f32; 2], &Values); 7] = [
            ([0.8, 1.25], &spread(0.8, 1.25)),
            ([80.0, 125.0], &|i| 80.0 + (hash(i) * 8.0).floor() * 5.0 + 1.0),
            ([0.8, 1.25], &|_| 1.0),
            ([0.8, 1.25], &|i| if i % 2 == 0 { 0.81 } else { 1.24 }),
            ([2.6e38, 3.4e38], &spread(2.6e38, 3.4e38)),
            ([0.8e-44, 1.25e-44], &|_| 1.1e-44),
            ([0.0, 0.0], &|_| 0.0),
        ];
        for (number, ([low, high], value)) in sets.into_iter().enumerate() {
            let (mut found, mut asked) = (0, 0);
            for count in [1, 2, 15, 16, 17, 40, 100] {
                let mut values: Vec<f32> = (0..count).map(value).collect();
                let mut sorted = values.clone();
                sorted.sort_unstable_by(f32::total_cmp);
                pad(&mut values);
                for k in 1..=count {
                    // SAFETY: the processor has AVX-512F and BMI1, and with the first POPCNT.
                    let kth = unsafe { kth_of_few(&values, Among { low, high, count }, k) };
                    assert!(kth.is_none_or(|kth| kth == sorted[k - 1]), "set {number}: {k} of {count}: {kth:?}");
                    (found, asked) = (found + usize::from(kth.is_some()), asked + 1);
                }
            }
            if number == 0 {
                assert!(found * 10 > asked * 9, "{found} of {asked}");
            }
            if number == 2 {
                assert!(found < asked, "more than sixteen equal numbers are too many");
            }
        }
    }
}
