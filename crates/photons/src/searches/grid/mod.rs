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
mod batch;
mod blocks;
mod build;
mod candidates;
mod cells;
mod even;
mod facing;
mod group;
mod kernels;
mod kth;
mod narrow;
mod reach;
mod region;
mod scalar;
mod shared;
mod sort;
mod table;
#[cfg(test)]
mod tests;

use crate::inclusion::{PreparedQuery, radius_sq};
use crate::results::ResultSet;
use crate::{
    BuildOptions, GatherQuery, Gathered, GatheredNearest, Kernel, Neighbor, Photon, Region, Search, SearchSummary,
};
use batch::MOST_A_TASK;
use blocks::{Block, Boxes, LANES};
use build::{Built, build};
use candidates::Candidates;
use cells::Cells;
use kernels::{NormalMemo, Selected, VectorKernels};
use narrow::NearestFinder;
use photinus_geometry::Vec3;
use photinus_memory::HugeArray;
use photinus_profile::SearchCounters;
use rayon::prelude::*;
use reach::Scratch;
use std::sync::OnceLock;
use table::CellTable;

pub(crate) const ABOUT: &str = "sorted uniform grid with vector kernels";

/// The finished grid.
pub(crate) struct Grid {
    cells: Cells,
    table: CellTable,
    blocks: HugeArray<Block>,
    boxes: Boxes,
    /// The ids of each block's photons.
    ids: HugeArray<[u32; LANES]>,
    photon_count: usize,
    /// The slot of each id's photon; made when first asked for.
    slots: OnceLock<Vec<u32>>,
    kernels: VectorKernels,
}

impl Grid {
    pub(crate) fn new(photons: Vec<Photon>, options: &BuildOptions) -> Self {
        Self::with_kernels(photons, options, kernels::available()[0])
    }

    fn with_kernels(photons: Vec<Photon>, options: &BuildOptions, kernels: VectorKernels) -> Self {
        let photon_count = photons.len();
        let Built { cells, table, blocks, boxes, ids } = build(photons, options);
        Self { cells, table, blocks, boxes, ids, photon_count, slots: OnceLock::new(), kernels }
    }

    /// Photons in the blocks that a query reaches; the last block may be padded.
    fn photons_in(&self, scratch: &Scratch) -> u64 {
        let lanes = scratch.hits.len() * LANES;
        let reads_last = scratch.hits.last().is_some_and(|block| *block as usize + 1 == self.blocks.len());
        (lanes - if reads_last { self.blocks.len() * LANES - self.photon_count } else { 0 }) as u64
    }

    /// Calls `visit` with the selected photons in the order of the blocks.
    fn hand_out(&self, selected: &[Selected], visit: &mut dyn FnMut(&Photon, f32)) {
        for selected in selected {
            let block = &self.blocks[selected.block as usize];
            selected.found().for_each(|(lane, d2)| visit(&block.photon(lane), d2));
        }
    }
}

impl Search for Grid {
    fn gather(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        assert_eq!(queries.len(), out.len(), "one result a query");
        let share = self.share(queries);
        let parts = queries.par_chunks(share).zip(out.par_chunks_mut(share));
        parts.for_each(|(queries, out)| self.gather_part(queries, kernel, out));
    }

    fn gather_counted(
        &self,
        queries: &[GatherQuery],
        kernel: Kernel,
        out: &mut [Gathered],
        counters: &mut SearchCounters,
    ) {
        assert_eq!(queries.len(), out.len(), "one result a query");
        for (queries, out) in queries.chunks(MOST_A_TASK).zip(out.chunks_mut(MOST_A_TASK)) {
            self.gather_part(queries, kernel, out);
        }
        let mut scratch = Scratch::new();
        for (query, out) in queries.iter().zip(out) {
            let r2 = radius_sq(query.position, query.radius);
            self.find_facing(query.position, query.normal, query.radius, r2, &mut scratch);
            *counters += SearchCounters {
                searches: 1,
                photons_tested: self.photons_in(&scratch),
                photons_found: u64::from(out.count),
            };
        }
    }

    fn visit(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32)) {
        let mut scratch = Scratch::new();
        let prepared = PreparedQuery::new(query, Kernel::Constant);
        self.find_facing(query.position, query.normal, query.radius, prepared.r2, &mut scratch);
        let (mut memo, mut selected) = (NormalMemo::NONE, Vec::with_capacity(scratch.hits.len()));
        (self.kernels.select)(&self.blocks, &scratch.hits, &prepared, &mut memo, &mut selected);
        self.hand_out(&selected, visit);
    }

    fn visit_counted(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32), counters: &mut SearchCounters) {
        let mut photons_found = 0;
        self.visit(query, &mut |photon, d2| {
            photons_found += 1;
            visit(photon, d2);
        });
        let mut scratch = Scratch::new();
        let r2 = radius_sq(query.position, query.radius);
        self.find_facing(query.position, query.normal, query.radius, r2, &mut scratch);
        *counters += SearchCounters { searches: 1, photons_tested: self.photons_in(&scratch), photons_found };
    }

    fn neighbourhood(&self, query: &GatherQuery) -> u64 {
        self.cells.neighbourhood(query.position, query.normal)
    }

    fn gather_nearest(&self, queries: &[GatherQuery], k: u32, kernel: Kernel, out: &mut [GatheredNearest]) {
        assert_eq!(queries.len(), out.len(), "one result a query");
        self.gather_nearest_batch(queries, k, kernel, true, out);
    }

    fn gather_nearest_ordered(&self, queries: &[GatherQuery], k: u32, kernel: Kernel, out: &mut [GatheredNearest]) {
        assert_eq!(queries.len(), out.len(), "one result a query");
        Grid::gather_nearest_ordered(self, queries, k, kernel, true, out);
    }

    fn gather_nearest_counted(
        &self,
        queries: &[GatherQuery],
        k: u32,
        kernel: Kernel,
        out: &mut [GatheredNearest],
        counters: &mut SearchCounters,
    ) {
        assert_eq!(queries.len(), out.len(), "one result a query");
        counters.photons_tested += self.gather_nearest_batch(queries, k, kernel, false, out);
        counters.searches += queries.len() as u64;
        counters.photons_found += out.iter().map(|out| u64::from(out.count)).sum::<u64>();
    }

    fn collect_nearest_counted(
        &self,
        query: &GatherQuery,
        k: u32,
        found: &mut Vec<(Photon, f32)>,
        counters: &mut SearchCounters,
    ) {
        found.clear();
        let mut finder = NearestFinder::new();
        let nearest = self.narrow(PreparedQuery::new(query, Kernel::Constant), query.radius, k, &mut finder);
        self.hand_out(&finder.selected, &mut |photon, d2| {
            if d2 <= nearest.r2 {
                found.push((*photon, d2));
            }
        });
        *counters += SearchCounters { searches: 1, photons_tested: finder.tested, photons_found: found.len() as u64 };
    }

    fn search(&self, region: &Region, results: &mut dyn ResultSet) -> u64 {
        self.search_region(region, results)
    }

    fn within_radius(&self, position: Vec3, radius: f32, found: &mut Vec<Neighbor>) {
        let mut scratch = Scratch::new();
        let r2 = radius_sq(position, radius);
        self.find_blocks(position, radius, r2, &mut scratch);
        let mut candidates = Candidates::new(usize::MAX);
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
        let mut candidates = Candidates::new(k);
        let mut reach = self.cells.reach(position, k, self.table.photons_a_cell());
        loop {
            let last = !(reach < radius);
            let (ball, ball_sq) = if last { (radius, r2) } else { (reach, reach * reach) };
            self.find_blocks(position, ball, ball_sq, &mut scratch);
            candidates.clear();
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
            for (slot, id) in (0u32..).zip(&self.ids.as_flattened()[..self.photon_count]) {
                slots[*id as usize] = slot;
            }
            slots
        });
        let slot = slots[id as usize] as usize;
        self.blocks[slot / LANES].photon(slot % LANES)
    }

    fn summary(&self) -> SearchSummary {
        let bytes = size_of_val(&self.blocks[..])
            + self.boxes.bytes()
            + size_of_val(&self.ids[..])
            + self.slots.get().map_or(0, |s| s.capacity() * size_of::<u32>())
            + self.table.bytes();
        SearchSummary {
            name: "grid",
            photons: self.photon_count as u64,
            bytes: bytes as u64,
            kernels: self.kernels.name,
        }
    }
}
