//! The kd-tree of the thesis (section 3.1.1): split planes by the surface-area heuristic with free costs, three ways to
//! choose split candidates, cost as the only reason to stop, ordered recursive traversal. Triangles may be cut to the cells
//! they are split over.
//!
//! Memory and time stay bounded on any input: no tree is deeper than 96 levels or holds more than 32 leaves and
//! references for each primitive. Trees by sensible costs come nowhere near either.

pub(super) mod build;
mod quadratic;
mod traverse;

use crate::bounds::{half_area_f64, size_f64};
use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions, check};
use crate::structure::{LeafRange, Structure, StructureSummary};
use build::{Built, Rule};
use photinus_geometry::{Aabb, Primitives, Ray};
use std::ops::{ControlFlow, Range};
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "kd-tree";
/// One line for the help.
pub const SUMMARY: &str = "kd-tree by the surface-area heuristic, as in the thesis";
/// Where it was published.
pub const SOURCE: &str = "Havran, PhD thesis, 2000; MacDonald, Booth, The Visual Computer 6, 1990";

/// A node in eight bytes: a split plane, whose child below follows the node, or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct KdNode {
    /// Bits of the plane's position; the leaf's first reference.
    data: u32,
    /// Axis of the plane, or 3, in the lowest two bits; above them the index of the child above, or the number of
    /// references.
    tag: u32,
}

/// What a node says.
#[derive(Clone, Debug, PartialEq)]
enum Unpacked {
    Interior { axis: usize, position: f32, above: usize },
    Leaf { refs: Range<usize> },
}

impl KdNode {
    #[inline(always)]
    fn unpack(self) -> Unpacked {
        let (axis, rest) = ((self.tag & 3) as usize, (self.tag >> 2) as usize);
        if axis < 3 {
            Unpacked::Interior { axis, position: f32::from_bits(self.data), above: rest }
        } else {
            Unpacked::Leaf { refs: self.data as usize..self.data as usize + rest }
        }
    }
}

/// A node of the tree with its cell, as [`KdTree::visit_cells`] hands it out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KdCell {
    /// Levels below the root.
    pub depth: u32,
    /// The cell.
    pub bounds: Aabb,
    /// What is there.
    pub kind: KdCellKind,
}

/// What a cell is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KdCellKind {
    /// Split by a plane.
    Interior {
        /// Axis that the plane is perpendicular to: 0 to 2.
        axis: usize,
        /// Where it cuts the axis, in scene units.
        position: f32,
    },
    /// A leaf, perhaps without primitives.
    Leaf(LeafRange),
}

/// The tree.
pub struct KdTree {
    bounds: Aabb,
    nodes: Vec<KdNode>,
    refs: Vec<u32>,
    cost_ratio: f64,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    let leaves = KdTree::new(&primitives, options)?;
    laboratory(leaves, &primitives, options)
}

impl KdTree {
    /// Builds the tree over primitives whose vertex indices are in range.
    ///
    /// # Errors
    /// A cost that is negative or not finite, a triangle cost of zero, no candidates.
    pub fn new(primitives: &Primitives, options: &BuildOptions) -> Result<Self, BuildError> {
        let rule = rule(options)?;
        let (built, bounds) = build::build(primitives, rule);
        let mut tree = Self { bounds, nodes: Vec::new(), refs: Vec::new(), cost_ratio: rule.cost_ratio };
        tree.flatten(built);
        Ok(tree)
    }

    /// Appends a subtree.
    fn flatten(&mut self, built: Built) {
        let place = self.nodes.len();
        match built {
            Built::Leaf(ids) => {
                self.nodes.push(KdNode { data: self.refs.len() as u32, tag: (ids.len() as u32) << 2 | 3 });
                self.refs.extend(ids);
            }
            Built::Split { axis, position, children } => {
                self.nodes.push(KdNode { data: position.to_bits(), tag: axis as u32 });
                let [below, above] = *children;
                self.flatten(below);
                self.nodes[place].tag |= (self.nodes.len() as u32) << 2;
                self.flatten(above);
            }
        }
    }

    /// Primitive ids of all leaves, one leaf after the other.
    pub fn refs(&self) -> &[u32] {
        &self.refs
    }

    /// Bounds of the root's cell; empty where the tree is.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Hands out every node with its cell, parents before children and below before above.
    pub fn visit_cells(&self, mut visit: impl FnMut(&KdCell)) {
        let mut waiting = vec![(0, 0, self.bounds)];
        while let Some((index, depth, bounds)) = waiting.pop() {
            let kind = match self.nodes[index].unpack() {
                Unpacked::Interior { axis, position, above } => {
                    let (mut below_bounds, mut above_bounds) = (bounds, bounds);
                    below_bounds.max[axis] = position;
                    above_bounds.min[axis] = position;
                    waiting.push((above, depth + 1, above_bounds));
                    waiting.push((index + 1, depth + 1, below_bounds));
                    KdCellKind::Interior { axis, position }
                }
                Unpacked::Leaf { refs } => {
                    KdCellKind::Leaf(LeafRange { start: refs.start as u32, count: refs.len() as u32 })
                }
            };
            visit(&KdCell { depth, bounds, kind });
        }
    }
}

/// Checks the options.
fn rule(options: &BuildOptions) -> Result<Rule, BuildError> {
    let count = options.candidate_count;
    check("the number of split candidates", count, (1..=100_000).contains(&count), "1 to 100000")?;
    let BuildOptions { candidates, clip, .. } = *options;
    Ok(Rule { cost_ratio: options.cost_ratio()?, candidates, count: count as usize, clip, stop: 0 })
}

impl Leaves for KdTree {
    fn refs(&self) -> &[u32] {
        &self.refs
    }

    fn walk(&self, ray: &Ray, node: impl FnMut(), leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        self.walk_cells(ray, node, leaf);
    }

    fn as_kd_tree(&self) -> Option<&KdTree> {
        Some(self)
    }

    /// The cost is that of the heuristic, in triangle tests: nodes count for the ratio of the costs.
    fn summary(&self) -> StructureSummary {
        let mut out = StructureSummary {
            name: NAME,
            references: self.refs.len() as u64,
            bytes: (size_of_val(&self.nodes[..]) + size_of_val(&self.refs[..])) as u64,
            ..StructureSummary::default()
        };
        let half_area = |b: &Aabb| half_area_f64(size_f64(b));
        let whole = half_area(&self.bounds);
        self.visit_cells(|cell| {
            out.depth = out.depth.max(cell.depth);
            let share = if whole > 0.0 { half_area(&cell.bounds) / whole } else { 0.0 };
            match cell.kind {
                KdCellKind::Interior { .. } => {
                    out.nodes += 1;
                    out.sah_cost += share * self.cost_ratio;
                }
                KdCellKind::Leaf(LeafRange { count: 0, .. }) => out.empty_leaves += 1,
                KdCellKind::Leaf(leaf) => {
                    out.leaves += 1;
                    out.sah_cost += share * f64::from(leaf.count);
                }
            }
        });
        out.prims_per_leaf = if out.leaves == 0 { 0.0 } else { out.references as f64 / out.leaves as f64 };
        out
    }
}

#[cfg(test)]
mod tests;
