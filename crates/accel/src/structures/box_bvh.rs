//! The thesis's bounding volume hierarchy with boxes in place of ellipsoids: as large to store, quicker to test and
//! mostly tighter.

use crate::hierarchy::clip::Cell;
use crate::hierarchy::octree_bvh;
use crate::hierarchy::volume::{Fit, PaddedPoint};
use crate::options::{BuildError, BuildOptions};
use crate::structure::Structure;
use photinus_geometry::{Aabb, Primitives};
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "box-bvh";
/// One line for the help.
pub const SUMMARY: &str = "boxes over an octree's voxels";
/// Where it was published.
pub const SOURCE: &str = "the thesis, section 3.1.2, with another volume";

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    octree_bvh::build::<Aabb>(NAME, &primitives, options)
}

impl Fit for Aabb {
    fn fit(points: &[PaddedPoint]) -> Self {
        let mut cell = Cell { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        for p in points {
            for k in 0..3 {
                cell.low[k] = cell.low[k].min(p.at[k] - p.pad);
                cell.high[k] = cell.high[k].max(p.at[k] + p.pad);
            }
        }
        cell.outward()
    }
}
