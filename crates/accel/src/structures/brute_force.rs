//! Every primitive for every ray: the oracle that all other members are tested against, and the thesis's "brute
//! force" mode.

use crate::list::leaf_tester;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{RayCounters, Structure, StructureSummary, stamped, stamped_batch};
use photinus_geometry::{Hit, Primitives, Ray, Vec3};
use photinus_intersect::{LeafTester, RtiMethod, TriangleHit};
use photinus_num::Scalar;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "brute-force";
/// One line for the help.
pub const SUMMARY: &str = "every primitive for every ray; the oracle";
/// Where it was published.
pub const SOURCE: &str = "none";

/// The triangles of `primitives`, prepared for a method over any scalar.
pub fn prepare<S: Scalar, M: RtiMethod<S>>(primitives: &Primitives) -> Vec<M::Prepared> {
    let scalars = |v: Vec3| v.to_array().map(|x| S::from_f64(f64::from(x)));
    (0..primitives.triangle_count()).map(|i| M::prepare(primitives.triangle(i).map(scalars))).collect()
}

/// The nearest triangle that a ray hits, by a method over any scalar, ties going to the lowest id: the oracle for
/// number systems, and the counterpart of a hardware unit that sees every triangle.
pub fn closest_triangle<S: Scalar, M: RtiMethod<S>>(
    triangles: &[M::Prepared],
    ray: &Ray,
) -> Option<(u32, TriangleHit<S>)> {
    let scalar = |x: f32| S::from_f64(f64::from(x));
    let started = M::start(ray.origin.to_array().map(scalar), ray.dir.to_array().map(scalar))?;
    let mut best: Option<(u32, TriangleHit<S>)> = None;
    for (id, triangle) in triangles.iter().enumerate() {
        let t_max = best.as_ref().map_or(scalar(ray.t_max), |b| b.1.t);
        if let Some(hit) = M::intersect(&started, triangle, scalar(ray.t_min), t_max)
            && best.as_ref().is_none_or(|b| hit.t < b.1.t)
        {
            best = Some((id as u32, hit));
        }
    }
    best
}

struct BruteForce {
    ids: Vec<u32>,
    tester: Box<dyn LeafTester>,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    let tester = leaf_tester(&primitives, options)?;
    Ok(Box::new(BruteForce { ids: (0..primitives.len() as u32).collect(), tester }))
}

impl BruteForce {
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

impl Structure for BruteForce {
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
