//! The walk of a ray through the cells that it pierces, front to back: Havran's recursive algorithm T_A,rec,B
//! ("Heuristic Ray Shooting Algorithms", 2000), with its recursion on a stack.
//!
//! As there, the side of a plane that the ray visits follows from the coordinates of the points where it enters and
//! leaves the cell, not from comparing parameters: the plane, both points and the four cases. Coordinates are taken
//! from the ray's origin, where they are exact to a relative rounding, and those within rounding of the plane count as
//! on both sides, so that no hit is lost (see [`crate::bounds`]).

use super::build::MAX_DEPTH;
use super::{KdTree, Unpacked};
use crate::bounds::SLAB_SLACK;
use crate::laboratory::{LeafVisit, can_hit};
use photinus_geometry::Ray;
use std::ops::ControlFlow;

/// Relative width of the zone around a plane that counts as on both sides: twice what a hit needs.
const SLACK: f32 = 2.0 * SLAB_SLACK;

/// A subtree that waits, with the parameters at which the ray enters and leaves its cell.
#[derive(Clone, Copy)]
struct Waiting {
    node: usize,
    enter: f32,
    leave: f32,
}

impl KdTree {
    /// The parameters at which the ray enters and leaves the tree's bounds, widened by rounding and cut to the ray's
    /// interval; `None` where it misses them or can hit nothing.
    fn clip(&self, ray: &Ray) -> Option<(f32, f32)> {
        if !can_hit(ray) || self.bounds.is_empty() {
            return None;
        }
        let (mut enter, mut leave) = (ray.t_min, ray.t_max);
        for axis in 0..3 {
            let d = ray.dir[axis];
            let (low, high) = (self.bounds.min[axis] - ray.origin[axis], self.bounds.max[axis] - ray.origin[axis]);
            if d == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = if d > 0.0 { (low / d, high / d) } else { (high / d, low / d) };
            enter = enter.max(a - SLACK * a.abs());
            leave = leave.min(b + SLACK * b.abs());
        }
        (enter <= leave).then_some((enter, leave))
    }

    /// Calls `node` at every interior node and `leaf` at every leaf with primitives, front to back, until it breaks.
    #[inline(always)]
    pub(super) fn walk_cells(
        &self,
        ray: &Ray,
        mut node: impl FnMut(),
        mut leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>,
    ) {
        let Some((mut enter, mut leave)) = self.clip(ray) else { return };
        let (origin, dir) = (ray.origin.to_array(), ray.dir.to_array());
        let mut stack = [Waiting { node: 0, enter, leave }; MAX_DEPTH as usize];
        let mut depth = 0;
        let mut current = 0;
        loop {
            match self.nodes[current].unpack() {
                Unpacked::Interior { axis, position, above } => {
                    node();
                    let below = current + 1;
                    let d = dir[axis];
                    let plane = position - origin[axis];
                    let (a, b) = (d * enter, d * leave);
                    let (a_slack, b_slack) = (SLACK * a.abs(), SLACK * b.abs());
                    let reaches_below = a <= plane + a_slack || b <= plane + b_slack;
                    let reaches_above = a >= plane - a_slack || b >= plane - b_slack;
                    if !reaches_above {
                        current = below;
                    } else if !reaches_below {
                        current = above;
                    } else {
                        let backward = d < 0.0 || (d == 0.0 && plane < 0.0);
                        let (near, far) = if backward { (above, below) } else { (below, above) };
                        // Along the plane there is no crossing, and both sides last as long as the cell.
                        let t = plane / d;
                        let (first, last) =
                            if d == 0.0 { (enter, leave) } else { (t - SLACK * t.abs(), t + SLACK * t.abs()) };
                        stack[depth] = Waiting { node: far, enter: enter.max(first), leave };
                        depth += 1;
                        leave = leave.min(last);
                        current = near;
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
