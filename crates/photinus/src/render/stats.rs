//! The statistics of a render: what was counted, how long it took, what it held in memory.

use super::memory::{MemoryPrediction, Owner};
use super::stop::{Stop, StopReason};
use crate::machine::{Machine, resident};
use photinus_accel::StructureSummary;
use photinus_render::{Counters, PhotonCounts, PhotonPower, RayCounts, Settings};
use serde::Serialize;
use std::collections::BTreeMap;

/// Time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// By the clock on the wall.
    pub wall_secs: f64,
    /// Of processor time, all threads together.
    pub cpu_secs: f64,
}

/// Seconds by phase.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PhaseStats {
    /// The scene is compiled and the structure built.
    pub build: Seconds,
    /// Visible points and first radii are found.
    pub pilot: Seconds,
    /// Photons are emitted and stored.
    pub photon_pass: Seconds,
    /// Photon maps are built.
    pub map_build: Seconds,
    /// Rays from the camera, and estimates where they land.
    pub eye_pass: Seconds,
}

/// Rays by purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RayStats {
    /// Photons sent out, and rays by purpose.
    #[serde(flatten)]
    pub counts: RayCounts,
    /// All rays traced.
    pub total: u64,
}

/// Ray-primitive tests. Counts are scaled up from the batches that run the counting kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct IntersectStats {
    /// Tests of all rays.
    pub tests: f64,
    /// Tests of a ray, in the mean.
    pub tests_per_ray: f64,
    /// Thread seconds in tests: the share of the ray queries' time that a fit of the counted batches' times to their
    /// nodes and tests gives the tests.
    pub seconds: f64,
}

/// Structure traversal. Counts are scaled up from the batches that run the counting kernel.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AccelStats {
    /// Nodes visited by all rays, leaves excluded.
    pub nodes_visited: f64,
    /// Nodes visited by a ray, in the mean.
    pub nodes_per_ray: f64,
    /// Leaves visited by a ray, in the mean.
    pub leaves_per_ray: f64,
    /// Primitives of a leaf visited, in the mean.
    pub triangles_per_leaf: f64,
    /// Levels below the root.
    pub depth: u32,
    /// Thread seconds in traversal: the rest of the ray queries' time.
    pub seconds: f64,
    /// Rays of the batches that were counted.
    pub rays_counted: u64,
    /// What was built.
    pub structure: StructureSummary,
}

/// Photon search.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SearchStats {
    /// Member name.
    pub name: String,
    /// Searches made.
    pub searches: u64,
    /// Photons found by a search, in the mean.
    pub photons_found_mean: f64,
    /// Photons tested by all searches, scaled up from the batches that run the counting kernel.
    pub photons_tested: f64,
    /// Thread seconds in photon searches, with the sums that they make.
    pub seconds: f64,
    /// Searches of the batches that were counted.
    pub searches_counted: u64,
}

/// Photons and their power.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PhotonStats {
    /// Sent out.
    pub emitted: u64,
    /// Stored.
    pub stored: u64,
    /// Of those, in the caustic map.
    pub stored_caustic: u64,
    /// Ended at a surface.
    pub absorbed: u64,
    /// Left the scene.
    pub escaped: u64,
    /// Reached the longest allowed path.
    pub cut: u64,
    /// Where the power went, W, RGB: emitted = absorbed + escaped + cut.
    pub power: PhotonPower,
}

/// Memory.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MemoryStats {
    /// The most that this process held; none where the system does not tell.
    pub peak_bytes: Option<u64>,
    /// What was predicted before the first pass; none where the render was stopped before that.
    pub predicted_bytes: Option<u64>,
    /// The prediction by owner.
    pub by_owner: BTreeMap<Owner, u64>,
}

/// Everything that is known about a finished render.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stats {
    /// Name of the scene.
    pub scene: String,
    /// Pixels across and down of the window that was rendered.
    pub size: [u32; 2],
    /// Passes that ran.
    pub passes: u32,
    /// Why it ended.
    pub stopped: StopReason,
    /// Mean relative squared error of the pixels, estimated from the passes; none where it was not tracked.
    pub estimated_error: Option<f64>,
    /// First gather radii: after a diffuse bounce, and of caustics; scene units. None without photons.
    pub first_radii: Option<[f32; 2]>,
    /// Since the start that stop conditions count from.
    pub seconds: Seconds,
    /// Seconds by phase.
    pub phases: PhaseStats,
    /// Rays by purpose.
    pub rays: RayStats,
    /// Ray-primitive tests.
    pub intersect: IntersectStats,
    /// Structure traversal.
    pub accel: AccelStats,
    /// Photon search.
    pub search: SearchStats,
    /// Photons.
    pub photons: PhotonStats,
    /// Photons sent out for caustics alone.
    pub caustic_photons: PhotonStats,
    /// Wall seconds of what is none of the phases, by function.
    pub other: BTreeMap<String, f64>,
    /// Memory.
    pub memory: MemoryStats,
    /// Threads.
    pub threads: usize,
    /// Seed.
    pub seed: u64,
    /// Settings that decide the bits of the picture.
    pub settings: Settings,
    /// Version of this program.
    pub version: &'static str,
    /// The machine.
    pub machine: Machine,
}

impl Stats {
    /// Adds what was done outside the render, loading and writing for instance, and looks at the clocks and the memory
    /// again.
    pub fn add_other(&mut self, what: &str, wall_secs: f64, stop: &Stop) {
        *self.other.entry(what.to_owned()).or_default() += wall_secs;
        let (wall_secs, cpu_secs) = stop.clock();
        self.seconds = Seconds { wall_secs, cpu_secs };
        self.memory.peak_bytes = resident().map(|resident| resident.peak_bytes);
    }
}

impl RayStats {
    pub(super) fn of(counters: &Counters) -> Self {
        let counts = counters.rays;
        let total = counts.photon + counts.camera + counts.specular + counts.shadow + counts.gather;
        Self { counts, total }
    }
}

impl IntersectStats {
    pub(super) fn of(counters: &Counters, seconds: f64) -> Self {
        let tests_per_ray = ratio(counters.sampled_rays.intersect.tests, counters.sampled_rays.traversal.rays);
        Self { tests: tests_per_ray * RayStats::of(counters).total as f64, tests_per_ray, seconds }
    }
}

impl AccelStats {
    pub(super) fn of(counters: &Counters, structure: StructureSummary, seconds: f64) -> Self {
        let sampled = counters.sampled_rays.traversal;
        let nodes_per_ray = ratio(sampled.nodes_visited, sampled.rays);
        Self {
            nodes_visited: nodes_per_ray * RayStats::of(counters).total as f64,
            nodes_per_ray,
            leaves_per_ray: ratio(sampled.leaves_visited, sampled.rays),
            triangles_per_leaf: ratio(sampled.leaf_prims, sampled.leaves_visited),
            depth: structure.depth,
            seconds,
            rays_counted: sampled.rays,
            structure,
        }
    }
}

impl SearchStats {
    pub(super) fn of(counters: &Counters, name: &str, seconds: f64) -> Self {
        let sampled = counters.sampled_searches;
        Self {
            name: name.to_owned(),
            searches: counters.searches,
            photons_found_mean: ratio(counters.photons_found, counters.searches),
            photons_tested: ratio(sampled.photons_tested, sampled.searches) * counters.searches as f64,
            seconds,
            searches_counted: sampled.searches,
        }
    }
}

impl PhotonStats {
    pub(super) fn of(photons: &PhotonCounts) -> Self {
        Self {
            emitted: photons.emitted,
            stored: photons.stored,
            stored_caustic: photons.stored_caustic,
            absorbed: photons.absorbed,
            escaped: photons.escaped,
            cut: photons.cut,
            power: photons.power,
        }
    }
}

impl MemoryStats {
    pub(super) fn of(prediction: Option<&MemoryPrediction>) -> Self {
        Self {
            peak_bytes: resident().map(|resident| resident.peak_bytes),
            predicted_bytes: prediction.map(|prediction| prediction.total_bytes),
            by_owner: prediction.map(|prediction| prediction.by_owner.clone()).unwrap_or_default(),
        }
    }
}

/// A mean; 0 where nothing was counted.
fn ratio(sum: u64, count: u64) -> f64 {
    if count == 0 { 0.0 } else { sum as f64 / count as f64 }
}
