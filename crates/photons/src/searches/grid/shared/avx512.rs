//! Shared photons with 512-bit vectors: a row a vector.
//!
//! No fused multiply-add: every operation rounds as the scalar kernel's does.

use super::{Found, Row, Share, Shared};
use crate::flux::{MANTISSA_MASKS, PLACED_UNITS, RAW_SCALE_MASK};
use crate::inclusion::PreparedQuery;
use crate::photon::LOW_MASK;
use crate::searches::grid::avx512::{distances_sq, dot, floats, normals, splat, tree_sum, weights, words};
use crate::searches::grid::blocks::{Block, LANES};
use crate::searches::grid::even::{Octaves, rounded};
use crate::searches::grid::kernels::{CONE, CONSTANT, EPANECHNIKOV, GAUSSIAN, SharedKernels, kernel_index};
use crate::searches::grid::kth::kth_least;
use crate::{Gathered, GatheredNearest};
use photinus_geometry::Vec3;
use std::arch::x86_64::*;

/// For processors that have AVX-512F, POPCNT and BMI1.
pub(crate) const KERNELS: SharedKernels = SharedKernels { collect, nearest, gather, gather_few };

/// Parts of the guess between two of which the `k`-th squared distance is looked for: where neighbours ask it is there
/// nineteen times in twenty, and with it some ten others.
const BRACKETS: [f32; 3] = [0.9, 1.0, 1.1];

fn collect(blocks: &[Block], hits: &[u32], share: &Share, shared: &mut Shared) {
    // SAFETY: these kernels are handed out only where the processor has AVX-512F, POPCNT and BMI1.
    unsafe {
        if !(share.is_even() && collect_densely(blocks, hits, share, shared)) {
            collect_by_lanes(blocks, hits, share, shared);
        }
    }
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
        if let Some(least) = shared.least_octave {
            return gather_whole(shared, query.r2, least);
        }
        match kernel_index(query.kernel.kernel) {
            CONSTANT => gather_evenly(shared, query.r2),
            CONE => gather_rows::<CONE>(shared, query),
            EPANECHNIKOV => gather_rows::<EPANECHNIKOV>(shared, query),
            _ => gather_rows::<GAUSSIAN>(shared, query),
        }
    }
}

fn gather_few(shared: &Shared, query: &PreparedQuery, k: usize) -> Option<GatheredNearest> {
    let least = shared.least_octave?;
    // SAFETY: as above.
    unsafe {
        if shared.same_normal {
            few_rows::<true>(shared, query, k, least)
        } else {
            few_rows::<false>(shared, query, k, least)
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
fn set_floats(places: &mut [[f32; LANES]], lanes: __mmask16, fields: &[__m512]) {
    for (place, field) in places.iter_mut().zip(fields) {
        // SAFETY: the array holds the sixteen numbers of which some are written.
        unsafe { _mm512_mask_storeu_ps(place.as_mut_ptr(), lanes, *field) };
    }
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

/// Tells which photons are shared.
struct Wanted<'a> {
    share: &'a Share,
    position: [__m512; 3],
    facing: [__m512; 3],
    r2: __m512,
    low_limit: __m512i,
    least_cos: __m512,
}

impl<'a> Wanted<'a> {
    #[inline]
    #[target_feature(enable = "avx512f")]
    fn new(share: &'a Share) -> Self {
        let query = &share.query;
        Self {
            share,
            position: splat(query.position),
            facing: splat(query.normal),
            r2: _mm512_set1_ps(query.r2),
            low_limit: _mm512_set1_epi32(query.low_limit as i32),
            least_cos: _mm512_set1_ps(share.least_cos),
        }
    }

    /// The lanes of a block that are, and the normals and quarters that a row holds of it.
    #[inline]
    #[target_feature(enable = "avx512f")]
    fn of(&self, block: &Block) -> Option<(__mmask16, [__m512; 3], __m512)> {
        let near = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(distances_sq(block, self.position), self.r2);
        if near == 0 {
            return None;
        }
        let surface = words(&block.surface);
        let low = _mm512_and_si512(surface, _mm512_set1_epi32(LOW_MASK as i32));
        let shallow = _mm512_mask_cmple_epu32_mask(near, low, self.low_limit);
        let normal = normals(surface);
        let length_sq = dot(normal, normal);
        let quarter = _mm512_mul_ps(_mm512_set1_ps(0.25), length_sq);
        let wanted = if self.share.same_normal {
            within_60(shallow, normal, quarter, self.facing)
        } else {
            let cos = dot(normal, self.facing);
            let least = _mm512_mul_ps(self.least_cos, length_sq);
            _mm512_mask_cmp_ps_mask::<_CMP_GE_OQ>(shallow, _mm512_mul_ps(cos, _mm512_abs_ps(cos)), least)
        };
        Some((wanted, normal, quarter))
    }
}

#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn collect_densely(blocks: &[Block], hits: &[u32], share: &Share, shared: &mut Shared) -> bool {
    shared.start(share);
    let of = Wanted::new(share);
    let lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    let one = _mm512_set1_epi32(1);
    // Less one: black, which is of no octave, is then above all others.
    let (mut least, mut most) = (_mm512_set1_epi32(-1), _mm512_setzero_si512());
    let mut count = 0;
    for block in hits {
        let block = &blocks[*block as usize];
        let Some((wanted, normal, quarter)) = of.of(block) else { continue };
        let words = words(&block.flux);
        let octaves = _mm512_srli_epi32::<25>(words);
        least = _mm512_mask_min_epu32(least, wanted, least, _mm512_sub_epi32(octaves, one));
        most = _mm512_mask_max_epu32(most, wanted, most, octaves);
        // The photons that are wanted, from the first free place on; of an index the lowest four bits count.
        let (row, place, more) = (count / LANES, count % LANES, wanted.count_ones() as usize);
        let packed = _mm512_maskz_compress_epi32(wanted, lanes);
        let from = _mm512_permutexvar_epi32(_mm512_sub_epi32(lanes, _mm512_set1_epi32(place as i32)), packed);
        let turned = |field| _mm512_permutexvar_ps(from, field);
        let position = [turned(floats(&block.x)), turned(floats(&block.y)), turned(floats(&block.z))];
        let facing = (!share.same_normal).then(|| (normal.map(&turned), turned(quarter)));
        let words = _mm512_permutexvar_epi32(from, words);
        let places = ((1u32 << more) - 1) << place;
        while shared.filled.len() * LANES < count + more {
            shared.add_row();
        }
        for (row, places) in [(row, places as u16), (row + 1, (places >> LANES) as u16)] {
            if places != 0 {
                shared.filled[row] |= places;
                let row = &mut shared.rows[row];
                set_floats(&mut row.position, places, &position);
                // SAFETY: the array holds the sixteen numbers of which some are written.
                unsafe { _mm512_mask_storeu_epi32(row.words.as_mut_ptr().cast(), places, words) };
                if let Some((normal, quarter)) = &facing {
                    set_floats(&mut row.normal, places, normal);
                    set_floats(std::slice::from_mut(&mut row.quarter), places, std::slice::from_ref(quarter));
                }
            }
        }
        count += more;
    }
    let (least, most) = (_mm512_reduce_min_epu32(least), _mm512_reduce_max_epu32(most));
    shared.make_whole(Octaves { least: least.saturating_add(1), most }, count)
}

#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn collect_by_lanes(blocks: &[Block], hits: &[u32], share: &Share, shared: &mut Shared) {
    shared.start(share);
    let of = Wanted::new(share);
    let mut heights = _mm512_setzero_si512();
    for block in hits {
        let block = &blocks[*block as usize];
        let Some((mut wanted, normal, quarter)) = of.of(block) else { continue };
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

/// The lanes of a row that a query finds, and the squared distances of all.
#[inline]
#[target_feature(enable = "avx512f")]
fn found_of<const SAME_NORMAL: bool>(
    row: &Row,
    position: [__m512; 3],
    facing: [__m512; 3],
    r2: __m512,
) -> (__mmask16, __m512) {
    let [x, y, z] = &row.position;
    let d = [
        _mm512_sub_ps(floats(x), position[0]),
        _mm512_sub_ps(floats(y), position[1]),
        _mm512_sub_ps(floats(z), position[2]),
    ];
    let d2 = dot(d, d);
    let found = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(d2, r2);
    if SAME_NORMAL {
        return (found, d2);
    }
    let [x, y, z] = &row.normal;
    (within_60(found, [floats(x), floats(y), floats(z)], floats(&row.quarter), facing), d2)
}

#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn few_rows<const SAME_NORMAL: bool>(
    shared: &Shared,
    query: &PreparedQuery,
    k: usize,
    least: u32,
) -> Option<GatheredNearest> {
    let (position, facing, r2) = (splat(query.position), splat(query.normal), _mm512_set1_ps(query.r2));
    let (mut sums, one) = ([_mm512_setzero_si512(); 3], _mm512_set1_epi32(1));
    let (mut counts, mut farthest) = (_mm512_setzero_si512(), _mm512_setzero_ps());
    for row in shared.rows() {
        let (found, d2) = found_of::<SAME_NORMAL>(row, position, facing, r2);
        for (sum, whole) in sums.iter_mut().zip(&row.whole) {
            *sum = _mm512_mask_add_epi32(*sum, found, *sum, words(whole));
        }
        counts = _mm512_mask_add_epi32(counts, found, counts, one);
        farthest = _mm512_mask_max_ps(farthest, found, farthest, d2);
    }
    let count = _mm512_reduce_add_epi32(counts) as u32;
    if count as usize >= k {
        return None;
    }
    let Gathered { flux, count } = rounded(sums.map(|sum| _mm512_reduce_add_epi32(sum) as u32), least, count);
    Some(GatheredNearest { flux, count, farthest_sq: _mm512_reduce_max_ps(farthest) })
}

#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn nearest_rows<const SAME_NORMAL: bool>(shared: &mut Shared, query: &PreparedQuery, k: usize, guess_sq: f32) -> Found {
    let (position, facing, r2) = (splat(query.position), splat(query.normal), _mm512_set1_ps(query.r2));
    let limits = BRACKETS.map(|part| _mm512_set1_ps(part * guess_sq));
    let infinite = _mm512_set1_ps(f32::INFINITY);
    let rows = shared.filled.len();
    let Shared { rows: all_rows, distances_sq, .. } = shared;
    distances_sq.resize(rows, [0.0; LANES]);
    // By lane: of all found, and of those up to each limit.
    let (mut counts, one) = ([_mm512_setzero_si512(); 4], _mm512_set1_epi32(1));
    let mut farthest = _mm512_setzero_ps();
    for (row, out) in all_rows[..rows].iter().zip(&mut *distances_sq) {
        let (found, d2) = found_of::<SAME_NORMAL>(row, position, facing, r2);
        // SAFETY: the array holds the sixteen numbers written.
        unsafe { _mm512_storeu_ps(out.as_mut_ptr(), _mm512_mask_blend_ps(found, infinite, d2)) };
        let up_to = |limit| _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(found, d2, limit);
        let lanes = [found, up_to(limits[0]), up_to(limits[1]), up_to(limits[2])];
        for (count, lanes) in counts.iter_mut().zip(lanes) {
            *count = _mm512_mask_add_epi32(*count, lanes, *count, one);
        }
        farthest = _mm512_mask_max_ps(farthest, found, farthest, d2);
    }
    let [count, up_to @ ..] = counts.map(|lanes| _mm512_reduce_add_epi32(lanes) as usize);
    let limit_sq = if count < k {
        _mm512_reduce_max_ps(farthest)
    } else {
        let upper = if k <= up_to[1] { 1 } else { 2 };
        let (below, within) = (up_to[upper - 1], up_to[upper]);
        if below < k && k <= within && within - below <= LANES {
            kth_of_few(distances_sq, [limits[upper - 1], limits[upper]], k - below)
        } else {
            kth_least(distances_sq.as_flattened(), -1.0, k)
        }
    };
    Found { count: count as u32, limit_sq }
}

/// The `k`-th least (from 1) of the numbers above the first and up to the second limit, of which there are that many
/// at least and sixteen at most.
#[target_feature(enable = "avx512f,popcnt,bmi1")]
fn kth_of_few(values: &[[f32; LANES]], [low, high]: [__m512; 2], k: usize) -> f32 {
    let infinite = _mm512_set1_ps(f32::INFINITY);
    let mut few = [f32::INFINITY; 2 * LANES];
    let mut count = 0;
    for lanes in values {
        let v = floats(lanes);
        let above = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(v, low);
        let inside = _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(above, v, high);
        let place = &mut few[count..][..LANES];
        // SAFETY: the slice holds the sixteen numbers written.
        unsafe { _mm512_storeu_ps(place.as_mut_ptr(), _mm512_mask_compress_ps(infinite, inside, v)) };
        count += inside.count_ones() as usize;
    }
    // SAFETY: the array holds the sixteen numbers read.
    let few = unsafe { _mm512_loadu_ps(few.as_ptr()) };
    // Each is compared with the fifteen others in turn: how many are less.
    let one = _mm512_set1_epi32(1);
    let mut turned = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    let mut ranks = _mm512_setzero_si512();
    for _ in 1..LANES {
        turned = _mm512_add_epi32(turned, one);
        // Of an index its lowest four bits count.
        let less = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(_mm512_permutexvar_ps(turned, few), few);
        ranks = _mm512_mask_add_epi32(ranks, less, ranks, one);
    }
    // The largest of those that fewer than `k` are less than.
    let low_ranks = _mm512_cmplt_epi32_mask(ranks, _mm512_set1_epi32(k as i32));
    _mm512_mask_reduce_max_ps(low_ranks, few)
}

#[target_feature(enable = "avx512f,popcnt")]
fn gather_whole(shared: &Shared, r2: f32, least: u32) -> Gathered {
    let r2 = _mm512_set1_ps(r2);
    let mut sums = [_mm512_setzero_si512(); 3];
    let mut count = 0;
    for (row, d2) in shared.rows().iter().zip(&shared.distances_sq) {
        let found = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(floats(d2), r2);
        for (sum, whole) in sums.iter_mut().zip(&row.whole) {
            *sum = _mm512_mask_add_epi32(*sum, found, *sum, words(whole));
        }
        count += found.count_ones();
    }
    rounded(sums.map(|sum| _mm512_reduce_add_epi32(sum) as u32), least, count)
}

#[target_feature(enable = "avx512f,popcnt")]
fn gather_evenly(shared: &Shared, r2: f32) -> Gathered {
    super::gather_evenly(shared, r2)
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

    /// Among numbers spread evenly, in heaps, equal or at the ends of what there is, in lanes filled and not.
    #[test]
    fn the_kth_of_few_is_that_of_a_sort() {
        if !is_x86_feature_detected!("avx512f") || !is_x86_feature_detected!("bmi1") {
            return;
        }
        let hash = |i: usize| ((i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) as f32 / (1u32 << 24) as f32;
        let sets: [([f32; 2], &Values); 6] = [
            ([0.8, 1.25], &|i| 0.81 + 0.44 * hash(i)),
            ([80.0, 125.0], &|i| 81.0 + (hash(i) * 8.0).floor() * 5.0),
            ([0.8, 1.25], &|_| 1.0),
            ([0.8, 1.25], &|i| if i % 2 == 0 { 0.8f32.next_up() } else { 1.25 }),
            ([2.6e38, f32::MAX], &|i| if i % 3 == 0 { f32::MAX } else { 3e38 }),
            ([0.0, 1e-44], &|i| f32::from_bits(1 + i as u32 % 7)),
        ];
        for (number, ([low, high], value)) in sets.into_iter().enumerate() {
            for count in 1..=LANES {
                let few: Vec<f32> = (0..count).map(value).collect();
                let mut sorted = few.clone();
                sorted.sort_unstable_by(f32::total_cmp);
                for rows in [1, 2, 5] {
                    // Others below, above and of empty lanes stand between them.
                    let mut all = vec![[low, f32::INFINITY, f32::INFINITY, low]; rows * LANES / 4].concat();
                    let step = all.len() / count;
                    few.iter().enumerate().for_each(|(i, value)| all[i * step] = *value);
                    let limits = [low, high];
                    for k in 1..=count {
                        // SAFETY: the processor has AVX-512F and BMI1, and with the first POPCNT.
                        let kth = unsafe {
                            kth_of_few(all.as_chunks::<LANES>().0, limits.map(|limit| _mm512_set1_ps(limit)), k)
                        };
                        assert_eq!(kth, sorted[k - 1], "set {number}: {k} of {count} in {rows} rows");
                    }
                }
            }
        }
    }
}
