//! Triangles in blocks for `woop`, spheres behind them.

use super::dispatch::Chosen;
use super::layout::Blocks;
use super::one_leaf;
use crate::options::Kernel;
use crate::structure::{RayCounters, Structure, StructureSummary, stamped, stamped_batch};
use photinus_geometry::{Hit, Primitives, Ray};
use photinus_intersect::{LeafTester, sphere_tester};

/// All primitives, ready for the kernels.
pub struct Blocked {
    /// The triangles.
    pub blocks: Blocks,
    /// How many triangles.
    pub triangles: usize,
    /// Ids of the spheres.
    pub sphere_ids: Vec<u32>,
    /// Tests the spheres.
    pub spheres: Box<dyn LeafTester>,
    /// What runs.
    pub kernel: Chosen,
}

impl Blocked {
    /// Puts the primitives in order.
    pub fn new(primitives: &Primitives, kernel: Kernel) -> Self {
        Self {
            blocks: Blocks::new(primitives),
            triangles: primitives.triangle_count(),
            sphere_ids: (primitives.triangle_count() as u32..primitives.len() as u32).collect(),
            spheres: sphere_tester(primitives),
            kernel: Chosen::new(kernel),
        }
    }

    /// How many primitives.
    pub fn len(&self) -> usize {
        self.triangles + self.sphere_ids.len()
    }

    fn batch<const ANY: bool, const COUNT: bool>(
        &self,
        rays: &[Ray],
        set: impl FnMut(usize, Hit),
        counters: &mut RayCounters,
    ) {
        stamped_batch::<COUNT>(counters, |counters| {
            let mut work = RayCounters::default();
            stamped::<COUNT, _>(&mut counters.ticks, || self.trace_all::<ANY>(rays, set, &mut work));
            *counters += work;
        });
    }
}

impl Structure for Blocked {
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len());
        self.batch::<false, false>(rays, |i, hit| hits[i] = hit, &mut RayCounters::default());
    }

    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len());
        self.batch::<true, false>(rays, |i, hit| occluded[i] = hit.is_hit(), &mut RayCounters::default());
    }

    fn closest_hit_counted(&self, rays: &[Ray], hits: &mut [Hit], counters: &mut RayCounters) {
        assert_eq!(rays.len(), hits.len());
        self.batch::<false, true>(rays, |i, hit| hits[i] = hit, counters);
    }

    fn any_hit_counted(&self, rays: &[Ray], occluded: &mut [bool], counters: &mut RayCounters) {
        assert_eq!(rays.len(), occluded.len());
        self.batch::<true, true>(rays, |i, hit| occluded[i] = hit.is_hit(), counters);
    }

    fn summary(&self) -> StructureSummary {
        one_leaf(self.len(), self.blocks.bytes() + self.sphere_ids.len() as u64 * 4 + self.spheres.bytes())
    }
}
