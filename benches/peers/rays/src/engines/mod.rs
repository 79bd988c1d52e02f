//! Who is measured: ours and others', each behind the same two questions.

mod embree;
mod obvhs;
mod photinus;

use crate::Arguments;
use crate::meshes::Mesh;
use crate::sets::Set;
use photinus_geometry::{Hit, Ray};

/// An engine with its structure over a mesh.
pub trait Engine: Sync {
    /// The nearest hits.
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]);

    /// Whether anything is hit; false where the engine knows no such question.
    fn any(&self, rays: &[Ray], occluded: &mut [bool]) -> bool;

    /// What rays meet on the way, in words, where the engine counts it.
    fn work(&self, _set: &Set) -> Option<String> {
        None
    }
}

/// Builds an engine's structure.
type Build = fn(&Mesh, &Arguments) -> Result<Box<dyn Engine>, String>;

/// All engines: names and builds. A name ends with what is special about the mode.
pub const ENGINES: &[(&str, Build)] = &[
    ("photinus", photinus::build),
    ("photinus-quick", photinus::build_quickly),
    ("embree-robust", embree::robust),
    ("embree-fast", embree::fast),
    ("embree-robust-16", embree::robust_packets),
    ("embree-fast-16", embree::fast_packets),
    ("obvhs", obvhs::build),
];
