//! Irradiance at the photons of a map, what cuts the discs of the estimates taken into account.

use super::Preparing;
use crate::control::{Cancelled, Phase};
use crate::counters::Counters;
use crate::maps::{Estimate, Scatter};
use crate::support::Looker;
use crate::trace::Tracer;
use crate::twin::Twin;
use photinus_geometry::Vec3;
use photinus_photons::irradiance::{IrradianceAtPhotons, IrradianceOptions, KnownIrradiance, irradiance_at_photons};
use photinus_photons::{GatherQuery, Kernel, Search};
use rayon::prelude::*;

/// Photons whose discs are looked at together; fixed, so that batches do not depend on the machine.
const BATCH: usize = 2048;

/// The irradiance at one photon in so many of `search`, of light that has come along at most `max_depth` edges to it.
pub(super) fn known_irradiance(
    preparing: &Preparing,
    search: &dyn Search,
    max_depth: u32,
    counters: &mut Counters,
) -> Result<IrradianceAtPhotons, Cancelled> {
    let Preparing { maps, settings, observer, .. } = preparing;
    observer.begin(Phase::Irradiance, 0);
    let every = settings.irradiance_every;
    let radius = maps.global.radius;
    let kernel = maps.global.kernel;
    let options = IrradianceOptions { every, radius, knn: settings.knn, kernel, max_depth: max_depth.min(127) };
    let mut known = irradiance_at_photons(search, &options);
    counters.irradiance.precomputed += known.len() as u64;
    counters.irradiance.photons_found += known.iter().map(|known| u64::from(known.count)).sum::<u64>();
    let counted: Vec<Option<Counters>> = known
        .par_chunks_mut(BATCH)
        .enumerate()
        .map(|(batch, known)| {
            (!observer.cancelled()).then(|| divide_by_shares(preparing, kernel, (batch * BATCH) as u32, known))
        })
        .collect();
    for counted in counted {
        *counters += counted.ok_or(Cancelled)?;
    }
    // Where photons are so few that most estimates would find none, it takes as many discs as the photons left out would have
    // had to find as much light as they.
    let farthest = radius * (every as f32).sqrt();
    Ok(IrradianceAtPhotons::new(&known, IrradianceAtPhotons::LEAST_COSINE, farthest))
}

/// Divides estimates by the share of their discs that is surface.
fn divide_by_shares(preparing: &Preparing, kernel: Kernel, first: u32, known: &mut [KnownIrradiance]) -> Counters {
    let mut counters = Counters::default();
    let mut tracer = Tracer::new(preparing.world, Twin::OFF);
    let estimates: Vec<Estimate> = known.iter().map(estimate_at).collect();
    let looker = Looker::of_photons(preparing.world, kernel, preparing.settings.seed, first);
    let radii: Vec<f32> = known.iter().map(|known| known.radius).collect();
    let shares = looker.shares_of_photons(&estimates, &radii, &mut tracer, &mut counters);
    known.iter_mut().zip(shares).for_each(|(known, share)| known.irradiance /= share);
    counters
}

/// The estimate at a photon, as far as what cuts its disc is concerned. Surfaces count from either side: the photon's own
/// stands for the outside.
fn estimate_at(known: &KnownIrradiance) -> Estimate {
    let query =
        GatherQuery { position: known.position, radius: known.radius, normal: known.normal, max_depth: u32::MAX };
    Estimate {
        query,
        side: 1.0,
        scatter: Scatter::Constant(Vec3::ONE),
        throughput: Vec3::ONE,
        path: 0,
        places: 1,
        shift: [0.0; 2],
        ray: crate::recording::NOT_YET,
        offset: 1e-5 * known.position.abs().max_element(),
        is_first: false,
        scale: 1.0,
        caustic_scale: 1.0,
    }
}
