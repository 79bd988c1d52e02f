//! Searches for the k nearest: what a ball about as large as the last one needed holds, the k-th distance of it, then sums
//! up to that.

use super::Grid;
use super::kernels::{NormalMemo, Selected};
use super::reach::Scratch;
use super::shared::Shared;
use crate::GatheredNearest;
use crate::inclusion::PreparedQuery;
use crate::kernel::PreparedKernel;

/// A ball this much wider than that of the neighbouring query holds enough photons most of the time.
pub(crate) const WIDER: f32 = 1.1;

/// Balls that are tried before the query's own.
pub(crate) const ATTEMPTS: u32 = 8;

/// What one search for the nearest hands to the next; results do not depend on it.
pub(crate) struct NearestFinder {
    pub(crate) scratch: Scratch,
    memo: NormalMemo,
    /// What the last query found, more than the nearest.
    pub(crate) selected: Vec<Selected>,
    distances_sq: Vec<f32>,
    /// Radius that the last query needed; zero before the first.
    pub(crate) last_radius: f32,
    /// Whether fewer than the nearest were all that the last query of a group found.
    pub(crate) had_few: bool,
    /// Photons that the queries of a group share, those within this distance of its centre.
    pub(crate) shared: Shared,
    pub(crate) shared_extent: f32,
    /// Photons tested since it was made.
    pub(crate) tested: u64,
}

impl NearestFinder {
    pub(crate) fn new() -> Self {
        Self {
            scratch: Scratch::new(),
            memo: NormalMemo::NONE,
            selected: Vec::with_capacity(64),
            distances_sq: Vec::with_capacity(512),
            last_radius: 0.0,
            had_few: false,
            shared: Shared::default(),
            shared_extent: 0.0,
            tested: 0,
        }
    }
}

impl Grid {
    /// Narrows a query of this radius to its `k` nearest photons, and leaves them, with others, in the finder.
    pub(crate) fn narrow(
        &self,
        mut query: PreparedQuery,
        radius: f32,
        k: u32,
        finder: &mut NearestFinder,
    ) -> PreparedQuery {
        let whole = query.r2;
        if k == 0 || !(whole >= 0.0) {
            finder.selected.clear();
            query.r2 = -1.0;
            return query;
        }
        let even = self.cells.reach(query.position, k as usize, self.table.photons_a_cell());
        let mut reach = if finder.last_radius > 0.0 { (finder.last_radius * WIDER).max(0.1 * even) } else { even };
        for attempt in 1.. {
            let last = !(reach < radius) || attempt > ATTEMPTS;
            let (ball, ball_sq) = if last { (radius, whole) } else { (reach, reach * reach) };
            query.r2 = ball_sq;
            self.find_facing(query.position, query.normal, ball, ball_sq, &mut finder.scratch);
            finder.tested += self.photons_in(&finder.scratch);
            finder.selected.clear();
            (self.kernels.select)(&self.blocks, &finder.scratch.hits, &query, &mut finder.memo, &mut finder.selected);
            let found = finder.selected.iter().map(|selected| selected.lanes.count_ones()).sum::<u32>();
            if found >= k {
                let kth = (self.kernels.kth)(&finder.selected, k as usize, &mut finder.distances_sq);
                let radius = kth.sqrt();
                finder.last_radius = radius;
                query.r2 = kth;
                query.kernel = PreparedKernel::new(query.kernel.kernel, radius);
                return query;
            }
            if last {
                finder.last_radius = radius;
                break;
            }
            reach *= wider_for(k, found);
        }
        query
    }

    /// Sums the nearest of one query of this radius.
    pub(crate) fn nearest_alone(
        &self,
        query: PreparedQuery,
        radius: f32,
        k: u32,
        finder: &mut NearestFinder,
    ) -> GatheredNearest {
        let nearest = self.narrow(query, radius, k, finder);
        let sums = (self.kernels.gather_selected)(&self.blocks, &finder.selected, &nearest);
        let farthest = || finder.selected.iter().flat_map(Selected::found).fold(0f32, |most, (_, d2)| most.max(d2));
        let farthest_sq = match sums.count {
            0 => 0.0,
            count if count >= k => nearest.r2,
            _ => farthest(),
        };
        GatheredNearest { flux: sums.flux, count: sums.count, farthest_sq }
    }
}

/// How much wider a ball that holds `found` photons has to be for `k`, on an even surface.
pub(crate) fn wider_for(k: u32, found: u32) -> f32 {
    (1.2 * k as f32 / found.max(1) as f32).sqrt().clamp(1.1, 4.0)
}
