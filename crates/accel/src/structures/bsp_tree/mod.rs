//! The binary space partition with planes in any direction (Fuchs, Kedem, Naylor, "On Visible Surface Generation by a
//! Priori Tree Structures", SIGGRAPH 1980), planes chosen by the surface-area heuristic as in Ize, Wald, Parker, "Ray
//! Tracing with the BSP Tree", RT 2008.
//!
//! Large nodes are split across the axes as a kd-tree is, triangles cut exactly. In small ones (`--oblique-prims`) the
//! planes of the triangles and those through their edges are tried too; these cost more to pass (`--oblique-cost`). As
//! there, areas are those of the convex cells themselves. Unlike there, planes stand off the triangle that they come
//! from by the padding of [`crate::bounds`], so that it lies on one side, and what is nearer to a plane than that lies
//! on both.

mod build;
mod polytope;
mod small;
mod traverse;

use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{Structure, StructureSummary};
use build::{Built, Cut};
use photinus_geometry::{Aabb, Primitives, Ray};
use std::ops::{ControlFlow, Range};
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "bsp-tree";
/// One line for the help.
pub const SUMMARY: &str = "planes in any direction, along triangles, by the surface-area heuristic";
/// Where it was published.
pub const SOURCE: &str =
    "Ize, Wald, Parker, Ray Tracing with the BSP Tree, RT 2008; Fuchs, Kedem, Naylor, SIGGRAPH 1980";

/// A plane: the points x with `normal . x = offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plane {
    normal: [f32; 3],
    offset: f64,
}

/// A node in eight bytes: a plane, whose child below follows the node, or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Node {
    /// Bits of the position of a plane across an axis; the index of an oblique plane; a leaf's first reference.
    data: u32,
    /// The axis, [`LEAF`] or [`OBLIQUE`] in the lowest three bits; above them the child above, or the references.
    tag: u32,
}

const LEAF: u32 = 3;
const OBLIQUE: u32 = 4;

/// What a node says.
enum Unpacked {
    /// A plane across an axis, and the child above.
    Across { axis: usize, position: f32, above: usize },
    /// The index of another plane, and the child above.
    Oblique { plane: usize, above: usize },
    /// Places of the references.
    Leaf(Range<usize>),
}

impl Node {
    #[inline(always)]
    fn unpack(self) -> Unpacked {
        let (kind, rest) = (self.tag & 7, (self.tag >> 3) as usize);
        match kind {
            LEAF => Unpacked::Leaf(self.data as usize..self.data as usize + rest),
            OBLIQUE => Unpacked::Oblique { plane: self.data as usize, above: rest },
            axis => Unpacked::Across { axis: axis as usize, position: f32::from_bits(self.data), above: rest },
        }
    }
}

/// The tree.
struct BspTree {
    bounds: Aabb,
    nodes: Vec<Node>,
    planes: Vec<Plane>,
    refs: Vec<u32>,
    cost: f64,
    depth: u32,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    laboratory(BspTree::new(&primitives, options)?, &primitives, options)
}

impl BspTree {
    fn new(primitives: &Primitives, options: &BuildOptions) -> Result<Self, BuildError> {
        let (built, bounds) = build::build(primitives, options)?;
        let (nodes, planes, refs) = (Vec::new(), Vec::new(), Vec::new());
        let mut tree = Self { bounds, nodes, planes, refs, cost: built.cost(), depth: 0 };
        tree.flatten(built, 0);
        Ok(tree)
    }

    /// Appends a subtree.
    fn flatten(&mut self, built: Built, depth: u32) {
        self.depth = self.depth.max(depth);
        let place = self.nodes.len();
        match built {
            Built::Leaf(ids) => {
                self.nodes.push(Node { data: self.refs.len() as u32, tag: (ids.len() as u32) << 3 | LEAF });
                self.refs.extend(ids);
            }
            Built::Split { cut, children, .. } => {
                self.nodes.push(match cut {
                    Cut::Across { axis, position } => Node { data: position.to_bits(), tag: axis as u32 },
                    Cut::Oblique(plane) => {
                        self.planes.push(plane);
                        Node { data: self.planes.len() as u32 - 1, tag: OBLIQUE }
                    }
                });
                let [below, above] = *children;
                self.flatten(below, depth + 1);
                self.nodes[place].tag |= (self.nodes.len() as u32) << 3;
                self.flatten(above, depth + 1);
            }
        }
    }
}

impl Leaves for BspTree {
    fn refs(&self) -> &[u32] {
        &self.refs
    }

    fn walk(&self, ray: &Ray, node: impl FnMut(), leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        self.walk_cells(ray, node, leaf);
    }

    /// The cost is that of the heuristic, in triangle tests.
    fn summary(&self) -> StructureSummary {
        let bytes = size_of_val(&self.nodes[..]) + size_of_val(&self.planes[..]) + size_of_val(&self.refs[..]);
        let mut out = StructureSummary {
            name: NAME,
            depth: self.depth,
            references: self.refs.len() as u64,
            sah_cost: self.cost,
            bytes: bytes as u64,
            ..StructureSummary::default()
        };
        for node in &self.nodes {
            *match node.unpack() {
                Unpacked::Leaf(refs) if refs.is_empty() => &mut out.empty_leaves,
                Unpacked::Leaf(_) => &mut out.leaves,
                _ => &mut out.nodes,
            } += 1;
        }
        out.prims_per_leaf = if out.leaves == 0 { 0.0 } else { out.references as f64 / out.leaves as f64 };
        out
    }
}

#[cfg(test)]
mod tests;
