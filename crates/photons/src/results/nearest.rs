//! The photons of a region that are nearest to its middle.

use super::ResultSet;
use crate::nearest::{limit, offer, sort_by_distance};
use crate::{Neighbor, Photon};

/// Keeps the `k` nearest, ties by id.
#[derive(Clone, Debug)]
pub struct Nearest {
    k: usize,
    heap: Vec<Neighbor>,
}

impl Nearest {
    /// Without photons.
    pub fn new(k: usize) -> Self {
        Self { k, heap: Vec::new() }
    }

    /// What was found, by distance, ties by id.
    pub fn into_found(mut self) -> Vec<Neighbor> {
        sort_by_distance(&mut self.heap);
        self.heap
    }
}

impl ResultSet for Nearest {
    fn limit(&self) -> f32 {
        limit(&self.heap, self.k, f32::INFINITY)
    }

    fn add(&mut self, photon: u32, _: &Photon, distance_sq: f32) {
        offer(&mut self.heap, self.k, f32::INFINITY, Neighbor { distance_sq, photon });
    }
}
