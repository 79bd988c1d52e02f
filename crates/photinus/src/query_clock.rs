//! Time spent in ray queries: a structure that hands every batch on to another and looks at the clock around it.

use photinus_accel::{RayCounters, Structure, StructureSummary};
use photinus_geometry::{Hit, Ray};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Thread time in queries, summed over threads.
#[derive(Debug, Default)]
pub(crate) struct QueryClock {
    nanoseconds: AtomicU64,
}

impl QueryClock {
    /// Thread seconds since the last reset.
    pub fn seconds(&self) -> f64 {
        self.nanoseconds.load(Ordering::Relaxed) as f64 * 1e-9
    }

    /// Starts again from zero.
    pub fn reset(&self) {
        self.nanoseconds.store(0, Ordering::Relaxed);
    }
}

/// A structure whose queries are timed. Two looks at the clock a batch cost nothing beside the batch.
pub(crate) struct TimedStructure {
    inner: Box<dyn Structure>,
    clock: Arc<QueryClock>,
}

impl TimedStructure {
    pub fn new(inner: Box<dyn Structure>, clock: Arc<QueryClock>) -> Self {
        Self { inner, clock }
    }

    fn timed<R>(&self, query: impl FnOnce(&dyn Structure) -> R) -> R {
        let begun = Instant::now();
        let result = query(&*self.inner);
        self.clock.nanoseconds.fetch_add(begun.elapsed().as_nanos() as u64, Ordering::Relaxed);
        result
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
        self.timed(|inner| inner.closest_hit_counted(rays, hits, counters));
    }

    fn any_hit_counted(&self, rays: &[Ray], occluded: &mut [bool], counters: &mut RayCounters) {
        self.timed(|inner| inner.any_hit_counted(rays, occluded, counters));
    }

    fn summary(&self) -> StructureSummary {
        self.inner.summary()
    }
}
