//! What the structures that divide the objects share: heuristics apart from recursions, trees apart from volumes.

pub(crate) mod binned;
pub(crate) mod clip;
pub(crate) mod interval_tree;
pub(crate) mod object_build;
pub(crate) mod octree;
pub(crate) mod octree_bvh;
pub(crate) mod refs;
pub(crate) mod round;
pub(crate) mod rule;
pub(crate) mod shape;
pub(crate) mod slabs;
pub(crate) mod volume;
pub(crate) mod volume_tree;

#[cfg(test)]
mod tests;
