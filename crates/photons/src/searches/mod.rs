//! The members: one file each.

pub(crate) mod block_hash;
pub(crate) mod brute_blocked;
pub(crate) mod brute_force;
pub(crate) mod bvh;
pub(crate) mod grid;
pub(crate) mod hashed_grid;
pub(crate) mod kd_balanced;
pub(crate) mod kd_unbalanced;
pub(crate) mod kd_vvh;
pub(crate) mod octree;
pub(crate) mod r_tree;
