//! Acceleration structures over [`Primitives`](photinus_geometry::Primitives): which primitives a ray meets, nearest
//! first.
//!
//! A structure answers batches: slices of rays in, slices of hits out. Every member gives the same closest hit as
//! `brute_force`, ties going to the lowest primitive id.

pub mod bounds;
mod fragment;
mod grid;
mod hierarchy;
pub mod instances;
mod laboratory;
pub mod list;
pub mod options;
mod planes;
mod reach;
mod structure;
pub mod structures {
    //! The members: one acceleration structure a file or folder.

    pub mod bih;
    pub mod binned_bvh;
    pub mod bkd_tree;
    pub mod box_bvh;
    pub mod brute_force;
    pub mod bsp_tree;
    pub mod compact_grid;
    pub mod ellipsoid_bvh;
    pub mod kd_tree;
    pub mod octree;
    pub mod spatial_split_bvh;
    pub mod sphere_bvh;
    pub mod two_level;
    pub mod uniform_grid;
    pub mod wide_bvh;
}

pub use list::{DEFAULT_STRUCTURE, STRUCTURES, StructureInfo, build, find_structure};
pub use options::{BuildError, BuildOptions, Clip, GridCells, Kernel, SplitCandidates};
pub use structure::{LeafRange, RayCounters, RefitError, Structure, StructureSummary};

/// The page's example is compiled as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/structures/instances.md")]
struct InstancesPage;
