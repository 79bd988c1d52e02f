//! The list of searches: what the command line, the documentation and the tests loop over.

use crate::searches::{brute_force, grid, kd_balanced};
use crate::{Photon, PhotonError, Search};

/// What building a search may be told.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildOptions {
    /// The radius that most queries will have, scene units; 0, or anything that is not positive and finite: chosen
    /// from the photons' density. It steers speed and memory, never what is found.
    pub radius_hint: f32,
}

impl BuildOptions {
    /// The hint where it is of use.
    pub(crate) fn radius(&self) -> Option<f32> {
        Some(self.radius_hint).filter(|r| *r > 0.0 && r.is_finite())
    }
}

/// A member of the family.
#[derive(Clone, Copy, Debug)]
pub struct SearchMember {
    /// Command-line name.
    pub name: &'static str,
    /// One sentence for help and documentation.
    pub about: &'static str,
    builder: fn(Vec<Photon>, &BuildOptions) -> Box<dyn Search>,
}

/// All photon searches, the default first.
pub const SEARCHES: &[SearchMember] = &[
    SearchMember { name: "grid", about: grid::ABOUT, builder: |p, o| Box::new(grid::Grid::new(p, o)) },
    SearchMember {
        name: "kd-balanced",
        about: kd_balanced::ABOUT,
        builder: |p, _| Box::new(kd_balanced::KdBalanced::new(&p)),
    },
    SearchMember {
        name: "brute-force",
        about: brute_force::ABOUT,
        builder: |p, _| Box::new(brute_force::BruteForce::new(p)),
    },
];

/// The search that is used where none is named.
pub const DEFAULT_SEARCH: &str = "grid";

/// Most photons in one search.
const MAX_PHOTONS: usize = 1 << 30;

impl SearchMember {
    /// Builds this search over `photons`; ids are indices into them. Deterministic on any number of threads.
    ///
    /// # Errors
    /// More than 2^30 photons.
    pub fn build(&self, photons: Vec<Photon>, options: &BuildOptions) -> Result<Box<dyn Search>, PhotonError> {
        if photons.len() > MAX_PHOTONS {
            return Err(PhotonError::TooManyPhotons(photons.len()));
        }
        Ok((self.builder)(photons, options))
    }
}

/// The member of a command-line name; underscores count as hyphens.
///
/// # Errors
/// No such member.
pub fn find_search(name: &str) -> Result<&'static SearchMember, PhotonError> {
    let wanted = name.replace('_', "-");
    SEARCHES.iter().find(|m| m.name == wanted).ok_or_else(|| PhotonError::UnknownSearch(name.to_owned()))
}

/// Builds the search called `name` over `photons`.
///
/// # Errors
/// No such member, or more than 2^30 photons.
pub fn build(name: &str, photons: Vec<Photon>, options: &BuildOptions) -> Result<Box<dyn Search>, PhotonError> {
    find_search(name)?.build(photons, options)
}

/// The balanced kd-tree: the search for distances to neighbours where no radius is known yet.
///
/// # Errors
/// More than 2^30 photons.
pub fn kd_balanced(photons: Vec<Photon>) -> Result<Box<dyn Search>, PhotonError> {
    build("kd-balanced", photons, &BuildOptions::default())
}
