//! A search whose estimates are made over a support other than the ball.

use crate::inclusion::PreparedQuery;
use crate::nearest::{NearestHeap, Ties};
use crate::results::ResultSet;
use crate::supports::Shape;
use crate::visiting::{gather_batch_by_visiting, gather_counted_by_visiting};
use crate::{GatherQuery, Gathered, Kernel, Neighbor, Photon, Region, Search, SearchSummary};
use photinus_geometry::Vec3;
use photinus_profile::SearchCounters;
use std::marker::PhantomData;

/// Another search, asked for the regions of a support.
pub(crate) struct Supported<S> {
    search: Box<dyn Search>,
    shape: PhantomData<S>,
}

impl<S: Shape> Supported<S> {
    pub(crate) fn new(search: Box<dyn Search>) -> Self {
        Self { search, shape: PhantomData }
    }

    /// Visits what fits a query; returns how many were tested.
    fn visit_counting(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32)) -> u64 {
        let prepared = PreparedQuery::new(query, Kernel::Constant);
        let mut results = Visiting::<S> { prepared, visit, shape: PhantomData };
        self.search.search(&S::region(query.position, query.radius), &mut results)
    }
}

/// The square of a photon's measure, where it is in the support of the query and fits it.
#[inline]
fn measure_sq<S: Shape>(prepared: &PreparedQuery, photon: &Photon, distance_sq: f32) -> Option<f32> {
    let measure_sq = S::measure_sq(photon.position() - prepared.position, distance_sq, prepared.normal);
    (measure_sq <= prepared.r2 && prepared.accepts(photon.surface_word())).then_some(measure_sq)
}

/// Hands out what fits a query.
struct Visiting<'a, S> {
    prepared: PreparedQuery,
    visit: &'a mut dyn FnMut(&Photon, f32),
    shape: PhantomData<S>,
}

impl<S: Shape> ResultSet for Visiting<'_, S> {
    fn limit(&self) -> f32 {
        self.prepared.r2 * S::REACH_SQ
    }

    fn add(&mut self, _: u32, photon: &Photon, distance_sq: f32) {
        if let Some(measure_sq) = measure_sq::<S>(&self.prepared, photon, distance_sq) {
            (self.visit)(photon, measure_sq);
        }
    }
}

/// Keeps the nearest of what fits a query, by measure, with all as near as the farthest.
struct NearestFitting<'a, S> {
    prepared: PreparedQuery,
    heap: NearestHeap<'a>,
    ties: Ties,
    shape: PhantomData<S>,
}

impl<S: Shape> ResultSet for NearestFitting<'_, S> {
    fn limit(&self) -> f32 {
        self.heap.limit() * S::REACH_SQ
    }

    fn add(&mut self, id: u32, photon: &Photon, distance_sq: f32) {
        if let Some(distance_sq) = measure_sq::<S>(&self.prepared, photon, distance_sq) {
            self.heap.offer_with_ties(Neighbor { distance_sq, photon: id }, &mut self.ties);
        }
    }
}

impl<S: Shape> Search for Supported<S> {
    fn gather(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        gather_batch_by_visiting(self, queries, kernel, out);
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
        let photons_tested = self.visit_counting(query, &mut |photon, measure_sq| {
            photons_found += 1;
            visit(photon, measure_sq);
        });
        *counters += SearchCounters { searches: 1, photons_tested, photons_found };
    }

    fn neighbourhood(&self, query: &GatherQuery) -> u64 {
        self.search.neighbourhood(query)
    }

    fn neighbourhoods(&self, queries: &[GatherQuery], keys: &mut Vec<u64>) {
        self.search.neighbourhoods(queries, keys);
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
        let mut results = NearestFitting::<S> { prepared, heap, ties: Ties::default(), shape: PhantomData };
        let photons_tested = self.search.search(&S::region(query.position, query.radius), &mut results);
        let ties = results.ties;
        found.clear();
        found.extend(nearest.iter().chain(ties.all()).map(|n| (self.search.photon(n.photon), n.distance_sq)));
        *counters += SearchCounters { searches: 1, photons_tested, photons_found: found.len() as u64 };
    }

    fn search(&self, region: &Region, results: &mut dyn ResultSet) -> u64 {
        self.search.search(region, results)
    }

    fn within_radius(&self, position: Vec3, radius: f32, found: &mut Vec<Neighbor>) {
        self.search.within_radius(position, radius, found);
    }

    fn nearest(&self, position: Vec3, k: usize, radius: f32, found: &mut Vec<Neighbor>) {
        self.search.nearest(position, k, radius, found);
    }

    fn photon(&self, id: u32) -> Photon {
        self.search.photon(id)
    }

    fn summary(&self) -> SearchSummary {
        self.search.summary()
    }
}
