//! The most memory that a render will hold, predicted before its first pass.

use super::Stop;
use crate::machine::resident;
use photinus_accel::StructureSummary;
use photinus_render::{Renderer, World};
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
    /// Tables that choose lights.
    Lights,
    /// Photons and what finds them.
    Photons,
    /// Estimates of many tiles that are made together.
    Estimates,
    /// Sums of the passes, and the picture while it is written.
    Film,
    /// The program, what its threads work on, and what loading left behind.
    Program,
}

/// A prediction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MemoryPrediction {
    /// The most that the process will hold.
    pub total_bytes: u64,
    /// The same by owner.
    pub by_owner: BTreeMap<Owner, u64>,
}

/// Where the system does not tell what the program holds.
const PROGRAM_BYTES: u64 = 6 << 20;
/// What a thread works on: queues of paths and estimates.
const THREAD_BYTES: u64 = 3 << 18;
/// Eye samples and photons that a thread handles in a second, roughly. The film grows with the logarithm of the passes,
/// so that an error of a factor of two here costs one buffer.
const RATE: f64 = 5e5;
/// Passes where only the error limits them.
const MANY_PASSES: f64 = 64.0;

/// Passes of `work` samples and photons each that the stop conditions allow.
fn expected_passes(stop: &Stop, work: f64) -> u32 {
    let threads = rayon::current_num_threads() as f64;
    let timed = stop.time_secs.map(|limit| limit * threads * RATE / work);
    let worked = stop.cpu_secs.map(|limit| limit * RATE / work);
    let counted = stop.pass_limit().map(f64::from);
    let least = [timed, worked, counted].into_iter().flatten().reduce(f64::min);
    least.unwrap_or(MANY_PASSES).clamp(1.0, 1e9) as u32
}

impl MemoryPrediction {
    pub(super) fn of(world: &World, renderer: &Renderer<'_>, structure: &StructureSummary, stop: &Stop) -> Self {
        let [_, _, width, height] = renderer.window();
        let work = f64::from(width) * f64::from(height) + f64::from(renderer.photons());
        let passes = expected_passes(stop, work);
        let render = renderer.predicted_memory(passes, stop.pass_limit() != Some(passes));
        let threads = rayon::current_num_threads() as u64;
        // The pilot has made the lights' tables.
        let held = world.geometry_bytes() as u64 + structure.bytes + world.texture_bytes() as u64 + render.lights;
        let now = resident();
        let by_owner = BTreeMap::from([
            (Owner::Geometry, world.geometry_bytes() as u64),
            (Owner::Structure, structure.bytes),
            (Owner::Textures, world.texture_bytes() as u64),
            (Owner::Lights, render.lights),
            (Owner::Photons, render.photons),
            (Owner::Estimates, render.estimates),
            (Owner::Film, render.film),
            (Owner::Program, now.map_or(PROGRAM_BYTES, |n| n.now_bytes.saturating_sub(held)) + THREAD_BYTES * threads),
        ]);
        let sum = by_owner.values().sum();
        // Loading and building may have held more than the render will.
        let total_bytes = now.map_or(sum, |resident| resident.peak_bytes.max(sum));
        Self { total_bytes, by_owner }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_limit_counts() {
        let stop = Stop { passes: Some(10), ..Stop::default() };
        assert_eq!(expected_passes(&stop, 1e6), 10);
        assert_eq!(expected_passes(&Stop { time_secs: Some(1e-3), ..stop }, 1e9), 1);
        assert_eq!(expected_passes(&Stop { cpu_secs: Some(4.0), ..stop }, 1e6), 2);
        let by_error = Stop { target_error: Some(0.1), ..Stop::default() };
        assert_eq!(expected_passes(&by_error, 1e6), MANY_PASSES as u32);
    }
}
