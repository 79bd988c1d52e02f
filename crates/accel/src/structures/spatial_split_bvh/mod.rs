//! The split bounding volume hierarchy: Stich, Friedrich, Dietrich, "Spatial Splits in Bounding Volume Hierarchies",
//! HPG 2009. Where the children of a node would overlap, its space is divided rather than its primitives, and a
//! primitive on both sides is referred to from both.

mod build;
mod spatial;

use crate::hierarchy::object_build::MAX_DEPTH;
use crate::hierarchy::rule::{Rule, reference_limit, split_alpha};
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
    shape: Shape,
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
        let tree = VolumeTree::new(build::build(primitives, rule, alpha, limit));
        Ok(Self { tree, shape: Shape::of(primitives), cost_ratio: rule.cost_ratio })
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

    /// Parts of primitives become whole ones again.
    fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        let bounds = self.shape.moved(primitives, &self.tree.refs, NAME)?;
        self.tree.refit_boxes(&bounds);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;

    /// Long thin triangles along a diagonal, side by side: no division of them keeps their boxes apart.
    fn sheaf(count: u32) -> Primitives {
        let mut out = Primitives::default();
        for i in 0..count {
            let start = Vec3::new(0.0, 0.01 * i as f32, 0.003 * (i % 7) as f32);
            out.positions.extend([start, start + Vec3::new(5.0, 5.0, 0.1), start + Vec3::new(5.0, 5.004, 0.1)]);
            out.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        out
    }

    #[test]
    fn dividing_space_makes_cheaper_trees_of_more_references() {
        let primitives = sheaf(300);
        let summary = |alpha: f64, limit: f64| {
            let options = BuildOptions { split_alpha: alpha, reference_limit: Some(limit), ..BuildOptions::default() };
            SpatialSplitBvh::new(&primitives, &options).unwrap().summary()
        };
        let never = summary(0.0, 1.0);
        let freely = summary(0.0, 16.0);
        let some = summary(0.0, 2.0);
        assert_eq!(never.references, 300);
        assert!(freely.references > 600 && freely.sah_cost < 0.6 * never.sah_cost, "{freely:?} {never:?}");
        assert!(some.references <= 600 && some.sah_cost < never.sah_cost, "{some:?}");
        // Where children may share the whole surface, space is never divided.
        assert_eq!(summary(1.0, 16.0).references, 300);
    }
}
