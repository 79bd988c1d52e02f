//! A sorted uniform grid: photons in the order of their cells, in blocks of sixteen; the renderer's own search.
//!
//! The search of Teschner et al., "Optimized Spatial Hashing for Collision Detection of Deformable Objects" (VMV
//! 2003), in the sorted form of Green, "Particle Simulation using CUDA" (2010), with rows of cells in place of cells:
//! a row's photons lie together, so that a query reads a few long runs.

mod blocks;
mod cells;
mod scalar;
mod table;

use crate::inclusion::{PreparedQuery, radius_sq};
use crate::nearest::NearestHeap;
use crate::{BuildOptions, GatherQuery, Gathered, Kernel, Neighbor, Photon, Search, SearchSummary};
use blocks::{Block, LANES};
use cells::{Cells, SEGMENT_CELLS};
use photinus_geometry::{Aabb, Vec3};
use photinus_profile::SearchCounters;
use std::ops::Range;
use std::sync::OnceLock;
use table::CellTable;

pub(crate) const ABOUT: &str = "sorted uniform grid with vector kernels";

/// Cells along the edge of a cube of one gather radius.
const CELLS_PER_RADIUS: f32 = 2.0;

/// The finished grid.
pub(crate) struct Grid {
    /// `None` where the photons' box is too large for cells, or there are none: every query then reads all blocks.
    index: Option<(Cells, CellTable)>,
    blocks: Vec<Block>,
    /// The id of each slot's photon.
    ids: Vec<u32>,
    /// The slot of each id's photon; made when first asked for.
    slots: OnceLock<Vec<u32>>,
}

impl Grid {
    pub(crate) fn new(photons: Vec<Photon>, options: &BuildOptions) -> Self {
        let bounds = Aabb::around(photons.iter().map(Photon::position));
        let radius = options.radius().unwrap_or_else(|| typical_radius(bounds, photons.len()));
        let cells = Cells::new(bounds, radius / CELLS_PER_RADIUS);
        let mut keyed: Vec<(u64, u32)> =
            (0u32..).zip(&photons).map(|(id, p)| (cells.as_ref().map_or(0, |c| c.cell(p.position())), id)).collect();
        keyed.sort_unstable();
        let table = cells.map(|c| (c, CellTable::new(keyed.iter().map(|k| k.0), c.segment_count())));
        let mut blocks = vec![Block::EMPTY; photons.len().div_ceil(LANES)];
        for (slot, (_, id)) in keyed.iter().enumerate() {
            blocks[slot / LANES].set(slot % LANES, &photons[*id as usize]);
        }
        let ids = keyed.iter().map(|k| k.1).collect();
        Self { index: table, blocks, ids, slots: OnceLock::new() }
    }

    /// Replaces `runs` by the blocks that hold every photon within `radius` of `position`, as ascending runs that do
    /// not overlap.
    fn block_runs(&self, position: Vec3, radius: f32, runs: &mut Vec<Range<u32>>) {
        runs.clear();
        if !(radius_sq(position, radius) >= 0.0) {
            return;
        }
        let all = 0..self.blocks.len() as u32;
        let Some((cells, table)) = &self.index else {
            runs.push(all);
            return;
        };
        if !cells.is_countable(radius) {
            runs.push(all);
            return;
        }
        let Some(ball) = cells.ball(position, radius) else { return };
        if ball.row_count() > table.len() as u64 {
            runs.push(all);
            return;
        }
        cells.rows(&ball, |y, z, [first, last]| {
            for segment_x in first / SEGMENT_CELLS..=last / SEGMENT_CELLS {
                let base = segment_x * SEGMENT_CELLS;
                let slots = table.slots(
                    cells.segment(y, z, segment_x),
                    first.saturating_sub(base),
                    (last - base).min(SEGMENT_CELLS - 1),
                );
                if slots.is_empty() {
                    continue;
                }
                let run = slots.start / LANES as u32..(slots.end - 1) / LANES as u32 + 1;
                match runs.last_mut() {
                    // Slots ascend from row to row, and a block may hold photons of several.
                    Some(previous) if previous.end >= run.start => previous.end = run.end,
                    _ => runs.push(run),
                }
            }
        });
    }

    fn gather_one(&self, query: &GatherQuery, kernel: Kernel, runs: &mut Vec<Range<u32>>) -> Gathered {
        self.block_runs(query.position, query.radius, runs);
        scalar::gather(&self.blocks, runs, &PreparedQuery::new(query, kernel))
    }

    /// Calls `visit` with slot and squared distance of every photon within the squared radius in the runs.
    fn for_each_within(&self, runs: &[Range<u32>], position: Vec3, r2: f32, mut visit: impl FnMut(u32, f32)) {
        let position = position.to_array();
        for run in runs {
            for block in run.clone() {
                let photons = &self.blocks[block as usize];
                for lane in 0..LANES {
                    let d2 = photons.distance_sq(lane, position);
                    if d2 <= r2 {
                        visit(block * LANES as u32 + lane as u32, d2);
                    }
                }
            }
        }
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
        let mut runs = Vec::new();
        for (query, out) in queries.iter().zip(out) {
            *out = self.gather_one(query, kernel, &mut runs);
        }
    }

    fn gather_counted(
        &self,
        queries: &[GatherQuery],
        kernel: Kernel,
        out: &mut [Gathered],
        counters: &mut SearchCounters,
    ) {
        assert_eq!(queries.len(), out.len(), "one result a query");
        let mut runs = Vec::new();
        for (query, out) in queries.iter().zip(out) {
            *out = self.gather_one(query, kernel, &mut runs);
            let lanes: u64 = runs.iter().map(|r| r.len() as u64 * LANES as u64).sum();
            let padding = self.blocks.len() * LANES - self.ids.len();
            let last_read = runs.last().is_some_and(|r| r.end as usize == self.blocks.len());
            *counters += SearchCounters {
                searches: 1,
                photons_tested: lanes - if last_read { padding as u64 } else { 0 },
                photons_found: u64::from(out.count),
            };
        }
    }

    fn visit(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32)) {
        let mut runs = Vec::new();
        self.block_runs(query.position, query.radius, &mut runs);
        let prepared = PreparedQuery::new(query, Kernel::Constant);
        self.for_each_within(&runs, query.position, prepared.r2, |slot, d2| {
            let photon = self.blocks[slot as usize / LANES].photon(slot as usize % LANES);
            if prepared.accepts(photon.surface_word()) {
                visit(&photon, d2);
            }
        });
    }

    fn within_radius(&self, position: Vec3, radius: f32, found: &mut Vec<Neighbor>) {
        let mut runs = Vec::new();
        self.block_runs(position, radius, &mut runs);
        found.clear();
        self.for_each_within(&runs, position, radius_sq(position, radius), |slot, distance_sq| {
            found.push(Neighbor { distance_sq, photon: self.ids[slot as usize] });
        });
        found.sort_unstable_by_key(|n| n.photon);
    }

    fn nearest(&self, position: Vec3, k: usize, radius: f32, found: &mut Vec<Neighbor>) {
        let mut runs = Vec::new();
        self.block_runs(position, radius, &mut runs);
        let r2 = radius_sq(position, radius);
        let mut heap = NearestHeap::new(found, k, r2);
        self.for_each_within(&runs, position, r2, |slot, distance_sq| {
            heap.offer(Neighbor { distance_sq, photon: self.ids[slot as usize] });
        });
        heap.finish();
    }

    fn photon(&self, id: u32) -> Photon {
        let slots = self.slots.get_or_init(|| {
            let mut slots = vec![0; self.ids.len()];
            for (slot, id) in (0u32..).zip(&self.ids) {
                slots[*id as usize] = slot;
            }
            slots
        });
        let slot = slots[id as usize] as usize;
        self.blocks[slot / LANES].photon(slot % LANES)
    }

    fn summary(&self) -> SearchSummary {
        let bytes = self.blocks.capacity() * size_of::<Block>()
            + self.ids.capacity() * size_of::<u32>()
            + self.slots.get().map_or(0, |s| s.capacity() * size_of::<u32>())
            + self.index.as_ref().map_or(0, |(_, table)| table.bytes());
        SearchSummary { name: "grid", photons: self.ids.len() as u64, bytes: bytes as u64 }
    }
}
