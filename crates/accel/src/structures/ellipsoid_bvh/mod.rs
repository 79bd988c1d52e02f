//! The thesis's bounding volume hierarchy (section 3.1.2): space divided into octrees, the triangle parts of each voxel
//! bounded by the smallest axis-aligned ellipsoid.
//!
//! Against the thesis, rays visit the nearest volumes first and leave out those beyond the nearest hit.

mod ellipsoid;

use crate::hierarchy::octree_bvh;
use crate::options::{BuildError, BuildOptions};
use crate::structure::Structure;
use ellipsoid::Ellipsoid;
use photinus_geometry::Primitives;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "ellipsoid-bvh";
/// One line for the help.
pub const SUMMARY: &str = "axis-aligned ellipsoids over an octree's voxels, as in the thesis";
/// Where it was published.
pub const SOURCE: &str = "the thesis, sections 3.1.2 and 3.3.2";

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    octree_bvh::build::<Ellipsoid>(NAME, &primitives, options)
}
