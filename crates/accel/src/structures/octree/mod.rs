//! The octree: cubes divided into eight equal cubes where they hold many primitives (Glassner, "Space Subdivision for
//! Fast Ray Tracing", IEEE CG&A 4(10), 1984), walked by clipping the ray to the eight parts, nearest first.
//!
//! A node is divided while it holds more primitives than a leaf should (`--leaf-size`), lies above the last level
//! (`--tree-depth`), its parts hold together less than four times what it does, and primitives and empty leaves stay
//! below 32 for each primitive.

mod build;
mod traverse;

use crate::bounds::{half_area_f64, size_f64};
use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions, check};
use crate::structure::{Structure, StructureSummary};
use build::{Built, Rule, part};
use photinus_geometry::{Aabb, Primitives, Ray};
use std::ops::{ControlFlow, Range};
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "octree";
/// One line for the help.
pub const SUMMARY: &str = "cubes divided into eight where they hold many primitives";
/// Where it was published.
pub const SOURCE: &str = "Glassner, IEEE CG&A 4(10), 1984";

/// Most levels below the root.
const MAX_DEPTH: u32 = 24;
/// Primitives of a leaf where none are asked for.
const LEAF_SIZE: u32 = 6;

/// A node in eight bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Node {
    /// The first of eight children that lie together; of a leaf its first reference.
    data: u32,
    /// References of a leaf; [`INTERIOR`] for other nodes.
    count: u32,
}

/// The count of a node with children.
const INTERIOR: u32 = u32::MAX;

/// What a node says.
enum Unpacked {
    /// Index of the first child.
    Interior(usize),
    /// Places of the references.
    Leaf(Range<usize>),
}

impl Node {
    #[inline(always)]
    fn unpack(self) -> Unpacked {
        let data = self.data as usize;
        if self.count == INTERIOR { Unpacked::Interior(data) } else { Unpacked::Leaf(data..data + self.count as usize) }
    }
}

/// The tree.
struct Octree {
    /// Padded bounds of all primitives that can be hit.
    bounds: Aabb,
    /// The root's cell: a cube around them.
    cube: Aabb,
    nodes: Vec<Node>,
    refs: Vec<u32>,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    laboratory(Octree::new(&primitives, options)?, &primitives, options)
}

impl Octree {
    fn new(primitives: &Primitives, options: &BuildOptions) -> Result<Self, BuildError> {
        let (leaf_size, depth) = (options.leaf_size.unwrap_or(LEAF_SIZE), options.tree_depth);
        check("the leaf size", leaf_size, (1..=1 << 20).contains(&leaf_size), "1 to 2^20")?;
        check("the depth of the tree", depth, depth <= MAX_DEPTH, "0 to 24")?;
        let rule = Rule { leaf_size: leaf_size as usize, max_depth: depth, clip: options.clip };
        let (built, bounds, cube) = build::build(primitives, rule);
        let mut tree = Self { bounds, cube, nodes: vec![Node { data: 0, count: 0 }], refs: Vec::new() };
        tree.place(built, 0);
        Ok(tree)
    }

    /// Writes a subtree whose root lies at `index`.
    fn place(&mut self, built: Built, index: usize) {
        match built {
            Built::Leaf(ids) => {
                self.nodes[index] = Node { data: self.refs.len() as u32, count: ids.len() as u32 };
                self.refs.extend(ids);
            }
            Built::Interior(children) => {
                let first = self.nodes.len();
                self.nodes[index] = Node { data: first as u32, count: INTERIOR };
                self.nodes.resize(first + 8, Node { data: 0, count: 0 });
                for (i, child) in children.into_iter().enumerate() {
                    self.place(child, first + i);
                }
            }
        }
    }

    /// Hands out every node with its levels below the root and its cell.
    fn visit_cells(&self, mut visit: impl FnMut(u32, &Aabb, &Unpacked)) {
        let mut waiting = vec![(0, 0, self.cube)];
        while let Some((index, depth, cell)) = waiting.pop() {
            let node = self.nodes[index].unpack();
            if let Unpacked::Interior(first) = node {
                waiting.extend((0..8).rev().map(|i| (first + i, depth + 1, part(&cell, i))));
            }
            visit(depth, &cell, &node);
        }
    }
}

impl Leaves for Octree {
    fn refs(&self) -> &[u32] {
        &self.refs
    }

    fn walk(&self, ray: &Ray, node: impl FnMut(), leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        self.walk_cells(ray, node, leaf);
    }

    /// The cost is that of the tests of a ray through the bounds, parts of them being met by chance as their area says.
    fn summary(&self) -> StructureSummary {
        let mut out = StructureSummary {
            name: NAME,
            references: self.refs.len() as u64,
            bytes: (size_of_val(&self.nodes[..]) + size_of_val(&self.refs[..])) as u64,
            ..StructureSummary::default()
        };
        let half_area = |b: &Aabb| half_area_f64(size_f64(b));
        let whole = half_area(&self.bounds);
        let within = |cell: &Aabb| Aabb { min: cell.min.max(self.bounds.min), max: cell.max.min(self.bounds.max) };
        self.visit_cells(|depth, cell, node| {
            out.depth = out.depth.max(depth);
            match node {
                Unpacked::Interior(_) => out.nodes += 1,
                Unpacked::Leaf(refs) if refs.is_empty() => out.empty_leaves += 1,
                Unpacked::Leaf(refs) => {
                    out.leaves += 1;
                    out.sah_cost +=
                        if whole > 0.0 { half_area(&within(cell)) / whole * refs.len() as f64 } else { 0.0 };
                }
            }
        });
        out.prims_per_leaf = if out.leaves == 0 { 0.0 } else { out.references as f64 / out.leaves as f64 };
        out
    }
}

#[cfg(test)]
mod tests;
