//! Who is measured: ours and others', each behind the same questions.

mod kiddo;
mod nanoflann;
mod photinus;
mod python;

use crate::Arguments;
use crate::sets::{Question, Set};
use photinus_geometry::Vec3;
use photinus_photons::{GatherQuery, Photon};

pub use photinus::build_blocked;

/// Photons for all engines, as each of them wants them.
pub struct Cloud<'d> {
    /// As they are stored.
    pub photons: &'d [Photon],
    /// Their places.
    pub positions: Vec<[f32; 3]>,
    /// What else they carry.
    pub loads: Vec<Load>,
    /// The radius of most searches, scene units.
    pub radius: f32,
}

impl<'d> Cloud<'d> {
    /// Unpacks photons.
    pub fn new(photons: &'d [Photon], radius: f32) -> Self {
        let load = |photon: &Photon| Load { flux: photon.flux().to_array(), normal: photon.normal().to_array() };
        Self {
            photons,
            positions: photons.iter().map(|photon| photon.position().to_array()).collect(),
            loads: photons.iter().map(load).collect(),
            radius,
        }
    }
}

/// What a photon carries beside its place.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Load {
    /// W.
    pub flux: [f32; 3],
    /// Of its surface, unit.
    pub normal: [f32; 3],
}

impl Load {
    /// Whether its surface is turned at most 60 degrees from the query's.
    fn faces(&self, query: &GatherQuery) -> bool {
        Vec3::from(self.normal).dot(query.normal) >= 0.5
    }
}

/// What is said of a query.
#[derive(Clone, Copy, Debug, Default)]
pub struct Answer {
    /// Photons found.
    pub count: u32,
    /// Their flux; none where it is not summed.
    pub flux: Option<[f32; 3]>,
    /// Squared distance of the farthest; of no meaning in sums within a radius.
    pub farthest_sq: f32,
}

/// Which photons an engine finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Those whose normals are within 60 degrees of the query's.
    Facing,
    /// All.
    All,
}

/// An engine.
pub trait Engine: Send {
    /// Builds its structure on so many threads, the current rayon pool's; the one before is forgotten. Returns the seconds.
    fn build(&mut self, cloud: &Cloud, threads: usize) -> Result<f64, String>;

    /// Whether it builds on several threads.
    fn builds_in_parallel(&self) -> bool;

    /// After the last build: what makes searches faster and is no part of a build.
    fn settle(&mut self) -> Result<(), String> {
        Ok(())
    }

    /// Whether there is a row for such sets; a peer has one for what it cannot do, too.
    fn is_for(&self, _: Question) -> bool {
        true
    }

    /// Asks on so many threads. Returns the seconds and the answers; an error where it does not know the question.
    fn ask(&mut self, set: &Set, threads: usize) -> Result<(f64, Vec<Answer>), String>;

    /// Which photons it finds.
    fn reach(&self, set: &Set) -> Reach;

    /// What it does, in a few words.
    fn about(&self, set: &Set) -> &'static str;

    /// What searches meet on the way, in words, where the engine counts it.
    fn work(&self, _: &Set) -> Option<String> {
        None
    }
}

/// Makes an engine.
type Open = fn(&Arguments) -> Result<Box<dyn Engine>, String>;

/// All engines, ours first: the others are checked against it.
pub const ENGINES: &[(&str, Open)] = &[
    ("photinus", photinus::open),
    ("photinus-list", photinus::open_list),
    ("nanoflann", nanoflann::open),
    ("kiddo", kiddo::open),
    ("ckdtree", python::open_ckdtree),
    ("pykdtree", python::open_pykdtree),
];
