//! The walk of a ray: at every node it is clipped by the three planes through the middle, one after the other, and
//! goes on in the parts that it meets, in the order of its direction.

use super::build::{middle, part};
use super::{Octree, Unpacked};
use crate::laboratory::LeafVisit;
use crate::planes::{Sides, clip, sides};
use arrayvec::ArrayVec;
use photinus_geometry::{Aabb, Ray};
use std::ops::ControlFlow;

/// A piece of the ray with the index bits of the parts that it is known to lie in.
#[derive(Clone, Copy)]
struct Piece {
    bits: usize,
    enter: f32,
    leave: f32,
}

struct Walk<'a, N, L> {
    tree: &'a Octree,
    ray: &'a Ray,
    /// Where the search ends: the end of the ray or the nearest hit.
    end: f32,
    node: N,
    leaf: L,
}

impl Octree {
    /// Calls `node` at every interior node and `leaf` at every leaf with primitives, front to back, until it breaks.
    pub(super) fn walk_cells(
        &self,
        ray: &Ray,
        node: impl FnMut(),
        leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>,
    ) {
        let Some((enter, leave)) = clip(ray, &self.bounds) else { return };
        let mut walk = Walk { tree: self, ray, end: leave, node, leaf };
        // Whether it came to the end or was told to stop is the same here.
        let _ = walk.visit(0, &self.cube, enter, leave);
    }
}

impl<N: FnMut(), L: FnMut(LeafVisit) -> ControlFlow<(), f32>> Walk<'_, N, L> {
    /// Visits a node; no deeper than the tree, which has 24 levels at most.
    fn visit(&mut self, index: usize, cell: &Aabb, enter: f32, leave: f32) -> ControlFlow<()> {
        match self.tree.nodes[index].unpack() {
            Unpacked::Leaf(refs) => {
                if !refs.is_empty() {
                    // Pieces that begin behind the end are left out below, which is as good as an exit.
                    let left = (self.leaf)(LeafVisit { refs, exit: f32::NEG_INFINITY })?;
                    self.end = self.end.min(left);
                }
            }
            Unpacked::Interior(first) => {
                (self.node)();
                let middle = middle(cell);
                let mut pieces = ArrayVec::<Piece, 8>::new();
                pieces.push(Piece { bits: 0, enter, leave });
                for axis in 0..3 {
                    let (plane, d) = (middle[axis] - self.ray.origin[axis], self.ray.dir[axis]);
                    let mut cut = ArrayVec::<Piece, 8>::new();
                    for piece in pieces {
                        let above = 1 << axis;
                        match sides(plane, d, piece.enter, piece.leave) {
                            Sides::Below => cut.push(piece),
                            Sides::Above => cut.push(Piece { bits: piece.bits | above, ..piece }),
                            Sides::Both { above_first, first, last } => {
                                let [near, far] = if above_first { [above, 0] } else { [0, above] };
                                let (leave, enter) = (piece.leave.min(last), piece.enter.max(first));
                                cut.push(Piece { bits: piece.bits | near, leave, ..piece });
                                cut.push(Piece { bits: piece.bits | far, enter, ..piece });
                            }
                        }
                    }
                    pieces = cut;
                }
                for Piece { bits, enter, leave } in pieces {
                    if enter <= leave && enter <= self.end {
                        self.visit(first + bits, &part(cell, bits), enter, leave)?;
                    }
                }
            }
        }
        ControlFlow::Continue(())
    }
}
