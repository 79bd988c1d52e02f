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
    /// Estimates of many tiles that are made together.
    pub estimates: u64,
}

/// Bytes of a photon while its map is built: itself in order of emission, what it is sorted by, and in the map with its
/// place there. Measured at 63 to 68 with 1 to 3 million photons; lists of fewer, and those of single batches, lie where the
/// pilot's were, which the program holds already.
const PHOTON_BUILD_BYTES: u64 = 66;

/// Bytes of a photon in a list.
const PHOTON_LIST_BYTES: u64 = 24;

/// Bytes of a photon in a finished map: itself and its place there.
const PHOTON_BYTES: u64 = 28;

/// Bytes of an estimate of a wave: its place, its turn and its use in lists with room for those of fuller tiles, those of
/// one of the next wave, what it is sorted by and its answer. Measured at 187 in `room-1`.
const ESTIMATE_BYTES: u64 = 185;

/// Buffers of the film while a picture is written, in halves: the means, their layers and the encoded file. Measured at
/// 3.4 to 3.5 buffers.
const WRITE_HALVES: u64 = 7;

/// What is going to be rendered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ahead {
    /// Numbers on the film.
    pub values: u64,
    pub passes: u32,
    /// The passes are a guess, as time decides.
    pub is_guess: bool,
    /// Size of the tiles before they are put together, over that of the film: shared samples make borders.
    pub tiles: f64,
    /// Photons stored by a pass, in the global map and in the caustic map.
    pub stored: [u64; 2],
    /// The photons of the first pass serve all.
    pub maps_once: bool,
    /// Bytes of what passes know of their pixels, and of what a pass adds to that.
    pub marks: [u64; 2],
    /// Photons of further kinds, in maps of their own that are built once those stand, and bytes beside them.
    pub further: [u64; 2],
    /// Bytes of tables.
    pub lights: u64,
    /// Estimates that are made together.
    pub estimates: u64,
}

impl RenderMemory {
    /// The largest of the four moments that can be the peak.
    pub(crate) fn predict(ahead: &Ahead) -> Self {
        let &Ahead { values, passes, tiles, stored: [global, caustic], marks: [marks, new_marks], lights, .. } = ahead;
        let stored = global + caustic;
        let buffer = values * 4;
        let before = Film::held_before(passes);
        // A guess that is off by one pass may be off by all sums but one: their mean is not.
        let after = if ahead.is_guess { before / 2 + 1 } else { Film::held_after(passes) };
        let at_build = if ahead.maps_once { 0 } else { before };
        // One map is built after the other.
        let building = (global * PHOTON_BUILD_BYTES + caustic * PHOTON_LIST_BYTES)
            .max(global * PHOTON_BYTES + caustic * PHOTON_BUILD_BYTES);
        let map_build = Self { film: at_build * buffer + marks, photons: building, lights, estimates: 0 };
        // The pass's own buffer, and its tiles before they are put together.
        let film = (before + 1) * buffer + (buffer as f64 * tiles) as u64 + marks + new_marks;
        let estimates = ahead.estimates * ESTIMATE_BYTES;
        let eye_pass = Self { film, photons: stored * PHOTON_BYTES, lights, estimates };
        let kept = if ahead.maps_once { stored * PHOTON_BYTES } else { 0 };
        let writing =
            Self { film: after * buffer + buffer * WRITE_HALVES / 2 + marks, photons: kept, lights, estimates: 0 };
        let [further, beside] = ahead.further;
        let build = further * PHOTON_BUILD_BYTES + beside;
        let further_build =
            Self { film: at_build * buffer + marks, photons: stored * PHOTON_BYTES + build, lights, estimates: 0 };
        [map_build, further_build, eye_pass, writing].into_iter().max_by_key(Self::total).unwrap_or_default()
    }

    /// All owners together.
    pub fn total(&self) -> u64 {
        self.film + self.photons + self.lights + self.estimates
    }
}
