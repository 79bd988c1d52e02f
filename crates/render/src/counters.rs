//! What a render counts.

use photinus_accel::RayCounters;
use photinus_profile::{EstimateTicks, SearchCounters, thread_nanoseconds};
use serde::Serialize;
use std::ops::AddAssign;

macro_rules! add {
    ($a:expr, $b:expr; $($field:ident),*) => { $($a.$field += $b.$field;)* };
}

/// Rays by their purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RayCounts {
    /// Photons sent out by lights.
    pub emitted: u64,
    /// Photon rays, first segments included.
    pub photon: u64,
    /// Rays from the camera.
    pub camera: u64,
    /// Eye rays after a bounce.
    pub specular: u64,
    /// Rays that ask whether a light is visible.
    pub shadow: u64,
    /// Rays from a diffuse surface that look for lights, to weight against shadow rays.
    pub gather: u64,
    /// Rays that look how much of an estimate's disc is surface.
    pub support: u64,
    /// Rays of final gathering, and on from mirrors and glass that they meet.
    pub final_gather: u64,
    /// Any of these once more, from behind a hole that let it through.
    pub beyond: u64,
}

impl RayCounts {
    /// All rays traced.
    pub fn total(&self) -> u64 {
        self.photon
            + self.camera
            + self.specular
            + self.shadow
            + self.gather
            + self.support
            + self.final_gather
            + self.beyond
    }
}

/// Irradiance that is computed once and looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct IrradianceCounts {
    /// Photons at which it was computed.
    pub precomputed: u64,
    /// Photons that those estimates found.
    pub photons_found: u64,
    /// Look-ups of the nearest such photon.
    pub look_ups: u64,
    /// Of those, without a photon near enough that faces alike.
    pub missed: u64,
    /// Records of the irradiance cache.
    pub records: u64,
    /// Visible points whose irradiance was interpolated between records.
    pub interpolated: u64,
    /// Visible points that gathered for themselves.
    pub gathered: u64,
}

/// Shadow photons and the shadow rays that they save.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ShadowPhotonCounts {
    /// Stored where photons meet their first surface.
    pub lit: u64,
    /// Stored on the surfaces behind.
    pub shadow: u64,
    /// Shadow rays that were not sent as the light is seen.
    pub rays_known_lit: u64,
    /// Shadow rays that were not sent as it is hidden.
    pub rays_known_dark: u64,
}

impl ShadowPhotonCounts {
    /// Counts a shadow ray that is not sent.
    pub(crate) fn count_known(&mut self, share: f32) {
        self.rays_known_lit += u64::from(share > 0.0);
        self.rays_known_dark += u64::from(share == 0.0);
    }
}

impl AddAssign for ShadowPhotonCounts {
    fn add_assign(&mut self, other: Self) {
        add!(self, other; lit, shadow, rays_known_lit, rays_known_dark);
    }
}

impl IrradianceCounts {
    /// Counts a look-up.
    #[inline]
    pub(crate) fn count_look_up(&mut self, is_found: bool) {
        self.look_ups += 1;
        self.missed += u64::from(!is_found);
    }
}

impl AddAssign for IrradianceCounts {
    fn add_assign(&mut self, other: Self) {
        add!(self, other; precomputed, photons_found, look_ups, missed, records, interpolated, gathered);
    }
}

/// Where the power of the photons went, W, RGB. Emitted = absorbed + escaped + cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PhotonPower {
    /// Sent out.
    pub emitted: [f64; 3],
    /// Left at surfaces.
    pub absorbed: [f64; 3],
    /// Left the scene.
    pub escaped: [f64; 3],
    /// Still on its way when the path reached its longest allowed length.
    pub cut: [f64; 3],
    /// Power that arrived where photons were stored; no part of the sum.
    pub stored: [f64; 3],
}

/// Photons by what became of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PhotonCounts {
    /// Sent out.
    pub emitted: u64,
    /// Stored, once for each surface that keeps them.
    pub stored: u64,
    /// Of those, in the caustic map.
    pub stored_caustic: u64,
    /// Paths that ended at a surface.
    pub absorbed: u64,
    /// Paths that left the scene.
    pub escaped: u64,
    /// Parts, beyond one each, that strong photons went on as.
    pub split: u64,
    /// Paths cut at the longest allowed length.
    pub cut: u64,
    /// Power budget.
    pub power: PhotonPower,
}

/// Where the threads' processor time went, nanoseconds. What is left of it is in no list: camera rays, films, lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Spent {
    /// Ray queries: tests and traversal.
    pub rays: u64,
    /// Estimates from photons: searches, and what weighs the photons found.
    pub estimates: u64,
    /// Where rays land: surface points, textures, materials, scattering, light sampling.
    pub surfaces: u64,
}

impl AddAssign for Spent {
    fn add_assign(&mut self, other: Self) {
        add!(self, other; rays, estimates, surfaces);
    }
}

/// Does work and, where the render is profiled, adds the thread's processor time to `nanoseconds`.
pub(crate) fn timed<T>(profiled: bool, nanoseconds: &mut u64, work: impl FnOnce() -> T) -> T {
    if !profiled {
        return work();
    }
    let begun = thread_nanoseconds();
    let out = work();
    *nanoseconds += thread_nanoseconds().saturating_sub(begun);
    out
}

/// Everything that a render counts; merged in a fixed order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Counters {
    /// Rays, all of them.
    pub rays: RayCounts,
    /// Photons, all of them but those sent out for caustics alone.
    pub photons: PhotonCounts,
    /// Photons sent out for caustics alone: they end (absorbed) where they can no longer belong to one.
    pub caustic_photons: PhotonCounts,
    /// Estimates from photons, all of them.
    pub searches: u64,
    /// Photons that they found.
    pub photons_found: u64,
    /// Irradiance that was computed, looked up and interpolated.
    pub irradiance: IrradianceCounts,
    /// Shadow photons and the shadow rays that they save.
    pub shadow_photons: ShadowPhotonCounts,
    /// Work of the rays that ran the instrumented twin.
    pub sampled_rays: RayCounters,
    /// Work of the searches that did.
    pub sampled_searches: SearchCounters,
    /// How their time was split between search and the rest.
    pub sampled_estimates: EstimateTicks,
    /// Processor time of all queries; with ticks the only part that differs from run to run.
    pub spent: Spent,
}

impl AddAssign for PhotonCounts {
    fn add_assign(&mut self, other: Self) {
        add!(self, other; emitted, stored, stored_caustic, absorbed, escaped, cut, split);
        for c in 0..3 {
            self.power.emitted[c] += other.power.emitted[c];
            self.power.absorbed[c] += other.power.absorbed[c];
            self.power.escaped[c] += other.power.escaped[c];
            self.power.cut[c] += other.power.cut[c];
            self.power.stored[c] += other.power.stored[c];
        }
    }
}

impl AddAssign for Counters {
    fn add_assign(&mut self, other: Self) {
        add!(self.rays, other.rays; emitted, photon, camera, specular, shadow, gather, support, final_gather, beyond);
        add!(self, other; photons, caustic_photons, searches, photons_found, irradiance, shadow_photons);
        add!(self, other; sampled_rays, sampled_searches, sampled_estimates, spent);
    }
}
