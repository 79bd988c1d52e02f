//! What this crate refuses.

use crate::{KERNELS, SEARCHES, SUPPORTS};
use photinus_geometry::Vec3;

/// Why a photon was refused, or a search not built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PhotonError {
    /// The position has a component that is NaN or beyond 1e18.
    #[error("photon position {0} is not within 1e18 of the origin")]
    Position(Vec3),
    /// The flux has a channel that is NaN, negative or above the largest that can be stored.
    #[error("photon flux {0} W is not in 0..1.6e15 in every channel")]
    Flux(Vec3),
    /// The direction is zero, NaN or infinite.
    #[error("photon direction {0} is no direction")]
    Direction(Vec3),
    /// The normal is zero, NaN or infinite.
    #[error("photon normal {0} is no direction")]
    Normal(Vec3),
    /// No search has this name.
    #[error("no photon search is called '{0}'; there are: {names}", names = names(SEARCHES.iter().map(|m| m.name)))]
    UnknownSearch(String),
    /// No support of estimates has this name.
    #[error("no support of estimates is called '{0}'; there are: {names}", names = names(SUPPORTS.iter().map(|s| s.name)))]
    UnknownSupport(String),
    /// No kernel has this name.
    #[error("no kernel is called '{0}'; there are: {names}", names = names(KERNELS.iter().map(|k| k.name)))]
    UnknownKernel(String),
    /// A record of irradiance has a number that is not finite, or a radius that is not above 0.
    #[error("the irradiance record at {0} has numbers that are not finite, or no radius")]
    Record(Vec3),
    /// More photons than a search can number.
    #[error("{0} photons are more than a search holds (2^30); store fewer a pass")]
    TooManyPhotons(usize),
}

fn names(names: impl Iterator<Item = &'static str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}
