//! A binary bounding volume hierarchy by the surface-area heuristic over binned middles: Wald, RT 2007. Leaves hold as
//! many primitives as their costs say.

use crate::hierarchy::object_build::{self, ByCost, MAX_DEPTH};
use crate::hierarchy::refs::gather;
use crate::hierarchy::rule::Rule;
use crate::hierarchy::shape::Shape;
use crate::hierarchy::volume::Volume;
use crate::hierarchy::volume_tree::VolumeTree;
use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{RefitError, Structure, StructureSummary};
use photinus_geometry::{Aabb, Primitives, Ray};
use std::ops::ControlFlow;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "binned-bvh";
/// One line for the help.
pub const SUMMARY: &str = "binary bounding volume hierarchy by the binned surface-area heuristic";
/// Where it was published.
pub const SOURCE: &str = "Wald, RT 2007";

/// The tree.
struct BinnedBvh {
    tree: VolumeTree<Aabb, { MAX_DEPTH + 2 }>,
    shape: Shape,
    cost_ratio: f64,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    laboratory(BinnedBvh::new(&primitives, options)?, &primitives, options)
}

impl BinnedBvh {
    fn new(primitives: &Primitives, options: &BuildOptions) -> Result<Self, BuildError> {
        let rule = Rule::new(options)?;
        let mut refs = gather(primitives);
        let built = (!refs.is_empty()).then(|| object_build::build(&ByCost(rule), &mut refs, ()));
        Ok(Self { tree: VolumeTree::new(built), shape: Shape::of(primitives), cost_ratio: rule.cost_ratio })
    }
}

impl Leaves for BinnedBvh {
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

    fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        let bounds = self.shape.moved(primitives, &self.tree.refs, NAME)?;
        self.tree.refit_boxes(&bounds);
        Ok(())
    }
}
