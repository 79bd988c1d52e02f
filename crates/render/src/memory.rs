//! What a render will hold, before it starts.

use crate::film::Film;
use serde::Serialize;

/// Bytes by owner at the peak of a render, the world's own left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RenderMemory {
    /// Sums over passes, the pass in flight, and the copy that is written out.
    pub film: u64,
    /// Stored photons and the structure that is built over them.
    pub photons: u64,
    /// Tables that choose lights.
    pub lights: u64,
}

/// Bytes of a photon while its map is built: itself in its chunk, in order of emission, and in the map with its place
/// there. Measured at 69 to 93 with one and two maps of 0.1 to 4 million photons: lists have room to grow.
const PHOTON_BUILD_BYTES: u64 = 80;

impl RenderMemory {
    /// For `values` numbers on the film, `passes` passes and `stored` photons a pass.
    pub(crate) fn predict(values: u64, passes: u32, stored: u64, lights: u64) -> Self {
        // The tiles of a pass and the picture that is written out are one buffer each.
        let film = Film::predicted_bytes(values as usize, passes) as u64 + values * 4 * 2;
        Self { film, photons: stored * PHOTON_BUILD_BYTES, lights }
    }

    /// All owners together.
    pub fn total(&self) -> u64 {
        self.film + self.photons + self.lights
    }
}
