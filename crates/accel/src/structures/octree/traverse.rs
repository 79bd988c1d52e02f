//! The walk of a ray: at every node it is clipped by the three planes through the middle, one after the other, nearest
//! side first, so that it meets the parts in its own order. Sides that come later wait on a stack.

use super::build::middle_of;
use super::{MAX_DEPTH, Octree, Unpacked};
use crate::laboratory::LeafVisit;
use crate::planes::{Sides, clip, sides};
use arrayvec::ArrayVec;
use photinus_geometry::Ray;
use std::ops::ControlFlow;

/// A piece of the ray within the parts of a node that are left after the planes across the first few axes.
#[derive(Clone, Copy)]
struct Piece {
    /// Index of the node's first part.
    first: usize,
    /// Bits of the parts' index that are known.
    bits: usize,
    /// The axis whose plane comes next; 3 where one part is left.
    axis: usize,
    /// The cell of the parts.
    min: [f32; 3],
    max: [f32; 3],
    /// Where the ray enters and leaves it.
    enter: f32,
    leave: f32,
}

impl Octree {
    /// Calls `node` at every interior node and `leaf` at every leaf with primitives, front to back, until it breaks.
    #[inline(always)]
    pub(super) fn walk_cells(
        &self,
        ray: &Ray,
        mut node: impl FnMut(),
        mut leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>,
    ) {
        let Some((enter, leave)) = clip(ray, &self.bounds) else { return };
        let (origin, dir) = (ray.origin.to_array(), ray.dir.to_array());
        let mut end = leave;
        let (min, max) = (self.cube.min.to_array(), self.cube.max.to_array());
        // The root counts as the first of parts.
        let mut piece = Piece { first: 0, bits: 0, axis: 3, min, max, enter, leave };
        let mut waiting = ArrayVec::<Piece, { 3 * MAX_DEPTH as usize }>::new();
        loop {
            while piece.axis < 3 {
                let axis = piece.axis;
                let middle = middle_of(piece.min[axis], piece.max[axis]);
                let mut part = Piece { axis: axis + 1, ..piece };
                let above = match sides(middle - origin[axis], dir[axis], piece.enter, piece.leave) {
                    Sides::Below => false,
                    Sides::Above => true,
                    Sides::Both { above_first, first, last } => {
                        let mut far = Piece { enter: piece.enter.max(first), ..part };
                        far.take(axis, middle, !above_first);
                        waiting.push(far);
                        part.leave = piece.leave.min(last);
                        above_first
                    }
                };
                part.take(axis, middle, above);
                piece = part;
            }
            match self.nodes[piece.first + piece.bits].unpack() {
                Unpacked::Interior(first) => {
                    node();
                    piece = Piece { first, bits: 0, axis: 0, ..piece };
                    continue;
                }
                Unpacked::Leaf(refs) if refs.is_empty() => {}
                Unpacked::Leaf(refs) => {
                    // Pieces that begin behind the end are left out below, which is as good as an exit.
                    let ControlFlow::Continue(left) = leaf(LeafVisit { refs, exit: f32::NEG_INFINITY }) else { return };
                    end = end.min(left);
                }
            }
            piece = loop {
                let Some(next) = waiting.pop() else { return };
                if next.enter <= end && next.enter <= next.leave {
                    break next;
                }
            };
        }
    }
}

impl Piece {
    /// Leaves the parts on one side of the middle.
    #[inline(always)]
    fn take(&mut self, axis: usize, middle: f32, above: bool) {
        if above {
            self.min[axis] = middle;
            self.bits |= 1 << axis;
        } else {
            self.max[axis] = middle;
        }
    }
}
