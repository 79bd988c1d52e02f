//! The list of searches: what the command line, the documentation and the tests loop over.

use crate::searches::block_hash::{self, BlockHash};
use crate::searches::{
    brute_blocked, brute_force, bvh, grid, hashed_grid, kd_balanced, kd_unbalanced, kd_vvh, octree, r_tree,
};
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
    /// Whether it finds all that it is asked for.
    pub is_exact: bool,
    builder: Builder,
}

/// Makes a search.
type Builder = fn(Vec<Photon>, &BuildOptions) -> Box<dyn Search>;

/// All photon searches, the default first.
pub const SEARCHES: &[SearchMember] = &[
    exact("grid", grid::ABOUT, |p, o| Box::new(grid::Grid::new(p, o))),
    exact("kd-balanced", kd_balanced::ABOUT, |p, _| Box::new(kd_balanced::KdBalanced::new(&p))),
    exact("kd-unbalanced", kd_unbalanced::ABOUT, |p, _| Box::new(kd_unbalanced::KdUnbalanced::build(&p))),
    exact("kd-vvh", kd_vvh::ABOUT, |p, o| Box::new(kd_vvh::KdVvh::build(&p, o.radius()))),
    exact("hashed-grid", hashed_grid::ABOUT, |p, o| Box::new(hashed_grid::HashedGrid::build(&p, o.radius()))),
    exact("block-hash", block_hash::ABOUT, |p, o| Box::new(BlockHash::<true>::build(&p, o.radius()))),
    SearchMember {
        name: "block-hash-approximate",
        about: block_hash::ABOUT_APPROXIMATE,
        is_exact: false,
        builder: |p, o| Box::new(BlockHash::<false>::build(&p, o.radius())),
    },
    exact("r-tree", r_tree::ABOUT, |p, _| Box::new(r_tree::RTree::build(&p))),
    exact("bvh", bvh::ABOUT, |p, _| Box::new(bvh::Bvh::build(&p))),
    exact("octree", octree::ABOUT, |p, _| Box::new(octree::Octree::build(&p))),
    exact("brute-force-blocked", brute_blocked::ABOUT, |p, _| Box::new(brute_blocked::BruteBlocked::build(&p))),
    exact("brute-force", brute_force::ABOUT, |p, _| Box::new(brute_force::BruteForce::new(p))),
];

/// A member that finds all that it is asked for.
const fn exact(name: &'static str, about: &'static str, builder: Builder) -> SearchMember {
    SearchMember { name, about, is_exact: true, builder }
}

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
