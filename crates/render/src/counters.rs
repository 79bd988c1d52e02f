//! What a render counts.

use photinus_accel::RayCounters;
use photinus_profile::SearchCounters;
use serde::Serialize;
use std::ops::AddAssign;

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
    /// Paths cut at the longest allowed length.
    pub cut: u64,
    /// Power budget.
    pub power: PhotonPower,
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
    /// Work of the rays of the instrumented batches.
    pub sampled_rays: RayCounters,
    /// Work of the searches of the instrumented batches.
    pub sampled_searches: SearchCounters,
}

macro_rules! add {
    ($a:expr, $b:expr; $($field:ident),*) => { $($a.$field += $b.$field;)* };
}

impl AddAssign for PhotonCounts {
    fn add_assign(&mut self, other: Self) {
        add!(self, other; emitted, stored, stored_caustic, absorbed, escaped, cut);
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
        add!(self.rays, other.rays; emitted, photon, camera, specular, shadow, gather);
        add!(self, other; photons, caustic_photons, searches, photons_found, sampled_rays, sampled_searches);
    }
}

/// One batch in this many runs the instrumented twin of the kernels.
pub(crate) const INSTRUMENTED: usize = 64;
