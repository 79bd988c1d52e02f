//! How the estimates that a batch of paths asks for are made from the maps and put into the picture.

use crate::companions::Spread;
use crate::counters::Counters;
use crate::eye_pass::EyePass;
use crate::indirect::Batch;
use crate::maps::{Estimate, EstimateScratch, Estimated, Estimates};
use crate::support::{Look, Looker, points_for};
use crate::tile::{Part, Tile};
use crate::trace::Tracer;
use crate::twin::Twin;
use photinus_photons::Kernel;

impl EyePass<'_> {
    /// How much of the discs of estimates is surface.
    pub(crate) fn shares(
        &self,
        kernel: Kernel,
        list: &[Estimate],
        found: &[Estimated],
        tile: &Tile,
        tracer: &mut Tracer,
        counters: &mut Counters,
    ) -> Vec<f32> {
        let Some(pixels) = self.cut_pixels else { return vec![1.0; list.len()] };
        let sample = [tile.sample, self.pass * self.spp + tile.sample];
        let origin = [self.crop[0], self.crop[1]];
        let looker = Looker { world: self.world, kernel, pixels: Some(pixels), seed: self.seed, origin, sample };
        let pixel = |path: u32| tile.window_pixel(path);
        let look = |(e, found): (&Estimate, &Estimated)| {
            let mine = found.radiance.element_sum();
            let others = tile.light(e.path).element_sum();
            Look { radius: found.radius, density: found.density, count: points_for(mine / (mine + others)) }
        };
        let looks: Vec<Look> = list.iter().zip(found).map(look).collect();
        looker.shares(list, &looks, pixel, tracer, counters)
    }

    /// Answers the estimates of a batch from the maps.
    pub(crate) fn gather(
        &self,
        estimates: &Estimates,
        twin: &mut Twin,
        tile: &mut Tile,
        tracer: &mut Tracer,
        counters: &mut Counters,
    ) {
        let Some(maps) = self.maps else { return };
        let mut scratch = EstimateScratch::for_batch_of(tracer);
        let mut out: Vec<Estimated> = Vec::new();
        let (list, companions) = (&estimates.list, &estimates.companions);
        let batch = Batch { maps, estimates, twin, scratch: &mut scratch, out: &mut out, tile, tracer, counters };
        self.indirect.answer(self, batch);
        if let Some(caustic) = &maps.caustic {
            let mut spreads = vec![Spread::NONE; if companions.is_empty() { 0 } else { tile.weights.len() }];
            for list in [list, companions] {
                caustic.estimate(list, estimates, maps.knn, twin, &mut scratch, &mut out, counters);
                for (e, found) in list.iter().zip(&out) {
                    tile.add_shifted(e.path, e.shift, Part::Caustic, found, 1.0 / e.places as f32);
                    if e.places > 1 {
                        spreads[e.path as usize].add(found);
                    }
                }
            }
            let rims = (0u32..).zip(&spreads).filter(|(_, spread)| spread.is_rim());
            if let Some(pixels) = self.cut_pixels {
                rims.for_each(|(pixel, _)| pixels.saw_rim(tile.window_pixel(pixel)));
            }
        }
        scratch.hand_over(tracer);
    }
}
