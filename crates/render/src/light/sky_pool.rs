//! A pass's stock of directions to the sky, so that shadow rays need not search large pictures again and again.
//!
//! All pixels of a pass draw from the same few directions of each bin (as light tiles do: Wyman and Panteleev 2021,
//! "Rearchitecting Spatiotemporal Resampling for Production", section 3); passes draw new ones.

use super::environment::Environment;
use super::sky_view::SkyView;
use photinus_geometry::Vec3;
use photinus_num::{Sampler, StreamKind};
use rayon::prelude::*;

/// Directions of each bin.
const SLOTS: usize = 64;

/// One direction of the stock.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SkySample {
    /// Unit direction.
    pub dir: Vec3,
    /// Radiance from there.
    pub radiance: Vec3,
    /// Density within the bin over solid angle; 0 where the bin is dark.
    pub pdf: f32,
}

/// The stock.
#[derive(Clone, Debug)]
pub(crate) struct SkyPool {
    samples: Vec<SkySample>,
}

impl SkyPool {
    /// The stock of pass `pass`; passes continue one well-spread sequence in each bin.
    pub fn new(sky: &Environment, seed: u64, pass: u32) -> Self {
        let powers = sky.bin_powers();
        let samples = (0..SkyView::BINS * SLOTS)
            .into_par_iter()
            .map(|i| {
                let (bin, slot) = (i / SLOTS, i % SLOTS);
                if powers[bin] <= 0.0 {
                    return SkySample::default();
                }
                let index = pass.wrapping_mul(SLOTS as u32).wrapping_add(slot as u32);
                let mut sampler = Sampler::new(seed, StreamKind::Sky, bin as u64, index);
                let (u, choice) = (sampler.next_2d(), sampler.next_1d());
                let (dir, pdf) = sky.sample(bin, choice, u);
                SkySample { dir, radiance: sky.radiance(dir), pdf }
            })
            .collect();
        Self { samples }
    }

    /// One of the directions of a bin, by a number in 0..1.
    pub fn get(&self, bin: usize, choice: f32) -> &SkySample {
        &self.samples[bin * SLOTS + ((choice * SLOTS as f32) as usize).min(SLOTS - 1)]
    }

    /// Bytes of a stock.
    pub fn bytes() -> usize {
        SkyView::BINS * SLOTS * size_of::<SkySample>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Affine3A;
    use photinus_scene::{Bitmap, BitmapPixels, EnvironmentLight};
    use std::sync::Arc;

    #[test]
    fn stocked_directions_are_those_of_their_bins() {
        let data = (0..64 * 32).map(|i| [1.0 + (i % 7) as f32, 0.5, 0.2, 1.0]).collect();
        let bitmap = Arc::new(Bitmap { width: 64, height: 32, pixels: BitmapPixels::RgbaF32(data) });
        let sky = Environment::new(&EnvironmentLight::Image { bitmap, scale: 1.0, to_world: Affine3A::IDENTITY });
        let pools = [0, 1].map(|pass| SkyPool::new(&sky, 3, pass));
        let powers = sky.bin_powers();
        let (mut strays, mut count) = (0, 0);
        for bin in (0..SkyView::BINS).filter(|&bin| powers[bin] > 0.0) {
            for slot in 0..SLOTS {
                let [stocked, later] = pools.each_ref().map(|pool| pool.get(bin, (slot as f32 + 0.5) / SLOTS as f32));
                let (found, pdf) = sky.find(stocked.dir);
                // On the border of two cells rounding may name the other one.
                strays += usize::from(found != bin || (pdf - stocked.pdf).abs() > 1e-2 * pdf);
                count += 1;
                assert_eq!(stocked.radiance, sky.radiance(stocked.dir));
                assert_ne!(stocked.dir, later.dir);
            }
        }
        assert!(count > 10_000 && strays < count / 1000, "{strays} of {count}");
    }
}
