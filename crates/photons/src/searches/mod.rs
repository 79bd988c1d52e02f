//! The members: one file each.

pub(crate) mod brute_force;
pub(crate) mod grid;
pub(crate) mod kd_balanced;
