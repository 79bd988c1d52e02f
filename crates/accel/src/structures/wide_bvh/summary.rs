//! A finished tree, described by walking it.

use super::binary::scaled_half_area;
use super::layout::{BLOCK, Child, NODE};
use super::{NAME, WideBvh};
use crate::structure::StructureSummary;
#[cfg(test)]
use photinus_geometry::Aabb;

/// Describes the tree. The cost counts a node and a block of triangles as one each, an id as one.
pub fn summary(tree: &WideBvh) -> StructureSummary {
    let mut out = StructureSummary {
        name: NAME,
        depth: tree.levels,
        bytes: (size_of_val(&tree.nodes[..]) + size_of_val(&tree.blocks[..]) + size_of_val(&tree.ids[..])) as u64
            + tree.tester.bytes(),
        ..StructureSummary::default()
    };
    let mut waiting = vec![(Child::node(0), tree.bounds)];
    let scale = 1.0 / tree.bounds.size().max_element();
    let area = scaled_half_area(&tree.bounds, scale);
    while let Some((child, bounds)) = waiting.pop() {
        let share = if area > 0.0 { f64::from(scaled_half_area(&bounds, scale) / area) } else { 0.0 };
        match child.kind() {
            NODE => {
                out.nodes += 1;
                out.sah_cost += share;
                let node = &tree.nodes[child.index()];
                waiting.extend((0..node.len()).map(|slot| (node.children[slot], node.child_bounds(slot))));
            }
            BLOCK => {
                out.leaves += 1;
                out.sah_cost += share;
                out.references += tree.blocks[child.index()].len() as u64;
            }
            _ => {
                out.leaves += 1;
                out.sah_cost += share * child.ids_range().len() as f64;
                out.references += child.ids_range().len() as u64;
            }
        }
    }
    out.prims_per_leaf = if out.leaves == 0 { 0.0 } else { out.references as f64 / out.leaves as f64 };
    out
}

impl WideBvh {
    /// Checks that every box holds what is in it: the bounds of a child's children and its triangles' vertices.
    #[cfg(test)]
    pub(super) fn validate(&self) {
        let holds = |outer: &Aabb, inner: &Aabb| outer.union(*inner) == *outer;
        let mut waiting = vec![(Child::node(0), self.bounds)];
        while let Some((child, bounds)) = waiting.pop() {
            match child.kind() {
                NODE => {
                    let node = &self.nodes[child.index()];
                    for slot in 0..node.len() {
                        assert!(holds(&bounds, &node.child_bounds(slot)));
                        waiting.push((node.children[slot], node.child_bounds(slot)));
                    }
                }
                BLOCK => {
                    let block = &self.blocks[child.index()];
                    for (lane, row) in (0..block.len()).flat_map(|l| (0..9).map(move |row| (l, row))) {
                        let x = block.vertices[row][lane];
                        assert!(x.is_nan() || bounds.min[row % 3] < x && x < bounds.max[row % 3]);
                    }
                }
                _ => {}
            }
        }
    }
}
