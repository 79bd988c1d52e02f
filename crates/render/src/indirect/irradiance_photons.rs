//! `irradiance-photons`: the irradiance of the global map, computed at one photon in so many and looked up at the nearest with a
//! like normal (Christensen, "Faster Photon Map Global Illumination", Journal of Graphics Tools 4(3), 1999).
//!
//! Surfaces with a rough lobe keep their own density estimate.

use super::known::known_irradiance;
use super::{Batch, IndirectEstimate, Preparing, photons};
use crate::counters::Counters;
use crate::eye_pass::EyePass;
use crate::maps::Estimate;
use crate::renderer::RenderError;
use crate::tile::Part;
use photinus_photons::irradiance::IrradianceAtPhotons;

pub(super) const ABOUT: &str = "irradiance computed beforehand at every n-th photon, the nearest one's";

struct IrradiancePhotons {
    known: IrradianceAtPhotons,
}

/// Computes the irradiance.
pub(super) fn prepare(
    preparing: &mut Preparing,
    counters: &mut Counters,
) -> Result<Box<dyn IndirectEstimate>, RenderError> {
    // One edge to the camera, for what it sees directly.
    let max_depth = preparing.max_depth.saturating_sub(1);
    let known = known_irradiance(preparing, &*preparing.maps.global.search, max_depth, counters)?;
    Ok(Box::new(IrradiancePhotons { known }))
}

impl IndirectEstimate for IrradiancePhotons {
    fn keeps_surfaces(&self) -> bool {
        true
    }

    fn answer(&self, eye: &EyePass, mut batch: Batch) {
        let mut others: Vec<Estimate> = Vec::new();
        for (e, kept) in batch.estimates.list.iter().zip(&batch.estimates.kept) {
            let Some(factor) = kept.bsdf.diffuse_factor() else {
                others.push(*e);
                continue;
            };
            let found = self.known.at(e.query.position, e.query.normal);
            batch.counters.irradiance.count_look_up(found.is_some());
            if let Some(irradiance) = found {
                batch.tile.add(e.path, Part::Indirect, e.throughput * factor * irradiance);
            }
        }
        photons::estimate(eye, &mut batch, &others);
    }
}
