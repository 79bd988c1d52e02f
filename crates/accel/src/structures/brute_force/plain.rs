//! The plain way: a leaf of all primitives, tested one after the other by any method.

use super::one_leaf;
use crate::list::leaf_tester;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{RayCounters, Structure, StructureSummary, stamped, stamped_batch};
use photinus_geometry::{Hit, Primitives, Ray};
use photinus_intersect::LeafTester;

/// Primitives one after the other, by any method.
pub struct Plain {
    ids: Vec<u32>,
    tester: Box<dyn LeafTester>,
}

impl Plain {
    /// Prepares the primitives for the method that `options` name.
    pub fn new(primitives: &Primitives, options: &BuildOptions) -> Result<Self, BuildError> {
        Ok(Self { ids: (0..primitives.len() as u32).collect(), tester: leaf_tester(primitives, options)? })
    }

    fn closest_batch<const COUNT: bool>(&self, rays: &[Ray], hits: &mut [Hit], counters: &mut RayCounters) {
        assert_eq!(rays.len(), hits.len());
        counters.traversal.rays += rays.len() as u64;
        stamped_batch::<COUNT>(counters, |counters| {
            for (ray, hit) in rays.iter().zip(hits) {
                *hit = Hit::MISS;
                let work = stamped::<COUNT, _>(&mut counters.ticks, || self.tester.closest_hit(ray, &self.ids, hit));
                counters.add_leaf(self.ids.len(), work);
            }
        });
    }

    fn any_batch<const COUNT: bool>(&self, rays: &[Ray], occluded: &mut [bool], counters: &mut RayCounters) {
        assert_eq!(rays.len(), occluded.len());
        counters.traversal.rays += rays.len() as u64;
        stamped_batch::<COUNT>(counters, |counters| {
            for (ray, hit) in rays.iter().zip(occluded) {
                let (any, work) = stamped::<COUNT, _>(&mut counters.ticks, || self.tester.any_hit(ray, &self.ids));
                *hit = any;
                counters.add_leaf(self.ids.len(), work);
            }
        });
    }
}

impl Structure for Plain {
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.closest_batch::<false>(rays, hits, &mut RayCounters::default());
    }

    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.any_batch::<false>(rays, occluded, &mut RayCounters::default());
    }

    fn closest_hit_counted(&self, rays: &[Ray], hits: &mut [Hit], counters: &mut RayCounters) {
        self.closest_batch::<true>(rays, hits, counters);
    }

    fn any_hit_counted(&self, rays: &[Ray], occluded: &mut [bool], counters: &mut RayCounters) {
        self.any_batch::<true>(rays, occluded, counters);
    }

    fn summary(&self) -> StructureSummary {
        one_leaf(self.ids.len(), self.ids.len() as u64 * 4 + self.tester.bytes())
    }
}
