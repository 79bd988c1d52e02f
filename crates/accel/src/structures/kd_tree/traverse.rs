//! The walk of a ray through the cells that it pierces, front to back: Havran's recursive algorithm T_A,rec,B
//! ("Heuristic Ray Shooting Algorithms", 2000), with its recursion on a stack.
//!
//! As there, the side of a plane that the ray visits follows from the coordinates of the points where it enters and
//! leaves the cell, not from comparing parameters: the plane, both points and the four cases. Coordinates are taken
//! from the ray's origin, where they are exact to a relative rounding, and those within rounding of the plane count as
//! on both sides, so that no hit is lost (see [`crate::planes`]).

use super::build::MAX_DEPTH;
use super::{KdTree, Unpacked};
use crate::laboratory::LeafVisit;
use crate::planes::{SLACK, Sides, clip, sides};
use photinus_geometry::Ray;
use std::ops::ControlFlow;

/// A subtree that waits, with the parameters at which the ray enters and leaves its cell.
#[derive(Clone, Copy)]
struct Waiting {
    node: usize,
    enter: f32,
    leave: f32,
}

impl KdTree {
    /// Calls `node` at every interior node and `leaf` at every leaf with primitives, front to back, until it breaks.
    #[inline(always)]
    pub(super) fn walk_cells(
        &self,
        ray: &Ray,
        mut node: impl FnMut(),
        mut leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>,
    ) {
        let Some((mut enter, mut leave)) = clip(ray, &self.bounds) else { return };
        let (origin, dir) = (ray.origin.to_array(), ray.dir.to_array());
        let mut stack = [Waiting { node: 0, enter, leave }; MAX_DEPTH as usize];
        let mut depth = 0;
        let mut current = 0;
        loop {
            match self.nodes[current].unpack() {
                Unpacked::Interior { axis, position, above } => {
                    node();
                    let below = current + 1;
                    match sides(position - origin[axis], dir[axis], enter, leave) {
                        Sides::Below => current = below,
                        Sides::Above => current = above,
                        Sides::Both { above_first, first, last } => {
                            let (near, far) = if above_first { (above, below) } else { (below, above) };
                            stack[depth] = Waiting { node: far, enter: enter.max(first), leave };
                            depth += 1;
                            leave = leave.min(last);
                            current = near;
                        }
                    }
                    continue;
                }
                Unpacked::Leaf { refs } => {
                    let exit = leave - 4.0 * SLACK * leave.abs();
                    if !refs.is_empty() && leaf(LeafVisit { refs, exit }).is_break() {
                        return;
                    }
                }
            }
            if depth == 0 {
                return;
            }
            depth -= 1;
            Waiting { node: current, enter, leave } = stack[depth];
        }
    }
}
