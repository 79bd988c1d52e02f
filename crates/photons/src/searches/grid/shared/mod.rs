//! Photons that neighbouring queries share: those around all of them, with their fields taken apart, so that each query tests
//! a few hundred photons that are near instead of looking blocks up.
//!
//! Sums must not depend on the company in which a query asks. Where weights are constant and fluxes are of like size,
//! sums are exact in whatever order they are made, and photons lie densely. Elsewhere a photon keeps the lane that it has
//! in its block and stays behind those of its lane in earlier blocks, so that sums add the same numbers in the same order
//! as over the blocks themselves.

#[cfg(target_arch = "x86_64")]
pub(crate) mod avx2;
#[cfg(target_arch = "x86_64")]
pub(crate) mod avx512;

use super::blocks::{Block, LANES};
use super::even::{EvenSums, Octaves, rounded};
use super::kernels::SharedKernels;
use super::kth::kth_least;
use super::scalar::tree_sum;
use crate::Kernel;
use crate::flux::{PLACED_UNITS, placed_mantissas, raw_scale, whole};
use crate::inclusion::PreparedQuery;
use crate::octahedral::decode_scaled;
use crate::photon::{NORMAL_MAX, normal_code};
use crate::{Gathered, GatheredNearest};
use photinus_geometry::Vec3;

/// The kernels a lane at a time, and as much at a time as the compiler sees fit.
pub(crate) const SCALAR: SharedKernels = SharedKernels { collect, nearest, gather, gather_few };

type Lanes = [f32; LANES];

/// Photons, one a lane, with their fields taken apart.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Row {
    /// NaN where the lane is empty, which no query finds.
    pub(crate) position: [Lanes; 3],
    /// Normal of any length, and a quarter of that length squared: what the inclusion test compares.
    pub(crate) normal: [Lanes; 3],
    pub(crate) quarter: Lanes,
    /// Flux as [`crate::flux`] has it: raw scale, and mantissas in their places.
    pub(crate) scale: Lanes,
    pub(crate) mantissas: [Lanes; 3],
    /// The same where photons lie densely: packed, and as whole numbers in units that all rows share.
    pub(crate) words: [u32; LANES],
    pub(crate) whole: [[u32; LANES]; 3],
}

impl Row {
    pub(crate) const EMPTY: Self = Self {
        position: [[f32::NAN; LANES]; 3],
        normal: [[0.0; LANES]; 3],
        quarter: [0.0; LANES],
        scale: [0.0; LANES],
        mantissas: [[0.0; LANES]; 3],
        words: [0; LANES],
        whole: [[0; LANES]; 3],
    };

    /// Puts the photon that has lane `from` in its block into a lane.
    fn set(&mut self, lane: usize, block: &Block, from: usize) {
        let normal = decode_scaled(normal_code(block.surface[from]), NORMAL_MAX);
        let mantissas = placed_mantissas(block.flux[from]);
        for axis in 0..3 {
            self.position[axis][lane] = [block.x, block.y, block.z][axis][from];
            self.normal[axis][lane] = normal[axis];
            self.mantissas[axis][lane] = mantissas[axis];
        }
        self.quarter[lane] = 0.25 * ((normal.x * normal.x + normal.y * normal.y) + normal.z * normal.z);
        self.scale[lane] = raw_scale(block.flux[from]);
        self.words[lane] = block.flux[from];
    }

    #[inline(always)]
    fn distance_sq(&self, lane: usize, p: Vec3) -> f32 {
        let d = [self.position[0][lane] - p.x, self.position[1][lane] - p.y, self.position[2][lane] - p.z];
        (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]
    }

    #[inline(always)]
    fn within_60(&self, lane: usize, n: Vec3) -> bool {
        let dot = (self.normal[0][lane] * n.x + self.normal[1][lane] * n.y) + self.normal[2][lane] * n.z;
        (dot > 0.0) & (dot * dot >= self.quarter[lane])
    }

    /// Makes whole numbers of packed fluxes.
    #[inline(always)]
    fn make_whole(&mut self, least: u32) {
        for lane in 0..LANES {
            let channels = whole(self.words[lane], least);
            (0..3).for_each(|c| self.whole[c][lane] = channels[c]);
        }
    }
}

/// Which photons are shared: those that a query finds which stands for all, with its ball and its depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Share {
    pub(crate) query: PreparedQuery,
    /// Whether all queries have its normal: photons are then tested for it once.
    pub(crate) same_normal: bool,
    /// Where they have not: the least cosine, squared with its sign, between its normal and that of a photon that may pass
    /// the test of any.
    pub(crate) least_cos: f32,
}

impl Share {
    /// Whether all photons weigh the same.
    fn is_even(&self) -> bool {
        self.query.kernel.kernel == Kernel::Constant
    }

    /// The photons that are shared: their blocks and lanes.
    #[inline(always)]
    fn wanted<'b>(&self, blocks: &'b [Block], hits: &[u32]) -> impl Iterator<Item = (&'b Block, usize)> {
        let query = &self.query;
        hits.iter().map(|block| &blocks[*block as usize]).flat_map(move |block| {
            let near = block.distances_sq(query.position).map(|d2| d2 <= query.r2);
            (0..LANES)
                .filter(move |lane| near[*lane] && self.wants(block.surface[*lane]))
                .map(move |lane| (block, lane))
        })
    }

    /// Whether a photon with this surface word may pass the tests of some query.
    fn wants(&self, surface: u32) -> bool {
        if self.same_normal {
            self.query.accepts(surface)
        } else {
            self.query.is_shallow(surface) && self.may_face(surface)
        }
    }

    /// Whether a photon of this normal may be within 60 degrees of some query's.
    fn may_face(&self, surface: u32) -> bool {
        let (v, n) = (decode_scaled(normal_code(surface), NORMAL_MAX), self.query.normal);
        let cos = (v.x * n.x + v.y * n.y) + v.z * n.z;
        cos * cos.abs() >= self.least_cos * ((v.x * v.x + v.y * v.y) + v.z * v.z)
    }
}

/// The photons shared, and what the last query found among them.
#[derive(Debug, Default)]
pub(crate) struct Shared {
    /// Rows in use, and behind them others that keep their memory.
    rows: Vec<Row>,
    /// Photons in each row in use, a bit a lane.
    filled: Vec<u16>,
    /// Rows that each lane fills.
    heights: [u32; LANES],
    /// Whether the normals of `rows` have passed the test.
    same_normal: bool,
    /// The octave in whose units fluxes are, where photons lie densely.
    least_octave: Option<u32>,
    /// Squared distance of each lane of each row where it is found, infinite elsewhere.
    distances_sq: Vec<Lanes>,
}

/// What a query for the nearest found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Found {
    /// Within the query's own radius.
    pub(crate) count: u32,
    /// Squared distance of the `k`-th, or of the farthest where there are fewer; 0 without any.
    pub(crate) limit_sq: f32,
}

/// See [`super::kernels::Collect`].
#[inline(always)]
fn collect(blocks: &[Block], hits: &[u32], share: &Share, shared: &mut Shared) {
    if !(share.is_even() && collect_densely(blocks, hits, share, shared)) {
        collect_by_lanes(blocks, hits, share, shared);
    }
}

/// Collects photons one behind the other; false where their sums may not be exact.
#[inline(always)]
fn collect_densely(blocks: &[Block], hits: &[u32], share: &Share, shared: &mut Shared) -> bool {
    shared.start(share);
    let (mut count, mut octaves) = (0, Octaves::NONE);
    for (block, lane) in share.wanted(blocks, hits) {
        let (row, place) = (count / LANES, count % LANES);
        if row == shared.filled.len() {
            shared.add_row();
        }
        shared.filled[row] |= 1 << place;
        shared.rows[row].set(place, block, lane);
        octaves = octaves.with(block.flux[lane]);
        count += 1;
    }
    shared.make_whole(octaves, count)
}

/// Collects photons in the lanes of their blocks.
#[inline(always)]
fn collect_by_lanes(blocks: &[Block], hits: &[u32], share: &Share, shared: &mut Shared) {
    shared.start(share);
    for (block, lane) in share.wanted(blocks, hits) {
        let height = shared.heights[lane] as usize;
        if height == shared.filled.len() {
            shared.add_row();
        }
        shared.heights[lane] += 1;
        shared.filled[height] |= 1 << lane;
        shared.rows[height].set(lane, block, lane);
    }
}

/// See [`super::kernels::Nearest`].
#[inline(always)]
fn nearest(shared: &mut Shared, query: &PreparedQuery, k: usize, _: f32) -> Found {
    shared.distances_sq.clear();
    let mut counts = [0u32; LANES];
    let mut farthest = [0f32; LANES];
    for row in &shared.rows[..shared.filled.len()] {
        let mut out = [0f32; LANES];
        for i in 0..LANES {
            let d2 = row.distance_sq(i, query.position);
            let is_found = (d2 <= query.r2) & (shared.same_normal | row.within_60(i, query.normal));
            out[i] = if is_found { d2 } else { f32::INFINITY };
            counts[i] += u32::from(is_found);
            farthest[i] = if is_found & (d2 > farthest[i]) { d2 } else { farthest[i] };
        }
        shared.distances_sq.push(out);
    }
    let count = counts.into_iter().sum::<u32>();
    let limit_sq = if count as usize >= k {
        kth_least(shared.distances_sq.as_flattened(), -1.0, k)
    } else {
        farthest.into_iter().fold(0f32, |a, b| if b > a { b } else { a })
    };
    Found { count, limit_sq }
}

/// See [`super::kernels::GatherShared`].
#[inline(always)]
fn gather(shared: &Shared, query: &PreparedQuery) -> Gathered {
    match shared.least_octave {
        Some(least) => gather_whole(shared, query.r2, least),
        None if query.kernel.kernel == Kernel::Constant => gather_evenly(shared, query.r2),
        None => gather_lanes(shared, query),
    }
}

#[inline(always)]
fn gather_whole(shared: &Shared, r2: f32, least: u32) -> Gathered {
    let (mut sums, mut count) = ([0u32; 3], 0);
    for (row, d2) in shared.rows().iter().zip(&shared.distances_sq) {
        for lane in 0..LANES {
            let is_found = d2[lane] <= r2;
            for (sum, whole) in sums.iter_mut().zip(&row.whole) {
                *sum += if is_found { whole[lane] } else { 0 };
            }
            count += u32::from(is_found);
        }
    }
    rounded(sums, least, count)
}

/// See [`super::kernels::GatherFew`].
#[inline(always)]
fn gather_few(shared: &Shared, query: &PreparedQuery, k: usize) -> Option<GatheredNearest> {
    let least = shared.least_octave?;
    let (mut sums, mut count, mut farthest_sq) = ([0u32; 3], 0, 0f32);
    for row in shared.rows() {
        for lane in 0..LANES {
            let d2 = row.distance_sq(lane, query.position);
            let is_found = (d2 <= query.r2) & (shared.same_normal | row.within_60(lane, query.normal));
            for (sum, whole) in sums.iter_mut().zip(&row.whole) {
                *sum = sum.wrapping_add(if is_found { whole[lane] } else { 0 });
            }
            count += u32::from(is_found);
            farthest_sq = if is_found & (d2 > farthest_sq) { d2 } else { farthest_sq };
        }
    }
    let Gathered { flux, count } = rounded(sums, least, count);
    ((count as usize) < k).then_some(GatheredNearest { flux, count, farthest_sq })
}

/// In the order of [`super::even::gather_selected`].
#[inline(always)]
fn gather_evenly(shared: &Shared, r2: f32) -> Gathered {
    let mut sums = EvenSums::default();
    for (row, d2) in shared.rows().iter().zip(&shared.distances_sq) {
        for lane in 0..LANES {
            sums.add(lane, d2[lane] <= r2, row.mantissas.map(|mantissas| mantissas[lane]), row.scale[lane]);
        }
    }
    sums.gathered()
}

#[inline(always)]
fn gather_lanes(shared: &Shared, query: &PreparedQuery) -> Gathered {
    let mut flux = [[0f32; LANES]; 3];
    let mut count = 0;
    for (row, d2) in shared.rows().iter().zip(&shared.distances_sq) {
        for lane in (0..LANES).filter(|lane| d2[*lane] <= query.r2) {
            let weight = row.scale[lane] * query.kernel.weight(d2[lane]);
            for (sum, mantissa) in flux.iter_mut().zip(&row.mantissas) {
                sum[lane] += mantissa[lane] * weight;
            }
            count += 1;
        }
    }
    Gathered { flux: Vec3::from_array(flux.map(tree_sum)) * PLACED_UNITS, count }
}

impl Shared {
    /// Forgets what was shared.
    #[inline]
    fn start(&mut self, share: &Share) {
        self.filled.clear();
        self.heights = [0; LANES];
        self.same_normal = share.same_normal;
        self.least_octave = None;
    }

    /// Turns the fluxes of rows that are filled densely into whole numbers; false where they do not fit.
    #[inline(always)]
    fn make_whole(&mut self, octaves: Octaves, count: usize) -> bool {
        let fit = octaves.fit(count);
        if fit {
            let rows = self.filled.len();
            self.rows[..rows].iter_mut().for_each(|row| row.make_whole(octaves.least));
            self.least_octave = Some(octaves.least);
        }
        fit
    }

    /// Takes an empty row into use.
    #[inline]
    fn add_row(&mut self) {
        match self.rows.get_mut(self.filled.len()) {
            Some(row) => row.position[0] = [f32::NAN; LANES],
            None => self.rows.push(Row::EMPTY),
        }
        self.filled.push(0);
    }

    /// The rows in use.
    #[inline]
    fn rows(&self) -> &[Row] {
        &self.rows[..self.filled.len()]
    }

    /// Photons that a query tests.
    pub(crate) fn photons(&self) -> u64 {
        self.filled.iter().map(|filled| u64::from(filled.count_ones())).sum()
    }
}
