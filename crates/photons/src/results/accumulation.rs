//! Flux summed on the way, without a list.

use super::ResultSet;
use crate::inclusion::PreparedQuery;
use crate::visiting::Sums;
use crate::{GatherQuery, Gathered, Kernel, Photon};

/// Sums the flux of photons whose normals and depths fit a query, each times the kernel's weight at its distance in a
/// search of the query's radius; in f64, rounded once.
pub struct Accumulation {
    prepared: PreparedQuery,
    sums: Sums,
}

impl Accumulation {
    /// Nothing summed yet.
    pub fn new(query: &GatherQuery, kernel: Kernel) -> Self {
        Self { prepared: PreparedQuery::new(query, kernel), sums: Sums::default() }
    }

    /// The sums.
    pub fn gathered(&self) -> Gathered {
        self.sums.gathered()
    }
}

impl ResultSet for Accumulation {
    fn limit(&self) -> f32 {
        self.prepared.r2
    }

    fn add(&mut self, _: u32, photon: &Photon, distance_sq: f32) {
        if distance_sq <= self.prepared.r2 && self.prepared.accepts(photon.surface_word()) {
            self.sums.add(photon, self.prepared.kernel.weight(distance_sq));
        }
    }
}
