//! The most memory that a render will hold, predicted before it starts.

use super::RenderOptions;
use crate::machine::resident;
use photinus_accel::StructureSummary;
use photinus_render::{Aov, Film, FilmLayout, Mode, World};
use serde::Serialize;
use std::collections::BTreeMap;

/// Who holds memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Owner {
    /// Vertices, indices and their attributes.
    Geometry,
    /// The acceleration structure.
    Structure,
    /// Pictures and tables of materials.
    Textures,
    /// Photons and what finds them.
    Photons,
    /// Sums of the passes, and the picture while it is written.
    Film,
    /// The program, its threads and what they work on.
    Work,
}

/// A prediction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MemoryPrediction {
    /// The most that the process will hold.
    pub total_bytes: u64,
    /// The same by owner.
    pub by_owner: BTreeMap<Owner, u64>,
}

/// Stored photons per photon emitted where nothing is known of the scene.
const STORED_PER_EMITTED: f64 = 2.0;
/// Bytes of a stored photon while its search is built: chunks of the pass, all in order, keys and the search itself.
const BYTES_PER_PHOTON: f64 = 72.0;
/// The program, and what a thread works on.
const PROGRAM_BYTES: u64 = 12 << 20;
const THREAD_BYTES: u64 = 3 << 20;
/// Passes where only time or error limit them: the film grows with their logarithm.
const MANY_PASSES: u32 = 1024;

impl MemoryPrediction {
    pub(super) fn of(world: &World, options: &RenderOptions, structure: &StructureSummary, threads: usize) -> Self {
        let [_, _, width, height] = world.film.crop.unwrap_or([0, 0, world.film.width, world.film.height]);
        let pixels = width as usize * height as usize;
        let mut aovs = options.settings.aovs.clone();
        if options.stop.target_error.is_some() && !aovs.contains(&Aov::Variance) {
            aovs.push(Aov::Variance);
        }
        let channels = FilmLayout::new(&aovs).channels();
        let passes = options.stop.pass_limit().unwrap_or(MANY_PASSES);
        // The mean, its layers, and the encoded file exist at once while the picture is written.
        let film = Film::predicted_bytes(pixels * channels, passes) + 3 * 4 * pixels * channels;
        let photons = match options.settings.mode {
            Mode::Path => 0.0,
            _ => f64::from(options.settings.photons.unwrap_or(1_000_000)) * STORED_PER_EMITTED * BYTES_PER_PHOTON,
        };
        let by_owner = BTreeMap::from([
            (Owner::Geometry, world.geometry_bytes() as u64),
            (Owner::Structure, structure.bytes),
            (Owner::Textures, world.texture_bytes() as u64),
            (Owner::Photons, photons as u64),
            (Owner::Film, film as u64),
            (Owner::Work, PROGRAM_BYTES + THREAD_BYTES * threads as u64),
        ]);
        let sum = by_owner.values().sum();
        // Loading and building may have held more than the render will.
        let total_bytes = resident().map_or(sum, |resident| resident.peak_bytes.max(sum));
        Self { total_bytes, by_owner }
    }
}
