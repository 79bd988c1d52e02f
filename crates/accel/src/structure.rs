//! What every acceleration structure answers.

use crate::structures::kd_tree::KdTree;
use photinus_geometry::{Hit, Primitives, Ray};
use photinus_intersect::LeafWork;
use photinus_profile::{IntersectCounters, RayTicks, TraversalCounters};
use serde::Serialize;
use std::ops::AddAssign;

/// Work done for rays: tests and traversal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RayCounters {
    /// Ray-primitive tests.
    pub intersect: IntersectCounters,
    /// Nodes and leaves.
    pub traversal: TraversalCounters,
    /// How the time was split between the two; the only part that differs from run to run.
    pub ticks: RayTicks,
}

impl RayCounters {
    /// Adds the visit of a leaf of `prims` primitives.
    pub(crate) fn add_leaf(&mut self, prims: usize, work: LeafWork) {
        self.traversal.leaves_visited += 1;
        self.traversal.leaf_prims += prims as u64;
        self.intersect.tests += u64::from(work.tests);
        self.intersect.hits += u64::from(work.hits);
    }
}

/// Runs tests, with stamps around them where `COUNT` says so.
#[inline(always)]
pub(crate) fn stamped<const COUNT: bool, T>(ticks: &mut RayTicks, tests: impl FnOnce() -> T) -> T {
    if !COUNT {
        return tests();
    }
    let begun = photinus_profile::ticks();
    let out = tests();
    ticks.tests += photinus_profile::ticks().wrapping_sub(begun);
    ticks.pairs += 1;
    out
}

/// Runs a batch of queries, with stamps around it where `COUNT` says so.
#[inline(always)]
pub(crate) fn stamped_batch<const COUNT: bool>(counters: &mut RayCounters, queries: impl FnOnce(&mut RayCounters)) {
    if !COUNT {
        return queries(counters);
    }
    let begun = photinus_profile::ticks();
    queries(counters);
    counters.ticks.total += photinus_profile::ticks().wrapping_sub(begun);
}

impl AddAssign for RayCounters {
    fn add_assign(&mut self, other: Self) {
        self.intersect += other.intersect;
        self.traversal += other.traversal;
        self.ticks += other.ticks;
    }
}

/// A leaf that a ray meets: so many references from a start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LeafRange {
    /// First place in [`Structure::refs`].
    pub start: u32,
    /// References.
    pub count: u32,
}

/// Why a structure could not be fitted to primitives that moved.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RefitError {
    /// No member of this kind can.
    #[error("{structure} cannot be fitted to moved primitives; build it anew")]
    Unsupported {
        /// Name of the member.
        structure: &'static str,
    },
    /// Other primitives than before, not the same ones elsewhere.
    #[error("{structure} was built over other primitives than these; build it anew")]
    OtherPrimitives {
        /// Name of the member.
        structure: &'static str,
    },
}

/// A finished structure, described by walking it once.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StructureSummary {
    /// Member name.
    pub name: &'static str,
    /// Levels below the root.
    pub depth: u32,
    /// Interior nodes.
    pub nodes: u64,
    /// Leaves that hold primitives.
    pub leaves: u64,
    /// Leaves without any.
    pub empty_leaves: u64,
    /// Primitive references in leaves, more than the primitives where leaves overlap.
    pub references: u64,
    /// Mean primitives in a leaf that holds any.
    pub prims_per_leaf: f64,
    /// Expected cost of a ray by the surface-area heuristic, with the costs used to build; 0 where it means nothing.
    pub sah_cost: f64,
    /// Memory of the structure, primitives it copies included.
    pub bytes: u64,
}

/// An acceleration structure.
pub trait Structure: Send + Sync {
    /// The nearest hit of each ray within its interval; `hits` is as long as `rays`.
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]);

    /// Whether each ray hits anything within its interval; `occluded` is as long as `rays`.
    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]);

    /// As [`Structure::closest_hit`], with the work and the ticks of the processor's clock added to `counters`: the same
    /// hits, more slowly.
    fn closest_hit_counted(&self, rays: &[Ray], hits: &mut [Hit], counters: &mut RayCounters);

    /// As [`Structure::any_hit`], with the work added to `counters`.
    fn any_hit_counted(&self, rays: &[Ray], occluded: &mut [bool], counters: &mut RayCounters);

    /// What was built.
    fn summary(&self) -> StructureSummary;

    /// Primitive ids of all leaves, one leaf after the other; `None` where leaves are no lists of ids.
    fn refs(&self) -> Option<&[u32]> {
        None
    }

    /// The leaves with primitives that a ray meets within its whole interval, in the order of their visits: what a unit
    /// that tests leaves is fed with. `None` where leaves are no lists of ids.
    fn leaves(&self, ray: &Ray) -> Option<Vec<LeafRange>> {
        let _ = ray;
        None
    }

    /// Fits the structure to primitives that moved: as many triangles and spheres as before, and the same indices.
    ///
    /// # Errors
    /// The structure has to be built anew; it is as it was.
    fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        let _ = primitives;
        Err(RefitError::Unsupported { structure: self.summary().name })
    }

    /// The kd-tree, where this is one: its cells can be drawn.
    fn as_kd_tree(&self) -> Option<&KdTree> {
        None
    }
}
