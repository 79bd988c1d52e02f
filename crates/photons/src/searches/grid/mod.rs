//! A sorted uniform grid: photons in the order of their cells, in blocks of sixteen; the renderer's own search.
//!
//! The search of Teschner et al., "Optimized Spatial Hashing for Collision Detection of Deformable Objects" (VMV
//! 2003), over photons that are sorted as in Green, "Particle Simulation using CUDA" (2010), but in Morton order and
//! with a box around each sixteen: a query looks up the cells around it, keeps the blocks whose boxes it reaches and
//! reads those photons sixteen at a time.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod blocks;
mod cells;
mod kernels;
mod scalar;
mod sort;
mod table;
#[cfg(test)]
mod tests;

use crate::inclusion::{PreparedQuery, radius_sq};
use crate::{BuildOptions, GatherQuery, Gathered, Kernel, Neighbor, Photon, Search, SearchSummary};
use blocks::{Block, Boxes, LANES};
use cells::{Cells, Reached};
use kernels::{Candidates, NormalMemo, VectorKernels};
use photinus_geometry::{Aabb, Vec3};
use photinus_profile::SearchCounters;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::OnceLock;
use table::CellTable;

pub(crate) const ABOUT: &str = "sorted uniform grid with vector kernels";

/// Queries that are worth a task of their own.
const QUERIES_A_TASK: usize = 512;

/// The finished grid.
pub(crate) struct Grid {
    /// `None` where the photons' box is too large for cells, or there are none: every query then reads all blocks.
    index: Option<(Cells, CellTable)>,
    blocks: Vec<Block>,
    boxes: Boxes,
    /// The id of each slot's photon, padded to whole blocks.
    ids: Vec<u32>,
    photon_count: usize,
    /// The slot of each id's photon; made when first asked for.
    slots: OnceLock<Vec<u32>>,
    kernels: VectorKernels,
}

/// What one query hands to the next, so that neighbours share work; results do not depend on it.
struct Scratch {
    /// The half cell and the radius (fine cells) that `ranges` are for.
    half_cell: Vec3,
    radius: f32,
    /// Blocks of the cells around, as ascending ranges that do not overlap.
    ranges: Vec<Range<u32>>,
    /// Blocks in reach of the query.
    hits: Vec<u32>,
    memo: NormalMemo,
}

impl Scratch {
    fn new() -> Self {
        Self { half_cell: Vec3::NAN, radius: -1.0, ranges: Vec::new(), hits: Vec::new(), memo: NormalMemo::NONE }
    }
}

impl Grid {
    pub(crate) fn new(photons: &[Photon], options: &BuildOptions) -> Self {
        Self::with_kernels(photons, options, kernels::available()[0])
    }

    fn with_kernels(photons: &[Photon], options: &BuildOptions, kernels: VectorKernels) -> Self {
        let bounds = Aabb::around(photons.iter().map(Photon::position));
        let radius = options.radius().unwrap_or_else(|| typical_radius(bounds, photons.len()));
        let cells = Cells::new(bounds, radius);
        let key = |p: &Photon| cells.as_ref().map_or(0, |c| c.key(p.position()));
        let keyed: Vec<sort::Keyed> = (0u32..).zip(photons).map(|(id, p)| (key(p), id)).collect();
        let keyed = sort::sort_by_key(keyed, cells.map_or(1, |c| c.key_end()));
        let index = cells.map(|c| (c, CellTable::new(&c, keyed.iter().map(|k| k.0))));
        let mut blocks = vec![Block::EMPTY; photons.len().div_ceil(LANES)];
        let mut ids = vec![u32::MAX; blocks.len() * LANES];
        for ((block, keyed), ids) in blocks.iter_mut().zip(keyed.chunks(LANES)).zip(ids.chunks_mut(LANES)) {
            for (lane, (_, id)) in keyed.iter().enumerate() {
                block.set(lane, &photons[*id as usize]);
                ids[lane] = *id;
            }
        }
        let boxes = Boxes::around(&blocks);
        Self { index, blocks, boxes, ids, photon_count: photons.len(), slots: OnceLock::new(), kernels }
    }

    /// Fills `scratch.hits` with the blocks that hold every photon within a radius of a position, ascending.
    #[inline]
    fn find_blocks(&self, position: Vec3, radius: f32, r2: f32, scratch: &mut Scratch) {
        scratch.hits.clear();
        if !(r2 >= 0.0) {
            return;
        }
        if let Some((cells, table)) = &self.index {
            let half_cell = Cells::half_cell(cells.place(position));
            let radius = cells.radius(radius);
            // Not equal where either is NaN.
            if half_cell != scratch.half_cell || !(radius <= scratch.radius) {
                (scratch.half_cell, scratch.radius) = (half_cell, radius);
                self.collect_ranges(cells, table, scratch);
            }
        } else {
            scratch.ranges.clear();
            scratch.ranges.push(0..self.blocks.len() as u32);
        }
        (self.kernels.cull)(&self.boxes, &scratch.ranges, position, r2, &mut scratch.hits);
    }

    /// The blocks of the cells that balls of `scratch.radius` around `scratch.half_cell` may touch.
    fn collect_ranges(&self, cells: &Cells, table: &CellTable, scratch: &mut Scratch) {
        let ranges = &mut scratch.ranges;
        ranges.clear();
        let everything = match cells.reached(scratch.half_cell, scratch.radius) {
            Reached::Nothing => return,
            Reached::Cells(reached) => !table.collect(cells, reached, ranges),
            Reached::Everything => true,
        };
        if everything {
            ranges.push(0..self.blocks.len() as u32);
            return;
        }
        ranges.sort_unstable_by_key(|slots| slots.start);
        // Slots to blocks: a block may hold photons of several cells.
        let lanes = LANES as u32;
        let mut end = 0;
        ranges.retain_mut(|slots| {
            let blocks = (slots.start / lanes).max(end)..slots.end.div_ceil(lanes);
            end = end.max(blocks.end);
            *slots = blocks;
            !slots.is_empty()
        });
    }
}

/// A radius that holds a few dozen photons where they lie evenly on the faces of their box.
fn typical_radius(bounds: Aabb, photons: usize) -> f32 {
    let area = 2.0 * bounds.half_area();
    let radius = (area * 32.0 / photons as f32).sqrt();
    // Photons on a line or at a point have no area.
    if radius > 0.0 && radius.is_finite() { radius } else { bounds.diagonal() / 256.0 }
}

impl Search for Grid {
    fn gather(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        assert_eq!(queries.len(), out.len(), "one result a query");
        let one = |scratch: &mut Scratch, (query, out): (&GatherQuery, &mut Gathered)| {
            let prepared = PreparedQuery::new(query, kernel);
            self.find_blocks(query.position, query.radius, prepared.r2, scratch);
            *out = (self.kernels.gather)(&self.blocks, &scratch.hits, &prepared, &mut scratch.memo);
        };
        queries.par_iter().zip(out).with_min_len(QUERIES_A_TASK).for_each_init(Scratch::new, one);
    }

    fn gather_counted(
        &self,
        queries: &[GatherQuery],
        kernel: Kernel,
        out: &mut [Gathered],
        counters: &mut SearchCounters,
    ) {
        self.gather(queries, kernel, out);
        let mut scratch = Scratch::new();
        let padding = self.blocks.len() * LANES - self.photon_count;
        for (query, out) in queries.iter().zip(out) {
            let r2 = radius_sq(query.position, query.radius);
            self.find_blocks(query.position, query.radius, r2, &mut scratch);
            let lanes = scratch.hits.len() * LANES;
            let reads_last = scratch.hits.last().is_some_and(|block| *block as usize + 1 == self.blocks.len());
            *counters += SearchCounters {
                searches: 1,
                photons_tested: (lanes - if reads_last { padding } else { 0 }) as u64,
                photons_found: u64::from(out.count),
            };
        }
    }

    fn visit(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32)) {
        let mut scratch = Scratch::new();
        let prepared = PreparedQuery::new(query, Kernel::Constant);
        self.find_blocks(query.position, query.radius, prepared.r2, &mut scratch);
        for block in scratch.hits.iter().map(|block| &self.blocks[*block as usize]) {
            let distances = block.distances_sq(query.position);
            for (lane, d2) in distances.into_iter().enumerate() {
                if d2 <= prepared.r2 && prepared.accepts(block.surface[lane]) {
                    visit(&block.photon(lane), d2);
                }
            }
        }
    }

    fn within_radius(&self, position: Vec3, radius: f32, found: &mut Vec<Neighbor>) {
        let mut scratch = Scratch::new();
        let r2 = radius_sq(position, radius);
        self.find_blocks(position, radius, r2, &mut scratch);
        let mut candidates = Candidates::default();
        candidates.start(usize::MAX);
        (self.kernels.scan)(&self.blocks, &self.ids, &scratch.hits, position, r2, &mut candidates);
        candidates.take_all(found);
        found.sort_unstable_by_key(|n| n.photon);
    }

    /// Searches balls that grow until one holds `k` photons: those nearest are among them.
    fn nearest(&self, position: Vec3, k: usize, radius: f32, found: &mut Vec<Neighbor>) {
        found.clear();
        let r2 = radius_sq(position, radius);
        if k == 0 || r2 < 0.0 {
            return;
        }
        let mut scratch = Scratch::new();
        let mut candidates = Candidates::default();
        let mut reach =
            self.index.as_ref().map_or(radius, |(cells, table)| cells.reach(position, k, table.photons_a_cell()));
        loop {
            let last = !(reach < radius);
            let (ball, ball_sq) = if last { (radius, r2) } else { (reach, reach * reach) };
            self.find_blocks(position, ball, ball_sq, &mut scratch);
            candidates.start(k);
            (self.kernels.scan)(&self.blocks, &self.ids, &scratch.hits, position, ball_sq, &mut candidates);
            if last || candidates.len() >= k || candidates.len() == self.photon_count {
                break;
            }
            reach *= 2.0;
        }
        candidates.finish(found);
    }

    fn photon(&self, id: u32) -> Photon {
        let slots = self.slots.get_or_init(|| {
            let mut slots = vec![0; self.photon_count];
            for (slot, id) in (0u32..).zip(&self.ids[..self.photon_count]) {
                slots[*id as usize] = slot;
            }
            slots
        });
        let slot = slots[id as usize] as usize;
        self.blocks[slot / LANES].photon(slot % LANES)
    }

    fn summary(&self) -> SearchSummary {
        let bytes = self.blocks.capacity() * size_of::<Block>()
            + self.boxes.bytes()
            + self.ids.capacity() * size_of::<u32>()
            + self.slots.get().map_or(0, |s| s.capacity() * size_of::<u32>())
            + self.index.as_ref().map_or(0, |(_, table)| table.bytes());
        SearchSummary { name: "grid", photons: self.photon_count as u64, bytes: bytes as u64 }
    }
}
