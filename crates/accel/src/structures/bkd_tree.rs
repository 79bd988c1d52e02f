//! The bounded kd-tree: Woop, Marmitt, Slusallek, "B-KD Trees for Hardware Accelerated Ray Tracing of Dynamic Scenes",
//! GH 2006. Every node bounds both children between two planes each, all across one axis.
//!
//! Primitives are divided by the binned surface-area heuristic, as the paper divides them by the full one. Leaves have
//! no planes of their own.

use crate::hierarchy::interval_tree::{IntervalTree, Planes};
use crate::hierarchy::object_build::{self, ByCost};
use crate::hierarchy::refs::gather;
use crate::hierarchy::rule::Rule;
use crate::hierarchy::shape::Shape;
use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{RefitError, Structure, StructureSummary};
use photinus_geometry::{Aabb, Primitives, Ray};
use std::ops::ControlFlow;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "bkd-tree";
/// One line for the help.
pub const SUMMARY: &str = "bounded kd-tree: two planes around each child, across one axis";
/// Where it was published.
pub const SOURCE: &str = "Woop, Marmitt, Slusallek, GH 2006";

/// Two planes around each child.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FourPlanes([[f32; 2]; 2]);

impl Planes for FourPlanes {
    fn around(children: [&Aabb; 2], axis: usize) -> Self {
        Self(children.map(|b| [b.min[axis], b.max[axis]]))
    }

    #[inline(always)]
    fn slabs(&self) -> [[f32; 2]; 2] {
        self.0
    }
}

/// The tree.
struct BkdTree {
    tree: IntervalTree<FourPlanes>,
    shape: Shape,
    cost_ratio: f64,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    let rule = Rule::new(options)?;
    let mut refs = gather(&primitives);
    let built = (!refs.is_empty()).then(|| object_build::build(&ByCost(rule), &mut refs, ()));
    let (shape, cost_ratio) = (Shape::of(&primitives), rule.cost_ratio);
    laboratory(BkdTree { tree: IntervalTree::new(built), shape, cost_ratio }, &primitives, options)
}

impl Leaves for BkdTree {
    fn refs(&self) -> &[u32] {
        &self.tree.refs
    }

    #[inline(always)]
    fn walk(&self, ray: &Ray, node: impl FnMut(), leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        self.tree.walk(ray, node, leaf);
    }

    /// The cost is that of the heuristic over the boxes that planes leave, in triangle tests.
    fn summary(&self) -> StructureSummary {
        self.tree.summary(NAME, self.cost_ratio)
    }

    fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        let bounds = self.shape.moved(primitives, &self.tree.refs, NAME)?;
        self.tree.refit(&bounds);
        Ok(())
    }
}
