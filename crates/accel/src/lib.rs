//! Acceleration structures over [`Primitives`](photinus_geometry::Primitives): which primitives a ray meets, nearest
//! first.
//!
//! A structure answers batches: slices of rays in, slices of hits out. Every member gives the same closest hit as
//! `brute_force`, ties going to the lowest primitive id.

mod structure;

pub use structure::{RayCounters, Structure, StructureSummary};
