//! Photon storage and search. This crate knows no rays: photons come in as data, and questions about them as points,
//! radii and counts.
//!
//! [`build`] makes a search by its command-line name; [`SEARCHES`] lists them. [`SUPPORTS`] lists where the photons of an
//! estimate may lie, [`KERNELS`] how they are weighted.

// The shared test inputs name this crate as the tests outside of it do.
#[cfg(test)]
extern crate self as photinus_photons;

mod error;
mod flux;
mod inclusion;
mod index;
pub mod irradiance;
mod kernel;
mod list;
mod nearest;
mod octahedral;
mod photon;
mod region;
pub mod results;
mod search;
mod searches;
mod space;
mod store;
mod supported;
mod supports;
mod visiting;

pub use error::PhotonError;
pub use kernel::{KERNELS, Kernel, KernelMember, find_kernel};
pub use list::{BuildOptions, DEFAULT_SEARCH, SEARCHES, SearchMember, build, find_search, kd_balanced};
pub use photon::Photon;
pub use region::Region;
pub use search::{GatherQuery, Gathered, GatheredNearest, Neighbor, Search, SearchSummary};
pub use supports::{DEFAULT_SUPPORT, SUPPORTS, Support, find_support};
