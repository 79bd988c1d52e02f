//! The split bounding volume hierarchy: Stich, Friedrich, Dietrich, "Spatial Splits in Bounding Volume Hierarchies",
//! HPG 2009. Where the children of a node would overlap, its space is divided rather than its primitives, and a
//! primitive on both sides is referred to from both.

mod build;
mod spatial;

use crate::hierarchy::object_build::MAX_DEPTH;
use crate::hierarchy::rule::{Rule, reference_limit, split_alpha};
use crate::hierarchy::volume::Volume;
use crate::hierarchy::volume_tree::VolumeTree;
use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{Structure, StructureSummary};
use photinus_geometry::{Aabb, Primitives, Ray};
use std::ops::ControlFlow;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "spatial-split-bvh";
/// One line for the help.
pub const SUMMARY: &str = "binned-bvh that divides space where children would overlap";
/// Where it was published.
pub const SOURCE: &str = "Stich, Friedrich, Dietrich, HPG 2009";

/// References for each primitive where the options name no limit.
const REFERENCE_LIMIT: f64 = 4.0;

/// The tree.
struct SpatialSplitBvh {
    tree: VolumeTree<Aabb, { MAX_DEPTH + 2 }>,
    cost_ratio: f64,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    laboratory(SpatialSplitBvh::new(&primitives, options)?, &primitives, options)
}

impl SpatialSplitBvh {
    fn new(primitives: &Primitives, options: &BuildOptions) -> Result<Self, BuildError> {
        let (rule, alpha, limit) =
            (Rule::new(options)?, split_alpha(options)?, reference_limit(options, REFERENCE_LIMIT)?);
        Ok(Self { tree: VolumeTree::new(build::build(primitives, rule, alpha, limit)), cost_ratio: rule.cost_ratio })
    }
}

impl Leaves for SpatialSplitBvh {
    fn refs(&self) -> &[u32] {
        &self.tree.refs
    }

    #[inline(always)]
    fn walk(&self, ray: &Ray, node: impl FnMut(), mut leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        let Some(prepared) = Aabb::prepare(ray) else { return };
        let visit = |refs, _| leaf(LeafVisit { refs, exit: f32::NEG_INFINITY });
        let _ = self.tree.walk_from(0, &prepared, ray.t_max, node, visit);
    }

    /// The cost is that of the heuristic, in triangle tests: nodes count for the ratio of the costs.
    fn summary(&self) -> StructureSummary {
        self.tree.summary(NAME, self.cost_ratio)
    }
}
