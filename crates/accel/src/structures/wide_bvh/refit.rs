//! Fitting the tree to primitives that moved: triangles are read anew, boxes grow and shrink from the leaves up, and what
//! hangs below what stays.

use super::doubled::hide_doubled;
use super::layout::{BLOCK, Child, NODE, Node, TriangleBlock, WIDTH};
use super::{NAME, WideBvh};
use crate::structure::RefitError;
use arrayvec::ArrayVec;
use photinus_geometry::{Aabb, NO_HIT, Primitives};
use rayon::prelude::*;

/// Blocks that a thread fits at a time.
const SHARE: usize = 64;

impl WideBvh {
    /// See [`Structure::refit`](crate::Structure::refit).
    pub(super) fn fit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        let held: Vec<u32> = self.blocks.iter().flat_map(block_ids).chain(self.ids.iter().copied()).collect();
        let bounds = self.shape.moved(primitives, &held, NAME)?;
        self.blocks.par_iter_mut().with_min_len(SHARE).for_each(|block| fit_block(block, primitives, &bounds));
        // Children lie behind their parents.
        let mut boxes = vec![Aabb::EMPTY; self.nodes.len()];
        for index in (0..self.nodes.len()).rev() {
            let children = self.nodes[index].children;
            let children: ArrayVec<_, WIDTH> = children
                .into_iter()
                .filter(|child| *child != Child::block(0))
                .map(|child| (self.child_box(child, &boxes, &bounds), child))
                .collect();
            boxes[index] = children.iter().fold(Aabb::EMPTY, |all, (own, _)| all.union(*own));
            self.nodes[index] = Node::new(&children);
        }
        self.bounds = boxes[0];
        self.tester = (self.retest)(primitives);
        Ok(())
    }

    /// The box of what hangs in a slot: `boxes` are those of nodes, `bounds` those of primitives.
    fn child_box(&self, child: Child, boxes: &[Aabb], bounds: &[Aabb]) -> Aabb {
        let all = |ids: &mut dyn Iterator<Item = u32>| ids.fold(Aabb::EMPTY, |all, id| all.union(bounds[id as usize]));
        match child.kind() {
            NODE => boxes[child.index()],
            BLOCK => all(&mut block_ids(&self.blocks[child.index()])),
            _ => all(&mut self.ids[child.ids_range()].iter().copied()),
        }
    }
}

fn block_ids(block: &TriangleBlock) -> impl Iterator<Item = u32> + use<> {
    block.ids.into_iter().filter(|id| *id != NO_HIT)
}

/// Reads the triangles of a block anew. Those that nothing can hit, or that lie on others, stay in their lanes as what no ray hits, and may come back.
fn fit_block(block: &mut TriangleBlock, primitives: &Primitives, bounds: &[Aabb]) {
    for (lane, id) in block.ids.into_iter().enumerate().filter(|(_, id)| *id != NO_HIT) {
        let is_hittable = !bounds[id as usize].is_empty();
        for (v, p) in primitives.triangle(id as usize).iter().enumerate() {
            for axis in 0..3 {
                block.vertices[3 * v + axis][lane] = if is_hittable { p[axis] } else { f32::NAN };
            }
        }
    }
    hide_doubled(block);
}
