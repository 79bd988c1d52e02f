//! Every primitive for every ray: the oracle that all other members are tested against, and the thesis's "brute
//! force" mode.

use crate::list::leaf_tester;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{RayCounters, Structure, StructureSummary};
use photinus_geometry::{Hit, Primitives, Ray};
use photinus_intersect::LeafTester;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "brute-force";
/// One line for the help.
pub const SUMMARY: &str = "every primitive for every ray; the oracle";
/// Where it was published.
pub const SOURCE: &str = "none";

struct BruteForce {
    ids: Vec<u32>,
    tester: Box<dyn LeafTester>,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    let tester = leaf_tester(&primitives, options)?;
    Ok(Box::new(BruteForce { ids: (0..primitives.len() as u32).collect(), tester }))
}

impl Structure for BruteForce {
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.closest_hit_counted(rays, hits, &mut RayCounters::default());
    }

    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.any_hit_counted(rays, occluded, &mut RayCounters::default());
    }

    fn closest_hit_counted(&self, rays: &[Ray], hits: &mut [Hit], counters: &mut RayCounters) {
        assert_eq!(rays.len(), hits.len());
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = Hit::MISS;
            let work = self.tester.closest_hit(ray, &self.ids, hit);
            counters.add_leaf(self.ids.len(), work);
            counters.traversal.rays += 1;
        }
    }

    fn any_hit_counted(&self, rays: &[Ray], occluded: &mut [bool], counters: &mut RayCounters) {
        assert_eq!(rays.len(), occluded.len());
        for (ray, hit) in rays.iter().zip(occluded) {
            let (any, work) = self.tester.any_hit(ray, &self.ids);
            *hit = any;
            counters.add_leaf(self.ids.len(), work);
            counters.traversal.rays += 1;
        }
    }

    fn summary(&self) -> StructureSummary {
        let n = self.ids.len() as u64;
        StructureSummary {
            name: NAME,
            leaves: u64::from(n > 0),
            empty_leaves: u64::from(n == 0),
            references: n,
            prims_per_leaf: n as f64,
            bytes: n * 4 + self.tester.bytes(),
            ..StructureSummary::default()
        }
    }
}
