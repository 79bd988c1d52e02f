//! Time spent in queries: structures and searches that hand every batch on to another and look at the clock around it.

use crate::machine::thread_cpu_seconds;
use photinus_accel::structures::kd_tree::KdTree;
use photinus_accel::{RayCounters, Structure, StructureSummary};
use photinus_geometry::{Hit, Ray, Vec3};
use photinus_photons::{GatherQuery, Gathered, Kernel, Neighbor, Photon, Search, SearchSummary};
use photinus_profile::SearchCounters;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Thread time in queries, summed over threads.
#[derive(Debug, Default)]
pub(crate) struct QueryClock {
    ray_nanoseconds: AtomicU64,
    search_nanoseconds: AtomicU64,
    /// Counted batches of rays: what tells the cost of a test from that of a node.
    batches: Mutex<Moments>,
}

/// Sums over batches of their nodes n, tests t and seconds s, for the least squares of s = a n + b t.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    nn: f64,
    nt: f64,
    tt: f64,
    ns: f64,
    ts: f64,
    n: f64,
    t: f64,
}

impl QueryClock {
    /// Thread seconds in ray queries since the last reset.
    pub fn ray_seconds(&self) -> f64 {
        self.ray_nanoseconds.load(Ordering::Relaxed) as f64 * 1e-9
    }

    /// Thread seconds in photon searches since the last reset.
    pub fn search_seconds(&self) -> f64 {
        self.search_nanoseconds.load(Ordering::Relaxed) as f64 * 1e-9
    }

    /// Share of the time in ray queries that tests take, 0 to 1; the rest is traversal. None before a batch has been
    /// counted.
    pub fn test_share(&self) -> Option<f64> {
        self.batches.lock().unwrap_or_else(PoisonError::into_inner).test_share()
    }

    /// Starts again from zero.
    pub fn reset(&self) {
        self.ray_nanoseconds.store(0, Ordering::Relaxed);
        self.search_nanoseconds.store(0, Ordering::Relaxed);
        *self.batches.lock().unwrap_or_else(PoisonError::into_inner) = Moments::default();
    }

    fn counted(&self, before: &RayCounters, after: &RayCounters, took: f64) {
        let nodes = |c: &RayCounters| c.traversal.nodes_visited + c.traversal.leaves_visited;
        let n = (nodes(after) - nodes(before)) as f64;
        let t = (after.intersect.tests - before.intersect.tests) as f64;
        self.batches.lock().unwrap_or_else(PoisonError::into_inner).add(n, t, took);
    }
}

impl Moments {
    fn add(&mut self, n: f64, t: f64, s: f64) {
        self.nn += n * n;
        self.nt += n * t;
        self.tt += t * t;
        self.ns += n * s;
        self.ts += t * s;
        self.n += n;
        self.t += t;
    }

    /// Share of the tests in the fitted time. Where nodes and tests go together, or the fit says that one of them
    /// costs nothing, the times cannot tell them apart, and both cost the same.
    fn test_share(&self) -> Option<f64> {
        if self.tt == 0.0 && self.nn == 0.0 {
            return None;
        }
        let determinant = self.nn * self.tt - self.nt * self.nt;
        let node = (self.ns * self.tt - self.ts * self.nt) / determinant;
        let test = (self.ts * self.nn - self.ns * self.nt) / determinant;
        let (node, test) = if node > 0.0 && test > 0.0 { (node, test) } else { (1.0, 1.0) };
        let (nodes, tests) = (node * self.n, test * self.t);
        Some(if nodes + tests > 0.0 { tests / (nodes + tests) } else { 0.0 })
    }
}

/// A structure whose queries are timed. Two looks at the clock cost nothing beside a batch of rays.
pub(crate) struct TimedStructure {
    inner: Box<dyn Structure>,
    clock: Arc<QueryClock>,
}

impl TimedStructure {
    pub fn new(inner: Box<dyn Structure>, clock: Arc<QueryClock>) -> Self {
        Self { inner, clock }
    }

    fn timed(&self, query: impl FnOnce(&dyn Structure)) -> f64 {
        timed_batch(&self.clock.ray_nanoseconds, || query(&*self.inner))
    }
}

impl Structure for TimedStructure {
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.timed(|inner| inner.closest_hit(rays, hits));
    }

    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.timed(|inner| inner.any_hit(rays, occluded));
    }

    fn closest_hit_counted(&self, rays: &[Ray], hits: &mut [Hit], counters: &mut RayCounters) {
        let before = *counters;
        let took = self.timed(|inner| inner.closest_hit_counted(rays, hits, counters));
        self.clock.counted(&before, counters, took);
    }

    fn any_hit_counted(&self, rays: &[Ray], occluded: &mut [bool], counters: &mut RayCounters) {
        let before = *counters;
        let took = self.timed(|inner| inner.any_hit_counted(rays, occluded, counters));
        self.clock.counted(&before, counters, took);
    }

    fn summary(&self) -> StructureSummary {
        self.inner.summary()
    }

    fn as_kd_tree(&self) -> Option<&KdTree> {
        self.inner.as_kd_tree()
    }
}

/// A photon search whose queries are timed.
pub(crate) struct TimedSearch {
    inner: Box<dyn Search>,
    clock: Arc<QueryClock>,
}

impl TimedSearch {
    pub fn new(inner: Box<dyn Search>, clock: Arc<QueryClock>) -> Self {
        Self { inner, clock }
    }

    fn batch(&self, query: impl FnOnce(&dyn Search)) {
        timed_batch(&self.clock.search_nanoseconds, || query(&*self.inner));
    }

    fn single(&self, query: impl FnOnce(&dyn Search)) {
        timed_single(&self.clock.search_nanoseconds, || query(&*self.inner));
    }
}

impl Search for TimedSearch {
    fn gather(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        self.batch(|inner| inner.gather(queries, kernel, out));
    }

    fn gather_counted(
        &self,
        queries: &[GatherQuery],
        kernel: Kernel,
        out: &mut [Gathered],
        counters: &mut SearchCounters,
    ) {
        self.batch(|inner| inner.gather_counted(queries, kernel, out, counters));
    }

    fn visit(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32)) {
        self.single(|inner| inner.visit(query, visit));
    }

    fn within_radius(&self, position: Vec3, radius: f32, found: &mut Vec<Neighbor>) {
        self.single(|inner| inner.within_radius(position, radius, found));
    }

    fn nearest(&self, position: Vec3, k: usize, radius: f32, found: &mut Vec<Neighbor>) {
        self.single(|inner| inner.nearest(position, k, radius, found));
    }

    fn photon(&self, id: u32) -> Photon {
        self.inner.photon(id)
    }

    fn summary(&self) -> SearchSummary {
        self.inner.summary()
    }
}

/// Processor time of a batch, in seconds: that of other programs on the same processor does not count.
fn timed_batch(nanoseconds: &AtomicU64, work: impl FnOnce()) -> f64 {
    let begun = thread_cpu_seconds();
    work();
    let took = thread_cpu_seconds() - begun;
    nanoseconds.fetch_add((took * 1e9) as u64, Ordering::Relaxed);
    took
}

/// Wall time of a single query, which is too short for a look at the thread's own clock (some 300 ns).
fn timed_single(nanoseconds: &AtomicU64, work: impl FnOnce()) {
    let begun = Instant::now();
    work();
    nanoseconds.fetch_add(begun.elapsed().as_nanos() as u64, Ordering::Relaxed);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fit_finds_the_costs_that_made_the_times() {
        let mut moments = Moments::default();
        assert_eq!(moments.test_share(), None);
        for (n, t) in [(10.0, 3.0), (20.0, 2.0), (5.0, 9.0), (7.0, 7.0)] {
            moments.add(n, t, 2e-9 * n + 5e-9 * t);
        }
        // 42 nodes at 2 and 21 tests at 5: 105 of 189.
        let share = moments.test_share().unwrap();
        assert!((share - 105.0 / 189.0).abs() < 1e-9, "{share}");
    }

    #[test]
    fn without_nodes_all_time_is_tests_and_nonsense_is_not_believed() {
        let mut moments = Moments::default();
        moments.add(0.0, 100.0, 1e-6);
        moments.add(0.0, 200.0, 2e-6);
        assert_eq!(moments.test_share(), Some(1.0));
        let mut moments = Moments::default();
        for (n, t, s) in [(1.0, 9.0, 1e-9), (2.0, 5.0, 9e-9), (3.0, 1.0, 20e-9)] {
            moments.add(n, t, s);
        }
        assert_eq!(moments.test_share(), Some(15.0 / 21.0), "one cost for both");
    }
}
