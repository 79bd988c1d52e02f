//! Photon storage and search. This crate knows no rays: photons come in as data, and questions about them as points,
//! radii and counts.

mod photon;
mod search;

pub use photon::Photon;
pub use search::{GatherQuery, Gathered, Kernel, Neighbor, Search, SearchSummary};
