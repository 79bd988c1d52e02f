//! How many photons a region holds.

use super::ResultSet;
use crate::Photon;

/// Counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count(pub u64);

impl ResultSet for Count {
    fn limit(&self) -> f32 {
        f32::INFINITY
    }

    fn add(&mut self, _: u32, _: &Photon, _: f32) {
        self.0 += 1;
    }
}
