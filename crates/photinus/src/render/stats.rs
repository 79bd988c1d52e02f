//! The statistics of a render: what was counted, how long it took, what it held in memory.

use super::memory::{MemoryPrediction, Owner};
use super::stop::{Stop, StopReason};
use crate::machine::{Machine, resident};
use photinus_accel::StructureSummary;
use photinus_profile::{
    AccelProfile, IntersectProfile, PhotonProfile, Profile, ProfileSeconds, RayProfile, SearchProfile,
};
use photinus_render::{Counters, IrradianceCounts, PhotonCounts, PhotonPower, RayCounts, Settings, ShadowPhotonCounts};
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
    /// Irradiance is computed at photons.
    pub irradiance: Seconds,
    /// Photons go on through what they hit.
    pub shadow_photons: Seconds,
    /// A cache of irradiance is filled.
    pub irradiance_cache: Seconds,
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

/// Structure traversal.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AccelStats {
    /// Counts and seconds.
    #[serde(flatten)]
    pub profile: AccelProfile,
    /// What was built.
    pub structure: StructureSummary,
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
    /// Parts, beyond one each, that strong ones went on as: emitted + split = absorbed + escaped + cut.
    pub split: u64,
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
    /// Triangles of the scene, spheres not counted.
    pub triangles: u64,
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
    pub intersect: IntersectProfile,
    /// Structure traversal.
    pub accel: AccelStats,
    /// Photon search.
    pub search: SearchProfile,
    /// Irradiance that was computed, looked up and interpolated.
    pub irradiance: IrradianceCounts,
    /// Shadow photons and the shadow rays that they save.
    pub shadow_photons: ShadowPhotonCounts,
    /// Photons.
    pub photons: PhotonStats,
    /// Photons sent out for caustics alone.
    pub caustic_photons: PhotonStats,
    /// Thread seconds of what is neither test, traversal nor search, by function.
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
    /// Adds what was done outside the render, loading and writing for instance, by its processor seconds, and looks at
    /// the clocks and the memory again.
    pub fn add_other(&mut self, what: &str, cpu_secs: f64, stop: &Stop) {
        *self.other.entry(what.to_owned()).or_default() += cpu_secs;
        let (wall_secs, cpu_secs) = stop.clock();
        self.seconds = Seconds { wall_secs, cpu_secs };
        self.memory.peak_bytes = resident().map(|resident| resident.peak_bytes);
        self.settle();
    }

    /// Makes the entry of what no function accounts for, so that everything adds up to the processor time.
    pub(super) fn settle(&mut self) {
        self.other.remove(UNATTRIBUTED);
        let attributed: f64 = self.other.values().sum();
        let rest = self.profile().other_seconds() - attributed;
        self.other.insert(UNATTRIBUTED.to_owned(), rest.max(0.0));
    }

    /// The profile: what the thesis measured, and what hardware is projected from.
    pub fn profile(&self) -> Profile {
        let photons = |stats: &PhotonStats| PhotonProfile { emitted: stats.emitted, stored: stats.stored };
        Profile {
            scene: self.scene.clone(),
            triangles: self.triangles,
            seconds: ProfileSeconds { cpu_secs: self.seconds.cpu_secs },
            rays: RayProfile { total: self.rays.total },
            intersect: self.intersect,
            accel: self.accel.profile,
            search: self.search.clone(),
            photons: photons(&self.photons),
            caustic_photons: photons(&self.caustic_photons),
            other: self.other.clone(),
        }
    }
}

/// Key in [`Stats::other`] of what no function accounts for: camera rays, films, lists, threads.
const UNATTRIBUTED: &str = "unattributed";

impl RayStats {
    pub(super) fn of(counters: &Counters) -> Self {
        Self { counts: counters.rays, total: counters.rays.total() }
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
            split: photons.split,
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
