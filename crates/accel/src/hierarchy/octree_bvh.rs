//! The thesis's bounding volume hierarchy around any volume: divided by voxels, walked nearest volumes first.

use super::octree::{self, STACK};
use super::rule::{Rule, leaf_size, reference_limit};
use super::shape::Shape;
use super::volume::Fit;
use super::volume_tree::VolumeTree;
use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{RefitError, Structure, StructureSummary};
use photinus_geometry::{Primitives, Ray};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Most primitives in a leaf where the options name no number: the least render time of the thesis's Table 5.
const LEAF_SIZE: usize = 16;

/// References for each primitive where the options name no limit.
const REFERENCE_LIMIT: f64 = 16.0;

/// The tree.
pub(crate) struct OctreeBvh<V> {
    /// The volumes.
    pub tree: VolumeTree<V, STACK>,
    name: &'static str,
    shape: Shape,
    cost_ratio: f64,
}

impl<V: Fit> OctreeBvh<V> {
    /// Builds the tree of the member called `name`.
    ///
    /// # Errors
    /// An option out of its range.
    pub fn new(name: &'static str, primitives: &Primitives, options: &BuildOptions) -> Result<Self, BuildError> {
        let cost_ratio = Rule::new(options)?.cost_ratio;
        let (leaf_size, limit) = (leaf_size(options, LEAF_SIZE)?, reference_limit(options, REFERENCE_LIMIT)?);
        let tree = VolumeTree::new(octree::build(primitives, leaf_size, limit));
        Ok(Self { tree, name, shape: Shape::of(primitives), cost_ratio })
    }
}

/// Builds the member called `name`; see [`crate::build`].
pub(crate) fn build<V: Fit>(
    name: &'static str,
    primitives: &Arc<Primitives>,
    options: &BuildOptions,
) -> Result<Box<dyn Structure>, BuildError> {
    laboratory(OctreeBvh::<V>::new(name, primitives, options)?, primitives, options)
}

impl<V: Fit> Leaves for OctreeBvh<V> {
    fn refs(&self) -> &[u32] {
        &self.tree.refs
    }

    #[inline(always)]
    fn walk(&self, ray: &Ray, node: impl FnMut(), mut leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        let Some(prepared) = V::prepare(ray) else { return };
        let visit = |refs, _| leaf(LeafVisit { refs, exit: f32::NEG_INFINITY });
        let _ = self.tree.walk_from(0, &prepared, ray.t_max, node, visit);
    }

    /// The cost is that of the heuristic over the volumes' surfaces, in triangle tests.
    fn summary(&self) -> StructureSummary {
        self.tree.summary(self.name, self.cost_ratio)
    }

    /// Volumes are fitted to whole primitives, not to their parts in voxels: right, but looser than a new tree.
    fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        let bounds = self.shape.moved(primitives, &self.tree.refs, self.name)?;
        self.tree.refit_points(primitives, &bounds);
        Ok(())
    }
}
