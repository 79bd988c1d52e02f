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

/// Bytes of a photon in a finished map: itself and its place there.
const PHOTON_BYTES: u64 = 28;

/// Buffers of the film while a picture is written, in quarters: the means, their layers and the encoded file, beside the
/// one kept for the next pass.
const WRITE_QUARTERS: u64 = 15;

impl RenderMemory {
    /// For `values` numbers on the film, `passes` passes and `stored` photons a pass: the largest of the three moments
    /// that can be the peak.
    pub(crate) fn predict(values: u64, passes: u32, stored: u64, lights: u64) -> Self {
        let buffer = values * 4;
        let sums = Film::levels(passes) * buffer;
        // One buffer is kept for the next pass throughout; the tiles of a pass are another one.
        let map_build = Self { film: sums + buffer, photons: stored * PHOTON_BUILD_BYTES, lights };
        let eye_pass = Self { film: sums + 2 * buffer, photons: stored * PHOTON_BYTES, lights };
        let writing = Self { film: sums + buffer * WRITE_QUARTERS / 4, photons: 0, lights };
        [map_build, eye_pass, writing].into_iter().max_by_key(Self::total).unwrap_or_default()
    }

    /// All owners together.
    pub fn total(&self) -> u64 {
        self.film + self.photons + self.lights
    }
}
