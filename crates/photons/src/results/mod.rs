//! What is done with the photons that a search finds: one interface for all questions, so that a structure only says
//! where photons lie.

mod accumulation;
mod count;
mod first;
mod list;
mod nearest;

pub use accumulation::Accumulation;
pub use count::Count;
pub use first::First;
pub use list::List;
pub use nearest::Nearest;

use crate::Photon;

/// A set of results that photons of a region are added to, in any order.
pub trait ResultSet {
    /// The squared distance from the region's middle, scene units squared, up to which photons are still of use: a
    /// search may leave out what lies farther. Never grows while photons are added; negative where no more is wanted.
    fn limit(&self) -> f32;

    /// Takes up a photon of the region, its id and its squared distance from the middle; those beyond the limit change
    /// nothing.
    fn add(&mut self, id: u32, photon: &Photon, distance_sq: f32);
}
