//! The walk of a ray: as through a kd-tree, with planes in any direction among the others.

use super::small::MAX_DEPTH as SMALL_DEPTH;
use super::{BspTree, Plane, Unpacked};
use crate::laboratory::LeafVisit;
use crate::planes::{SLACK, Sides, clip, sides};
use crate::structures::kd_tree::build::MAX_DEPTH as LARGE_DEPTH;
use photinus_geometry::Ray;
use std::ops::ControlFlow;

/// A subtree that waits, with the parameters at which the ray enters and leaves its cell.
#[derive(Clone, Copy)]
struct Waiting {
    node: usize,
    enter: f32,
    leave: f32,
}

impl Plane {
    /// The sides that a ray meets from `enter` to `leave`. As with planes across the axes what is within rounding of the
    /// plane counts as on both sides: each coordinate, taken from the ray's origin, may be off by [`SLACK`] of itself.
    #[inline(always)]
    fn sides(&self, ray: &Ray, enter: f32, leave: f32) -> Sides {
        let (mut height, mut slope, mut slack) = (-self.offset, 0.0, 0.0);
        for k in 0..3 {
            let (n, d) = (f64::from(self.normal[k]), f64::from(ray.dir[k]));
            height += n * f64::from(ray.origin[k]);
            slope += n * d;
            slack += (n * d).abs();
        }
        slack *= f64::from(SLACK);
        // What is not a number is on both sides.
        let (a, b) = (f64::from(enter), f64::from(leave));
        let (a_height, b_height) = (height + slope * a, height + slope * b);
        let (a_slack, b_slack) = (slack * a.abs(), slack * b.abs());
        let reaches_below = !(a_height > a_slack && b_height > b_slack);
        let reaches_above = !(a_height < -a_slack && b_height < -b_slack);
        if !reaches_above {
            Sides::Below
        } else if !reaches_below {
            Sides::Above
        } else if slope.abs() <= 2.0 * slack {
            // Along the plane, as far as can be told, both sides last as long as the cell.
            Sides::Both { above_first: height > 0.0, first: enter, last: leave }
        } else {
            let (t, u) = ((-height / (slope + slack)) as f32, (-height / (slope - slack)) as f32);
            Sides::Both { above_first: slope < 0.0, first: t.min(u), last: t.max(u) }
        }
    }
}

impl BspTree {
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
        let mut end = leave;
        let mut stack = [Waiting { node: 0, enter, leave }; (LARGE_DEPTH + SMALL_DEPTH) as usize];
        let mut depth = 0;
        let mut current = 0;
        loop {
            let (met, above) = match self.nodes[current].unpack() {
                Unpacked::Across { axis, position, above } => {
                    (Some(sides(position - origin[axis], dir[axis], enter, leave)), above)
                }
                Unpacked::Oblique { plane, above } => (Some(self.planes[plane].sides(ray, enter, leave)), above),
                Unpacked::Leaf(refs) => {
                    if !refs.is_empty() {
                        let exit = f32::NEG_INFINITY;
                        let ControlFlow::Continue(left) = leaf(LeafVisit { refs, exit }) else { return };
                        end = end.min(left);
                    }
                    (None, 0)
                }
            };
            if met.is_some() {
                node();
            }
            match met {
                Some(Sides::Below) => current += 1,
                Some(Sides::Above) => current = above,
                Some(Sides::Both { above_first, first, last }) => {
                    let (near, far) = if above_first { (above, current + 1) } else { (current + 1, above) };
                    stack[depth] = Waiting { node: far, enter: enter.max(first), leave };
                    depth += 1;
                    leave = leave.min(last);
                    current = near;
                }
                // The next subtree that begins before the nearest hit.
                None => loop {
                    if depth == 0 {
                        return;
                    }
                    depth -= 1;
                    Waiting { node: current, enter, leave } = stack[depth];
                    if enter <= end {
                        break;
                    }
                },
            }
        }
    }
}
