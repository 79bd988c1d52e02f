//! Gathering for a batch of queries in an order that suits the caches.

use super::Grid;
use super::blocks::Block;
use super::cells::Cells;
use super::kernels::NormalMemo;
use super::reach::Scratch;
use super::sort::{Item, sort_items};
use crate::inclusion::PreparedQuery;
use crate::{GatherQuery, Gathered, Kernel};

/// Queries that are worth a task of their own.
const QUERIES_A_TASK: usize = 2048;
/// Most queries of a task: what is sorted at a time.
pub(super) const MOST_A_TASK: usize = 1 << 20;
/// Queries that are brought together at a time: one by one each would be waited for.
const TOGETHER: usize = 64;
/// Pairs of consecutive queries that are looked at to judge a batch.
const SAMPLES: usize = 64;
/// Sorted queries that have more blocks each are sparse: measured between 3 and 16 over a million photons and ten.
const BLOCKS_A_QUERY: usize = 8;
/// A core's second-level cache holds about this many bytes of photons.
const CACHE_BYTES: usize = 2 << 20;

impl Grid {
    /// Queries of a task: few where they come in order; as many as threads leave where they have to be sorted first.
    pub(super) fn share(&self, queries: &[GatherQuery]) -> usize {
        if queries.len() <= QUERIES_A_TASK || self.are_coherent(queries) {
            return QUERIES_A_TASK;
        }
        queries.len().div_ceil(rayon::current_num_threads()).clamp(QUERIES_A_TASK, MOST_A_TASK)
    }

    /// Gathers a part of a batch, at most [`MOST_A_TASK`] queries, on one thread.
    pub(crate) fn gather_part(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        if self.are_coherent(queries) {
            self.gather_in_order(queries, kernel, out);
        } else if self.are_sparse(queries) {
            self.gather_with_prefetch(queries, kernel, out);
        } else {
            self.gather_sorted(queries, kernel, out);
        }
    }

    fn gather_in_order(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        let (mut scratch, mut memo) = (Scratch::new(), NormalMemo::NONE);
        for (query, out) in queries.iter().zip(out) {
            let prepared = self.reach(query, kernel, &mut scratch);
            *out = (self.kernels.gather)(&self.blocks, &scratch.hits, &prepared, &mut memo);
        }
    }

    fn gather_sorted(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        let (mut scratch, mut memo) = (Scratch::new(), NormalMemo::NONE);
        let mut together = Vec::with_capacity(TOGETHER);
        for ids in self.sorted(queries).chunks(TOGETHER) {
            together.clear();
            together.extend(ids.iter().map(|id| queries[id.id() as usize]));
            for (id, query) in ids.iter().zip(&together) {
                let prepared = self.reach(query, kernel, &mut scratch);
                out[id.id() as usize] = (self.kernels.gather)(&self.blocks, &scratch.hits, &prepared, &mut memo);
            }
        }
    }

    /// Has the blocks of the next query fetched while one is summed.
    fn gather_with_prefetch(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        let (mut scratch, mut next_scratch, mut memo) = (Scratch::new(), Scratch::new(), NormalMemo::NONE);
        let mut sorted = self.sorted(queries).into_iter().map(|id| id.id() as usize);
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
        self.find_facing(query.position, query.normal, query.radius, prepared.r2, scratch);
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

    /// Whether queries lie too far from each other for one to find near what the one before it read, once they are sorted.
    fn are_sparse(&self, queries: &[GatherQuery]) -> bool {
        self.blocks.len() * size_of::<Block>() > CACHE_BYTES && queries.len() * BLOCKS_A_QUERY < self.blocks.len()
    }

    /// Indices of queries in the order of their half cells.
    pub(super) fn sorted(&self, queries: &[GatherQuery]) -> Vec<u64> {
        let bits = self.cells.order_bits();
        let spare = bits.saturating_sub(u64::KEY_BITS);
        let key = |query: &GatherQuery| self.cells.order(query.position) >> spare;
        let mut items: Vec<u64> = (0u32..).zip(queries).map(|(i, query)| u64::new(key(query), i)).collect();
        sort_items(&mut items, bits - spare, &mut Vec::new());
        items
    }
}
