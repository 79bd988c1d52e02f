//! What a render tells while it runs, and how it is stopped.

use serde::Serialize;

/// Part of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Looking at the scene before the first pass: what is visible, how dense photons fall.
    Pilot,
    /// Photons are emitted and stored.
    PhotonPass,
    /// The photon map is built.
    MapBuild,
    /// Irradiance is computed at photons.
    Irradiance,
    /// Photons go on through what they hit.
    ShadowPhotons,
    /// A cache of irradiance is filled.
    IrradianceCache,
    /// Rays from the camera, and estimates where they land.
    EyePass,
}

impl Phase {
    /// Every one, in order.
    pub const ALL: [Self; 7] = [
        Self::Pilot,
        Self::PhotonPass,
        Self::MapBuild,
        Self::ShadowPhotons,
        Self::Irradiance,
        Self::IrradianceCache,
        Self::EyePass,
    ];

    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pilot => "pilot",
            Self::PhotonPass => "photon pass",
            Self::MapBuild => "map build",
            Self::ShadowPhotons => "shadow photons",
            Self::Irradiance => "irradiance at photons",
            Self::IrradianceCache => "irradiance cache",
            Self::EyePass => "eye pass",
        }
    }
}

/// Listens to a render, and may stop it. Called from many threads.
pub trait Observer: Sync {
    /// A phase of pass `pass` begins; the one before has ended.
    fn begin(&self, _phase: Phase, _pass: u32) {}

    /// `done` of `total` chunks of the current phase are finished.
    fn progress(&self, _done: u64, _total: u64) {}

    /// Whether to stop as soon as possible.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Listens to nothing and never stops.
pub struct Silent;

impl Observer for Silent {}

/// The render was stopped by its observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("stopped")]
pub struct Cancelled;
