//! What a structure over photons has to say, and the search that all such structures make of it: they only tell which
//! runs of places may hold photons of a region; whether they do, and what becomes of them, is decided here.

use crate::inclusion::PreparedQuery;
use crate::nearest::{NearestHeap, Ties};
use crate::region::Region;
use crate::results::{Accumulation, List, Nearest, ResultSet};
use crate::store::Store;
use crate::visiting::{gather_by_visiting, gather_counted_by_visiting};
use crate::{GatherQuery, Gathered, Kernel, Neighbor, Photon, Search, SearchSummary};
use photinus_geometry::{Aabb, Vec3};
use photinus_profile::SearchCounters;
use rayon::prelude::*;
use std::ops::Range;

/// Queries that are worth a task of their own.
const QUERIES_A_TASK: usize = 256;

/// A structure over the places of a [`Store`].
pub(crate) trait Index: Send + Sync {
    /// Command-line name of the member.
    const NAME: &'static str;

    /// Hands all runs of places to `scan` that may hold photons within its reach, best from near to far; a run may be
    /// left out once its box is [out of reach](Scan::is_out_of_reach).
    fn search(&self, scan: &mut impl Scan);

    /// Calls `run` with the index of each region and all runs of places that may hold photons of it; false, without a
    /// call, for a structure that had better be asked one by one.
    fn search_all(&self, _regions: &[Region], _run: &mut impl FnMut(usize, Range<usize>)) -> bool {
        false
    }

    /// Bytes held.
    fn bytes(&self) -> usize;

    /// See [`SearchSummary::kernels`].
    fn kernels(&self) -> &'static str {
        ""
    }
}

/// A search under way.
pub(crate) trait Scan {
    /// The least squared distance from the middle that a photon of interest in this box can have; infinite where there
    /// can be none.
    fn reach(&self, bounds: &Aabb) -> f32;

    /// The squared distance up to which photons are of interest; shrinks as they are found, negative at the end.
    fn limit(&self) -> f32;

    /// The middle of the region.
    fn middle(&self) -> Vec3;

    /// The region.
    fn region(&self) -> Region;

    /// So many photons were tested by the structure itself, and are not in.
    fn leave_out(&mut self, count: usize);

    /// Tests the photons of a run.
    fn run(&mut self, places: Range<usize>);

    /// Whether nothing in a box of this reach is of interest any more.
    #[inline]
    fn is_out_of_reach(&self, reach: f32) -> bool {
        reach == f32::INFINITY || !(reach <= self.limit())
    }
}

/// A search of a region for a set of results.
struct Scanning<'a, R: ?Sized> {
    store: &'a Store,
    region: Region,
    middle: Vec3,
    results: &'a mut R,
    tested: u64,
}

impl<R: ResultSet + ?Sized> Scan for Scanning<'_, R> {
    #[inline]
    fn reach(&self, bounds: &Aabb) -> f32 {
        self.region.reach(bounds, self.middle)
    }

    #[inline]
    fn limit(&self) -> f32 {
        self.results.limit()
    }

    #[inline]
    fn middle(&self) -> Vec3 {
        self.middle
    }

    fn region(&self) -> Region {
        self.region
    }

    fn leave_out(&mut self, count: usize) {
        self.tested += count as u64;
    }

    #[inline]
    fn run(&mut self, places: Range<usize>) {
        self.tested += places.len() as u64;
        for place in places {
            let photon = self.store.at(place);
            if let Some(d2) = self.region.holds(photon.position(), self.middle)
                && d2 <= self.results.limit()
            {
                self.results.add(self.store.id(place), photon, d2);
            }
        }
    }
}

/// Photons in the order of a structure, with the structure: a search.
pub(crate) struct Indexed<I> {
    store: Store,
    index: I,
}

impl<I: Index> Indexed<I> {
    /// A search of photons by a structure over `ids`, the order that it wants them in.
    pub(crate) fn new(photons: &[Photon], (index, ids): (I, Vec<u32>)) -> Self {
        Self { store: Store::new(photons, ids), index }
    }

    /// The structure.
    #[cfg(test)]
    pub(crate) fn index(&self) -> &I {
        &self.index
    }

    /// Adds the photons of a region to a set of results and returns how many were tested.
    #[inline]
    fn scan<R: ResultSet + ?Sized>(&self, region: Region, results: &mut R) -> u64 {
        if !region.is_valid() || self.store.len() == 0 {
            return 0;
        }
        let middle = region.middle();
        let mut scan = Scanning { store: &self.store, region, middle, results, tested: 0 };
        self.index.search(&mut scan);
        scan.tested
    }

    /// Sums for a batch.
    fn gather_part(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        let regions: Vec<Region> = queries.iter().map(sphere).collect();
        let mut sums: Vec<Accumulation> = queries.iter().map(|query| Accumulation::new(query, kernel)).collect();
        let is_searched = self.index.search_all(&regions, &mut |query, places| {
            let (region, results) = (regions[query], &mut sums[query]);
            Scanning { store: &self.store, region, middle: region.middle(), results, tested: 0 }.run(places);
        });
        for ((out, sums), query) in out.iter_mut().zip(&sums).zip(queries) {
            *out = if is_searched { sums.gathered() } else { gather_by_visiting(self, query, kernel) };
        }
    }

    fn visit_counting(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32)) -> u64 {
        let mut visiting = Visiting { prepared: PreparedQuery::new(query, Kernel::Constant), visit };
        self.scan(sphere(query), &mut visiting)
    }
}

/// Where a query's photons lie.
fn sphere(query: &GatherQuery) -> Region {
    Region::Sphere { center: query.position, radius: query.radius }
}

/// Hands out what fits a query.
struct Visiting<'a> {
    prepared: PreparedQuery,
    visit: &'a mut dyn FnMut(&Photon, f32),
}

impl ResultSet for Visiting<'_> {
    #[inline]
    fn limit(&self) -> f32 {
        self.prepared.r2
    }

    #[inline]
    fn add(&mut self, _: u32, photon: &Photon, distance_sq: f32) {
        if self.prepared.accepts(photon.surface_word()) {
            (self.visit)(photon, distance_sq);
        }
    }
}

/// Keeps the nearest of what fits a query, with all as near as the farthest.
struct NearestFitting<'a> {
    prepared: PreparedQuery,
    heap: NearestHeap<'a>,
    ties: Ties,
}

impl ResultSet for NearestFitting<'_> {
    #[inline]
    fn limit(&self) -> f32 {
        self.heap.limit()
    }

    #[inline]
    fn add(&mut self, photon: u32, of: &Photon, distance_sq: f32) {
        if self.prepared.accepts(of.surface_word()) {
            self.heap.offer_with_ties(Neighbor { distance_sq, photon }, &mut self.ties);
        }
    }
}

impl<I: Index> Search for Indexed<I> {
    fn gather(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        assert_eq!(queries.len(), out.len(), "one result a query");
        let parts = queries.par_chunks(QUERIES_A_TASK).zip(out.par_chunks_mut(QUERIES_A_TASK));
        parts.for_each(|(queries, out)| self.gather_part(queries, kernel, out));
    }

    fn gather_counted(
        &self,
        queries: &[GatherQuery],
        kernel: Kernel,
        out: &mut [Gathered],
        counters: &mut SearchCounters,
    ) {
        gather_counted_by_visiting(self, queries, kernel, out, counters);
    }

    fn visit(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32)) {
        self.visit_counting(query, visit);
    }

    fn visit_counted(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32), counters: &mut SearchCounters) {
        let mut photons_found = 0;
        let photons_tested = self.visit_counting(query, &mut |photon, d2| {
            photons_found += 1;
            visit(photon, d2);
        });
        *counters += SearchCounters { searches: 1, photons_tested, photons_found };
    }

    fn collect_nearest_counted(
        &self,
        query: &GatherQuery,
        k: u32,
        found: &mut Vec<(Photon, f32)>,
        counters: &mut SearchCounters,
    ) {
        let prepared = PreparedQuery::new(query, Kernel::Constant);
        let mut nearest = Vec::with_capacity(k.min(1024) as usize);
        let heap = NearestHeap::new(&mut nearest, k as usize, prepared.r2);
        let mut results = NearestFitting { prepared, heap, ties: Ties::default() };
        let photons_tested = self.scan(sphere(query), &mut results);
        let ties = results.ties;
        found.clear();
        found.extend(nearest.iter().chain(ties.all()).map(|n| (self.store.photon(n.photon), n.distance_sq)));
        *counters += SearchCounters { searches: 1, photons_tested, photons_found: found.len() as u64 };
    }

    fn search(&self, region: &Region, results: &mut dyn ResultSet) -> u64 {
        self.scan(*region, results)
    }

    fn within_radius(&self, position: Vec3, radius: f32, found: &mut Vec<Neighbor>) {
        let mut list = List::default();
        self.scan(Region::Sphere { center: position, radius }, &mut list);
        *found = list.into_found();
    }

    fn nearest(&self, position: Vec3, k: usize, radius: f32, found: &mut Vec<Neighbor>) {
        let mut nearest = Nearest::new(k);
        self.scan(Region::Sphere { center: position, radius }, &mut nearest);
        *found = nearest.into_found();
    }

    fn photon(&self, id: u32) -> Photon {
        self.store.photon(id)
    }

    fn summary(&self) -> SearchSummary {
        let bytes = (self.store.bytes() + self.index.bytes()) as u64;
        SearchSummary { name: I::NAME, photons: self.store.len() as u64, bytes, kernels: self.index.kernels() }
    }
}
