//! The bounding interval hierarchy: Waechter and Keller, "Instant Ray Tracing: The Bounding Interval Hierarchy",
//! EGSR 2006. Every node holds two planes across one axis: the upper end of what lies below, the lower end of what lies
//! above.
//!
//! Split candidates are the middles of cells, halved along their longest axis from the bounds of the scene, whatever
//! the primitives' own bounds (the paper's global heuristic); a primitive goes to the side of its middle.

use crate::hierarchy::interval_tree::{IntervalTree, Planes};
use crate::hierarchy::object_build::{self, Heuristic, Split};
use crate::hierarchy::refs::{BuildRef, bounds_of, gather, partition};
use crate::hierarchy::rule::{Rule, leaf_size};
use crate::hierarchy::shape::Shape;
use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{RefitError, Structure, StructureSummary};
use photinus_geometry::{Aabb, Primitives, Ray};
use std::ops::ControlFlow;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "bih";
/// One line for the help.
pub const SUMMARY: &str = "bounding interval hierarchy: two planes a node, quickest to build";
/// Where it was published.
pub const SOURCE: &str = "Waechter, Keller, EGSR 2006";

/// Most primitives in a leaf where the options name no number.
const LEAF_SIZE: usize = 4;

/// The upper end of the first child and the lower end of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TwoPlanes {
    first_high: f32,
    second_low: f32,
}

impl Planes for TwoPlanes {
    fn around([first, second]: [&Aabb; 2], axis: usize) -> Self {
        Self { first_high: first.max[axis], second_low: second.min[axis] }
    }

    #[inline(always)]
    fn slabs(&self) -> [[f32; 2]; 2] {
        [[f32::NEG_INFINITY, self.first_high], [self.second_low, f32::INFINITY]]
    }
}

/// Halves cells.
struct Middle {
    leaf_size: usize,
}

impl Heuristic for Middle {
    /// The cell.
    type State = Aabb;

    fn split(&self, refs: &mut [BuildRef], _: &Aabb, mut cell: Aabb) -> Option<Split<Aabb>> {
        if refs.len() <= self.leaf_size {
            return None;
        }
        // Cells of which one half alone is occupied shrink to it. Every step halves one edge, and edges end where no
        // float lies between their ends.
        loop {
            let size = cell.max * 0.5 - cell.min * 0.5;
            let axis = [0, 1, 2].into_iter().fold(0, |a, b| if size[b] > size[a] { b } else { a });
            let middle = cell.min[axis] * 0.5 + cell.max[axis] * 0.5;
            if !(cell.min[axis] < middle && middle < cell.max[axis]) {
                return None;
            }
            let first_count = partition(refs, |r| r.centroid(axis) < middle);
            let (mut below, mut above) = (cell, cell);
            below.max[axis] = middle;
            above.min[axis] = middle;
            if first_count == 0 {
                cell = above;
            } else if first_count == refs.len() {
                cell = below;
            } else {
                return Some(Split { first_count, axis, states: [below, above] });
            }
        }
    }

    fn leaf_size(&self) -> usize {
        self.leaf_size
    }
}

/// The tree.
struct Bih {
    tree: IntervalTree<TwoPlanes>,
    shape: Shape,
    cost_ratio: f64,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    let (cost_ratio, middle) = (Rule::new(options)?.cost_ratio, Middle { leaf_size: leaf_size(options, LEAF_SIZE)? });
    let mut refs = gather(&primitives);
    let bounds = bounds_of(&refs);
    let built = (!refs.is_empty()).then(|| object_build::build(&middle, &mut refs, bounds));
    laboratory(Bih { tree: IntervalTree::new(built), shape: Shape::of(&primitives), cost_ratio }, &primitives, options)
}

impl Leaves for Bih {
    fn refs(&self) -> &[u32] {
        &self.tree.refs
    }

    #[inline(always)]
    fn walk(&self, ray: &Ray, node: impl FnMut(), leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        self.tree.walk(ray, node, leaf);
    }

    /// The cost is that of the surface-area heuristic over the boxes that planes leave, in triangle tests.
    fn summary(&self) -> StructureSummary {
        self.tree.summary(NAME, self.cost_ratio)
    }

    fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        let bounds = self.shape.moved(primitives, &self.tree.refs, NAME)?;
        self.tree.refit(&bounds);
        Ok(())
    }
}
