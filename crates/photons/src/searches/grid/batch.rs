//! Gathering for a batch of queries in an order that suits the caches.

use super::Grid;
use super::blocks::Block;
use super::cells::Cells;
use super::kernels::NormalMemo;
use super::reach::Scratch;
use crate::inclusion::PreparedQuery;
use crate::{GatherQuery, Gathered, Kernel};

/// Pairs of consecutive queries that are looked at to judge a batch.
const SAMPLES: usize = 64;
/// A core's second-level cache holds about this many bytes of photons.
const CACHE_BYTES: usize = 2 << 20;

impl Grid {
    /// Gathers a part of a batch, at most 65,536 queries, on one thread.
    pub(crate) fn gather_part(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        if self.are_coherent(queries) {
            self.gather_in_order(queries, kernel, out);
        } else if self.blocks.len() * size_of::<Block>() <= CACHE_BYTES {
            let sorted: Vec<usize> = self.sorted(queries);
            let (mut scratch, mut memo) = (Scratch::new(), NormalMemo::NONE);
            for i in sorted {
                let prepared = self.reach(&queries[i], kernel, &mut scratch);
                out[i] = (self.kernels.gather)(&self.blocks, &scratch.hits, &prepared, &mut memo);
            }
        } else {
            self.gather_with_prefetch(queries, kernel, out);
        }
    }

    fn gather_in_order(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        let (mut scratch, mut memo) = (Scratch::new(), NormalMemo::NONE);
        for (query, out) in queries.iter().zip(out) {
            let prepared = self.reach(query, kernel, &mut scratch);
            *out = (self.kernels.gather)(&self.blocks, &scratch.hits, &prepared, &mut memo);
        }
    }

    /// Has the blocks of the next query fetched while one is summed.
    fn gather_with_prefetch(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        let (mut scratch, mut next_scratch, mut memo) = (Scratch::new(), Scratch::new(), NormalMemo::NONE);
        let mut sorted = self.sorted(queries).into_iter();
        let Some(mut i) = sorted.next() else { return };
        let mut prepared = self.reach(&queries[i], kernel, &mut scratch);
        for next in sorted {
            let next_prepared = self.reach(&queries[next], kernel, &mut next_scratch);
            (self.kernels.prefetch)(&self.blocks, &next_scratch.hits);
            out[i] = (self.kernels.gather)(&self.blocks, &scratch.hits, &prepared, &mut memo);
            std::mem::swap(&mut scratch, &mut next_scratch);
            (i, prepared) = (next, next_prepared);
        }
        out[i] = (self.kernels.gather)(&self.blocks, &scratch.hits, &prepared, &mut memo);
    }

    #[inline]
    fn reach(&self, query: &GatherQuery, kernel: Kernel, scratch: &mut Scratch) -> PreparedQuery {
        let prepared = PreparedQuery::new(query, kernel);
        self.find_blocks(query.position, query.radius, prepared.r2, scratch);
        prepared
    }

    /// Whether consecutive queries mostly share their half cells, so that any order of ours would be no better.
    pub(super) fn are_coherent(&self, queries: &[GatherQuery]) -> bool {
        let half_cell = |query: &GatherQuery| Cells::half_cell(self.cells.place(query.position));
        let step = (queries.len() / SAMPLES).max(1);
        let pairs = || queries.windows(2).step_by(step);
        let equal = pairs().filter(|pair| half_cell(&pair[0]) == half_cell(&pair[1])).count();
        3 * equal >= pairs().len()
    }

    /// Indices of queries in the order of their half cells.
    pub(super) fn sorted(&self, queries: &[GatherQuery]) -> Vec<usize> {
        let key = |query: &GatherQuery| self.cells.order(query.position) << 16;
        let mut keys: Vec<u64> = (0u64..).zip(queries).map(|(i, query)| key(query) | i).collect();
        keys.sort_unstable();
        keys.into_iter().map(|key| (key & 0xFFFF) as usize).collect()
    }
}
