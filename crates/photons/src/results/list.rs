//! All photons of a region.

use super::ResultSet;
use crate::{Neighbor, Photon};

/// Collects ids and squared distances.
#[derive(Clone, Debug, Default)]
pub struct List {
    found: Vec<Neighbor>,
}

impl List {
    /// What was found, by ascending id.
    pub fn into_found(mut self) -> Vec<Neighbor> {
        self.found.sort_unstable_by_key(|n| n.photon);
        self.found
    }
}

impl ResultSet for List {
    fn limit(&self) -> f32 {
        f32::INFINITY
    }

    fn add(&mut self, photon: u32, _: &Photon, distance_sq: f32) {
        self.found.push(Neighbor { distance_sq, photon });
    }
}
