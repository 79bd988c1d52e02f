//! `final-gather`: rays from each visible point to surfaces where the irradiance of all light is known (Jensen 2001, section
//! 8.2; Christensen, Journal of Graphics Tools 4(3), 1999): what photons leave uneven is a hundredth of each estimate.

use super::gather_rays::{Buffers, GatherRay, GatherRays};
use super::known::known_irradiance;
use super::{Batch, IndirectEstimate, Kept, Preparing};
use crate::bsdf::{LobeSet, TransportMode};
use crate::counters::Counters;
use crate::eye_pass::EyePass;
use crate::renderer::RenderError;
use crate::tile::Part;
use photinus_geometry::{Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use photinus_photons::BuildOptions;
use photinus_photons::irradiance::IrradianceAtPhotons;

pub(super) const ABOUT: &str = "rays from each visible point to surfaces whose irradiance is known at photons";

/// Rays that are followed together.
const RAYS: usize = 1 << 14;

/// Rays to where irradiance is known.
pub(super) struct FinalGather {
    /// Irradiance of all light.
    pub known: IrradianceAtPhotons,
    /// Rays from each visible point.
    pub rays: u32,
}

/// Computes the irradiance at photons of all light.
pub(super) fn prepare(
    preparing: &mut Preparing,
    counters: &mut Counters,
) -> Result<Box<dyn IndirectEstimate>, RenderError> {
    Ok(Box::new(FinalGather::new(preparing, counters)?))
}

impl FinalGather {
    /// Computes the irradiance at photons of all light.
    pub fn new(preparing: &mut Preparing, counters: &mut Counters) -> Result<Self, RenderError> {
        let options = BuildOptions { radius_hint: preparing.maps.global.radius };
        let search = photinus_photons::build(&preparing.settings.search, std::mem::take(&mut preparing.all), &options)?;
        // One edge to the camera and the ray itself, for what the camera sees directly.
        let max_depth = preparing.max_depth.saturating_sub(2);
        let known = known_irradiance(preparing, &*search, max_depth, counters)?;
        Ok(Self { known, rays: preparing.settings.gather_rays })
    }

    /// Gathers for those estimates of the batch whose numbers `which` holds.
    pub fn gather(&self, eye: &EyePass, batch: &mut Batch, which: &[usize]) {
        let gather = GatherRays {
            world: eye.world,
            known: &self.known,
            max_depth: eye.max_depth,
            profiled: eye.profile_every > 0,
        };
        let sample = eye.pass.wrapping_mul(eye.spp).wrapping_add(batch.tile.sample);
        let (mut rays, mut buffers) = (Vec::new(), Buffers::default());
        for which in which.chunks((RAYS / self.rays as usize).max(1)) {
            for (owner, &i) in (0..).zip(which) {
                self.start(eye.seed, sample, owner, &batch.estimates.kept[i], &mut rays);
            }
            batch.counters.irradiance.gathered += which.len() as u64;
            let mut light = vec![Vec3::ZERO; which.len()];
            gather.follow(&mut rays, &mut buffers, batch.tracer, batch.counters, |owner, radiance, _| {
                light[owner as usize] += radiance;
            });
            for (&i, light) in which.iter().zip(light) {
                let e = &batch.estimates.list[i];
                batch.tile.add(e.path, Part::Indirect, e.throughput * light / self.rays as f32);
            }
        }
    }

    /// The rays of one estimate.
    fn start(&self, seed: u64, sample: u32, owner: u32, kept: &Kept, rays: &mut Vec<GatherRay>) {
        let Kept { point, bsdf, stream, depth, width } = kept;
        for ray in 0..self.rays {
            let index = sample.wrapping_mul(self.rays).wrapping_add(ray);
            let mut sampler = Sampler::new(seed, StreamKind::FinalGather, *stream, index);
            let (u, choice) = (sampler.next_2d(), sampler.next_1d());
            if let Some(s) = bsdf.sample(LobeSet::GATHER, choice, u, TransportMode::Radiance) {
                let ray = Ray::new(point.ray_origin(s.wi), s.wi);
                rays.push(GatherRay::new(ray, s.weight, sampler, owner, *depth, *width));
            }
        }
    }
}

impl IndirectEstimate for FinalGather {
    fn keeps_surfaces(&self) -> bool {
        true
    }

    fn answer(&self, eye: &EyePass, mut batch: Batch) {
        let all: Vec<usize> = (0..batch.estimates.list.len()).collect();
        self.gather(eye, &mut batch, &all);
    }
}
