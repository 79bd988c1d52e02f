//! How the light that comes after a diffuse bounce is estimated at visible points: one list, one file a member.

mod final_gather;
mod gather_rays;
mod irradiance_cache;
mod irradiance_photons;
mod known;
mod photons;

use crate::bsdf::Bsdf;
use crate::camera::CameraModel;
use crate::control::Observer;
use crate::counters::Counters;
use crate::eye_pass::EyePass;
use crate::maps::{EstimateScratch, Estimated, Estimates, Maps};
use crate::renderer::RenderError;
use crate::settings::Settings;
use crate::tile::Tile;
use crate::trace::Tracer;
use crate::twin::Twin;
use crate::{SurfacePoint, world::World};
use photinus_photons::Photon;
use serde::Serialize;

pub(crate) use photons::Photons;

/// A choice of the family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Indirect {
    /// The density of photons around each visible point; the default.
    Photons,
    /// Irradiance that was computed at photons.
    IrradiancePhotons,
    /// Rays from each visible point to where irradiance is known.
    FinalGather,
    /// The same from a few points, interpolated between.
    IrradianceCache,
}

/// A member of the family.
#[derive(Clone, Copy, Debug)]
pub struct IndirectMember {
    /// Command-line name.
    pub name: &'static str,
    /// One sentence for help and documentation.
    pub about: &'static str,
    /// Which it is.
    pub choice: Indirect,
    prepare: Prepare,
}

/// Makes a member ready for the eye passes.
type Prepare = fn(&mut Preparing, &mut Counters) -> Result<Box<dyn IndirectEstimate>, RenderError>;

/// All members, the default first.
pub const INDIRECT: &[IndirectMember] = &[
    IndirectMember {
        name: "photons",
        about: photons::ABOUT,
        choice: Indirect::Photons,
        prepare: |_, _| Ok(Box::new(Photons)),
    },
    IndirectMember {
        name: "irradiance-photons",
        about: irradiance_photons::ABOUT,
        choice: Indirect::IrradiancePhotons,
        prepare: irradiance_photons::prepare,
    },
    IndirectMember {
        name: "final-gather",
        about: final_gather::ABOUT,
        choice: Indirect::FinalGather,
        prepare: final_gather::prepare,
    },
    IndirectMember {
        name: "irradiance-cache",
        about: irradiance_cache::ABOUT,
        choice: Indirect::IrradianceCache,
        prepare: irradiance_cache::prepare,
    },
];

impl Indirect {
    /// Its entry in the list.
    fn member(self) -> &'static IndirectMember {
        // Every choice is on the list; a test says so.
        INDIRECT.iter().find(|member| member.choice == self).unwrap_or(&INDIRECT[0])
    }

    /// Whether rays meet surfaces where all light that falls there must be known, straight from lights, too.
    pub(crate) fn wants_all_light(self) -> bool {
        matches!(self, Self::FinalGather | Self::IrradianceCache)
    }

    /// Makes the member ready.
    pub(crate) fn prepare(
        self,
        preparing: &mut Preparing,
        counters: &mut Counters,
    ) -> Result<Box<dyn IndirectEstimate>, RenderError> {
        (self.member().prepare)(preparing, counters)
    }
}

/// What members are made from.
pub(crate) struct Preparing<'p> {
    pub world: &'p World,
    pub camera: &'p CameraModel,
    /// Window of the film: x, y, width, height.
    pub crop: [u32; 4],
    pub settings: &'p Settings,
    /// Most edges of a path, camera to light.
    pub max_depth: u32,
    pub maps: &'p Maps,
    /// Photons of all light, where the member wants them.
    pub all: Vec<Photon>,
    pub observer: &'p dyn Observer,
}

/// What rays from a visible point need to know of it.
pub(crate) struct Kept {
    pub point: SurfacePoint,
    pub bsdf: Bsdf,
    /// Random numbers of its rays.
    pub stream: u64,
    /// Edges of the path from the camera to it.
    pub depth: u32,
    /// Width of the pixel there.
    pub width: f32,
}

/// A batch of estimates that are to be put into the picture.
pub(crate) struct Batch<'b, 't, 'w> {
    pub maps: &'b Maps,
    pub estimates: &'b Estimates,
    pub twin: &'b mut Twin,
    pub scratch: &'b mut EstimateScratch,
    pub out: &'b mut Vec<Estimated>,
    pub tile: &'b mut Tile<'t>,
    pub tracer: &'b mut Tracer<'w>,
    pub counters: &'b mut Counters,
}

/// A member, ready for eye passes.
pub(crate) trait IndirectEstimate: Send + Sync {
    /// Whether it needs [`Kept`] of each estimate.
    fn keeps_surfaces(&self) -> bool {
        false
    }

    /// Adds the light after a diffuse bounce of a batch of estimates to their pixels.
    fn answer(&self, eye: &EyePass, batch: Batch);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_choice_is_on_the_list_once() {
        use Indirect::{FinalGather, IrradianceCache, IrradiancePhotons};
        for choice in [Indirect::Photons, IrradiancePhotons, FinalGather, IrradianceCache] {
            assert_eq!(INDIRECT.iter().filter(|member| member.choice == choice).count(), 1, "{choice:?}");
            assert_eq!(choice.member().choice, choice);
        }
        assert_eq!(INDIRECT[0].choice, Settings::default().indirect);
    }
}
