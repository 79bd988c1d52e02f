//! The first photons met, whichever they are: what a memory with so many outputs hands out.

use super::ResultSet;
use crate::{Neighbor, Photon};

/// Keeps the first `k` photons that are added and then ends the search. Which they are depends on the structure.
#[derive(Clone, Debug)]
pub struct First {
    k: usize,
    found: Vec<Neighbor>,
}

impl First {
    /// Without photons.
    pub fn new(k: usize) -> Self {
        Self { k, found: Vec::new() }
    }

    /// What was found, in the order in which it was met.
    pub fn into_found(self) -> Vec<Neighbor> {
        self.found
    }
}

impl ResultSet for First {
    fn limit(&self) -> f32 {
        if self.found.len() < self.k { f32::INFINITY } else { -1.0 }
    }

    fn add(&mut self, photon: u32, _: &Photon, distance_sq: f32) {
        if self.found.len() < self.k {
            self.found.push(Neighbor { distance_sq, photon });
        }
    }
}
