//! What the laboratory's structures share: each says which leaves a ray meets, and the rest is the same for all.

use crate::structure::{LeafRange, RayCounters, RefitError, Structure, StructureSummary, stamped, stamped_batch};
use crate::structures::kd_tree::KdTree;
use photinus_geometry::{Hit, Primitives, Ray, Vec3};
use photinus_intersect::LeafTester;
use std::ops::{ControlFlow, Range};

/// A leaf on a ray's way.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LeafVisit {
    /// Places of its primitives in [`Leaves::refs`]; at least one.
    pub refs: Range<usize>,
    /// No later leaf holds a hit nearer than this that is not in this or an earlier one; minus infinity where nothing
    /// of the kind is known.
    pub exit: f32,
}

/// A structure whose leaves are lists of primitive ids.
pub(crate) trait Leaves: Send + Sync + 'static {
    /// Primitive ids of all leaves, one leaf after the other.
    fn refs(&self) -> &[u32];

    /// Calls `node` at every interior node (or cell) visited and `leaf` at every leaf with primitives that the ray may
    /// hit within its interval, until that breaks. It continues with the end of what is left of the ray: where no hit
    /// lies at or before that, nothing need be visited. Rays that are not finite, have no direction or an empty
    /// interval ([`can_hit`]) visit nothing.
    fn walk(&self, ray: &Ray, node: impl FnMut(), leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>);

    /// What was built; of memory only its own.
    fn summary(&self) -> StructureSummary;

    /// Fits the structure to primitives that moved: as many triangles and spheres as before, and the same indices.
    ///
    /// # Errors
    /// The structure has to be built anew.
    fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        let _ = primitives;
        Err(RefitError::Unsupported { structure: self.summary().name })
    }

    /// See [`Structure::as_kd_tree`].
    fn as_kd_tree(&self) -> Option<&KdTree> {
        None
    }
}

/// Whether a ray can hit anything.
pub(crate) fn can_hit(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.dir.is_finite() && ray.dir != Vec3::ZERO && ray.t_min <= ray.t_max
}

/// Leaves with the tests that their primitives get.
pub(crate) struct Laboratory<L> {
    /// The structure.
    pub leaves: L,
    /// Tests primitives.
    pub tester: Box<dyn LeafTester>,
    /// Prepares the tests anew for primitives that moved.
    pub retest: fn(&Primitives) -> Box<dyn LeafTester>,
}

impl<L: Leaves> Laboratory<L> {
    /// The nearest hit of a ray; counts the work where `COUNT` says so.
    #[inline(always)]
    fn closest<const COUNT: bool>(&self, ray: &Ray, counters: &mut RayCounters) -> Hit {
        let mut best = Hit::MISS;
        let mut nodes = 0;
        let leaf = |LeafVisit { refs, exit }| {
            let ids = &self.leaves.refs()[refs];
            let work = stamped::<COUNT, _>(&mut counters.ticks, || self.tester.closest_hit(ray, ids, &mut best));
            if COUNT {
                counters.add_leaf(ids.len(), work);
            }
            if best.t < exit { ControlFlow::Break(()) } else { ControlFlow::Continue(ray.t_max.min(best.t)) }
        };
        self.leaves.walk(ray, || nodes += u64::from(COUNT), leaf);
        counters.traversal.nodes_visited += nodes;
        best
    }

    /// Whether a ray hits anything; counts the work where `COUNT` says so.
    #[inline(always)]
    fn any<const COUNT: bool>(&self, ray: &Ray, counters: &mut RayCounters) -> bool {
        let mut found = false;
        let mut nodes = 0;
        let leaf = |LeafVisit { refs, .. }| {
            let ids = &self.leaves.refs()[refs];
            let (any, work) = stamped::<COUNT, _>(&mut counters.ticks, || self.tester.any_hit(ray, ids));
            if COUNT {
                counters.add_leaf(ids.len(), work);
            }
            found = any;
            if any { ControlFlow::Break(()) } else { ControlFlow::Continue(ray.t_max) }
        };
        self.leaves.walk(ray, || nodes += u64::from(COUNT), leaf);
        counters.traversal.nodes_visited += nodes;
        found
    }

    fn closest_batch<const COUNT: bool>(&self, rays: &[Ray], hits: &mut [Hit], counters: &mut RayCounters) {
        assert_eq!(rays.len(), hits.len());
        counters.traversal.rays += rays.len() as u64;
        stamped_batch::<COUNT>(counters, |counters| {
            for (ray, hit) in rays.iter().zip(hits) {
                *hit = self.closest::<COUNT>(ray, counters);
            }
        });
    }

    fn any_batch<const COUNT: bool>(&self, rays: &[Ray], occluded: &mut [bool], counters: &mut RayCounters) {
        assert_eq!(rays.len(), occluded.len());
        counters.traversal.rays += rays.len() as u64;
        stamped_batch::<COUNT>(counters, |counters| {
            for (ray, hit) in rays.iter().zip(occluded) {
                *hit = self.any::<COUNT>(ray, counters);
            }
        });
    }
}

impl<L: Leaves> Structure for Laboratory<L> {
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

    fn refs(&self) -> Option<&[u32]> {
        Some(self.leaves.refs())
    }

    fn leaves(&self, ray: &Ray) -> Option<Vec<LeafRange>> {
        let mut out = Vec::new();
        let leaf = |visit: LeafVisit| {
            out.push(LeafRange { start: visit.refs.start as u32, count: visit.refs.len() as u32 });
            ControlFlow::Continue(ray.t_max)
        };
        self.leaves.walk(ray, || {}, leaf);
        Some(out)
    }

    fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        self.leaves.refit(primitives)?;
        self.tester = (self.retest)(primitives);
        Ok(())
    }

    fn summary(&self) -> StructureSummary {
        let own = self.leaves.summary();
        StructureSummary { bytes: own.bytes + self.tester.bytes(), ..own }
    }

    fn as_kd_tree(&self) -> Option<&KdTree> {
        self.leaves.as_kd_tree()
    }
}
