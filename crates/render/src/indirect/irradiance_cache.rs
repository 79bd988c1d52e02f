//! `irradiance-cache`: final gathering at few points, whose irradiance is interpolated between (Ward, Rubinstein and Clear, "A Ray
//! Tracing Solution for Diffuse Interreflection", SIGGRAPH 1988; Ward and Heckbert, "Irradiance Gradients", 1992).
//!
//! The cache is filled before the first eye pass, so that it does not depend on who asks first: visible points of every 16th
//! pixel, then of every 8th, and so on, in batches. Which points of a batch want a record is decided by the records of the
//! batches before, the records are computed side by side, and they are added in the order of the points. What an eye pass finds
//! unknown, and where a rough lobe scatters, points gather for themselves.

use super::final_gather::FinalGather;
use super::gather_rays::{Buffers, GatherRay, GatherRays};
use super::{Batch, IndirectEstimate, Preparing};
use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use crate::control::{Cancelled, Phase};
use crate::counters::Counters;
use crate::eye_pass::EyePass;
use crate::renderer::RenderError;
use crate::tile::Part;
use crate::trace::Tracer;
use crate::twin::Twin;
use photinus_geometry::{Frame, Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use photinus_photons::irradiance::{Hemisphere, HemisphereSample, IrradianceCache, IrradianceRecord};
use rayon::prelude::*;

pub(super) const ABOUT: &str = "final gathering at few points, irradiance interpolated between them";

/// Distance between the pixels of the first round; halved from round to round.
const COARSEST: u32 = 16;
/// Pixels whose points are looked for together, points decided about together, and records computed together.
const PIXELS: usize = 1024;
const POINTS: usize = 256;
const RECORDS: usize = 8;
/// Rays of a record, over those of a point that gathers for itself: its noise is seen all around.
const MORE_RAYS: u32 = 4;
/// Records are made closer together than look-ups need them: eye passes then seldom find a gap.
const CLOSER: f32 = 0.7;
/// Bounds of the distance that a record holds for, in widths of its pixel.
const WIDTHS: [f32; 2] = [1.5, 20.0];
/// Most mirrors and clear surfaces in a row on the way to a point that is looked for.
const MIRRORS: u32 = 8;

struct CachedIrradiance {
    gather: FinalGather,
    cache: IrradianceCache,
}

/// A point that may want a record.
struct Candidate {
    position: Vec3,
    normal: Vec3,
    /// Face normal on the same side; rays below it end.
    geometric_normal: Vec3,
    /// How far off the surface its rays start.
    offset: f32,
    depth: u32,
    /// Width of the pixel there.
    width: f32,
}

/// Computes the irradiance at photons, then fills the cache.
pub(super) fn prepare(
    preparing: &mut Preparing,
    counters: &mut Counters,
) -> Result<Box<dyn IndirectEstimate>, RenderError> {
    let gather = FinalGather::new(preparing, counters)?;
    let accuracy = preparing.settings.cache_accuracy;
    let mut cache = IrradianceCache::new(preparing.world.bounds(), accuracy);
    preparing.observer.begin(Phase::IrradianceCache, 0);
    let mut stride = COARSEST;
    while stride > 0 {
        let pixels = pixels_of_round(preparing.crop, stride);
        let found: Vec<(Vec<Candidate>, Counters)> =
            pixels.par_chunks(PIXELS).map(|pixels| candidates(preparing, pixels)).collect();
        let mut points = Vec::new();
        for (candidates, counted) in found {
            points.extend(candidates);
            *counters += counted;
        }
        for points in points.chunks(POINTS) {
            if preparing.observer.cancelled() {
                return Err(Cancelled.into());
            }
            let is_unknown = |point: &&Candidate| !cache.is_known(point.position, point.normal, CLOSER * accuracy);
            let unknown: Vec<&Candidate> = points.iter().filter(is_unknown).collect();
            let first = cache.records().len() as u32;
            let made: Vec<(Vec<IrradianceRecord>, Counters)> = unknown
                .par_chunks(RECORDS)
                .enumerate()
                .map(|(part, points)| records(preparing, &gather, points, first + (part * RECORDS) as u32))
                .collect();
            for (records, counted) in made {
                *counters += counted;
                // A record of light beyond all bounds is none.
                counters.irradiance.records += records.into_iter().filter_map(|r| cache.insert(r).ok()).count() as u64;
            }
        }
        stride /= 2;
    }
    Ok(Box::new(CachedIrradiance { gather, cache }))
}

/// Pixels of the window that a round adds, those that follow one another far apart: by a permutation of rows and columns that
/// reverses bits.
fn pixels_of_round([x0, y0, width, height]: [u32; 4], stride: u32) -> Vec<[u32; 2]> {
    let axis = |length: u32| {
        let mut places: Vec<u32> = (0..length).step_by(stride as usize).collect();
        places.sort_by_key(|place| (place / stride).reverse_bits());
        places
    };
    let columns = axis(width);
    let is_new = |&[x, y]: &[u32; 2]| stride == COARSEST || x % (2 * stride) != 0 || y % (2 * stride) != 0;
    let pixels = axis(height).into_iter().flat_map(|y| columns.iter().map(move |x| [*x, y]));
    pixels.filter(is_new).map(|[x, y]| [x0 + x, y0 + y]).collect()
}

/// What the middles of pixels see that a record may be made of.
fn candidates(preparing: &Preparing, pixels: &[[u32; 2]]) -> (Vec<Candidate>, Counters) {
    let Preparing { world, camera, settings, max_depth, .. } = preparing;
    struct Look {
        ray: Ray,
        sampler: Sampler,
        width: f32,
        spread: f32,
        depth: u32,
    }
    let mut looks: Vec<Look> = pixels
        .iter()
        .map(|&[x, y]| {
            let stream = u64::from(y) << 32 | u64::from(x);
            let mut sampler = Sampler::new(settings.seed, StreamKind::IrradianceCache, stream, 0);
            let start = camera.ray([x as f32 + 0.5, y as f32 + 0.5], &mut sampler);
            Look { ray: start.ray, sampler, width: start.width, spread: start.spread, depth: 0 }
        })
        .collect();
    let mut tracer = Tracer::new(world, Twin::OFF);
    let (mut counters, mut found) = (Counters::default(), Vec::new());
    let (mut rays, mut hits, mut bsdf) = (Vec::new(), Vec::new(), Bsdf::default());
    for _ in 0..=MIRRORS {
        rays.clear();
        rays.extend(looks.iter().map(|look| look.ray));
        counters.rays.final_gather += rays.len() as u64;
        tracer.closest(&rays, &mut hits, &mut counters, |i| looks[i].sampler.next_1d());
        let mut next = Vec::new();
        for (mut look, hit) in looks.into_iter().zip(&hits) {
            look.depth += 1;
            if !hit.is_hit() || look.depth >= *max_depth {
                continue;
            }
            look.width += look.spread * hit.t;
            let point = world.surface(&look.ray, hit, look.width);
            let material = world.shapes[point.shape as usize].material;
            world.materials.resolve_into(material, &point, -look.ray.dir, &mut bsdf);
            if bsdf.diffuse_factor().is_some() {
                found.push(Candidate {
                    position: point.position,
                    normal: bsdf.shading_normal(),
                    geometric_normal: bsdf.geometric_normal(),
                    offset: point.offset,
                    depth: look.depth,
                    width: look.width,
                });
            }
            look.sampler.start_vertex();
            let (choice, u) = (look.sampler.next_1d(), look.sampler.next_2d());
            if let Some(s) = bsdf.sample(LobeSet::CONTINUE, choice, u, TransportMode::Radiance) {
                look.ray = Ray::new(point.ray_origin(s.wi), s.wi);
                next.push(look);
            }
        }
        looks = next;
    }
    (found, counters)
}

/// The records of some points, the first of which is number `first` of the cache.
fn records(
    preparing: &Preparing,
    gather: &FinalGather,
    points: &[&Candidate],
    first: u32,
) -> (Vec<IrradianceRecord>, Counters) {
    let hemisphere = Hemisphere::new(gather.rays.saturating_mul(MORE_RAYS));
    let count = hemisphere.len() as usize;
    let rays = GatherRays {
        world: preparing.world,
        known: &gather.known,
        max_depth: preparing.max_depth,
        profiled: preparing.settings.profile_every > 0,
    };
    let mut counters = Counters::default();
    let mut tracer = Tracer::new(preparing.world, Twin::OFF);
    let (mut walks, mut buffers, mut made) = (Vec::new(), Buffers::default(), Vec::new());
    for (number, point) in (first..).zip(points) {
        let frame = Frame::from_normal(point.normal);
        // Directions below the face bring nothing, from as far away as the others say.
        let mut samples = vec![HemisphereSample { radiance: Vec3::ZERO, distance: f32::INFINITY }; count];
        let stream = u64::from(number) | 1 << 63;
        for i in 0..hemisphere.len() {
            let mut sampler = Sampler::new(preparing.settings.seed, StreamKind::IrradianceCache, stream, i);
            let dir = frame.to_world(hemisphere.direction(i, sampler.next_2d())).normalize();
            if point.geometric_normal.dot(dir) > 0.0 {
                let origin = point.position + point.geometric_normal * point.offset;
                walks.push(GatherRay::new(Ray::new(origin, dir), Vec3::ONE, sampler, i, point.depth, point.width));
            }
        }
        rays.follow(&mut walks, &mut buffers, &mut tracer, &mut counters, |i, radiance, distance| {
            let sample = &mut samples[i as usize];
            sample.radiance += radiance;
            if let Some(distance) = distance {
                sample.distance = distance;
            }
        });
        let limits = WIDTHS.map(|widths| widths * point.width / preparing.settings.cache_accuracy);
        made.extend(hemisphere.record(point.position, &frame, &samples, limits));
    }
    (made, counters)
}

impl IndirectEstimate for CachedIrradiance {
    fn keeps_surfaces(&self) -> bool {
        true
    }

    fn answer(&self, eye: &EyePass, mut batch: Batch) {
        let mut unknown = Vec::new();
        for (i, (e, kept)) in batch.estimates.list.iter().zip(&batch.estimates.kept).enumerate() {
            let light = |factor: Vec3| {
                let irradiance = self.cache.at(e.query.position, kept.bsdf.shading_normal());
                irradiance.map(|irradiance| factor * irradiance)
            };
            match kept.bsdf.diffuse_factor().and_then(light) {
                Some(light) => {
                    batch.counters.irradiance.interpolated += 1;
                    batch.tile.add(e.path, Part::Indirect, e.throughput * light);
                }
                None => unknown.push(i),
            }
        }
        self.gather.gather(eye, &mut batch, &unknown);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_have_every_pixel_of_the_window_once() {
        for window in [[0, 0, 70, 33], [5, 9, 1, 1], [3, 0, 16, 48]] {
            let strides = [16, 8, 4, 2, 1];
            let mut all: Vec<[u32; 2]> = strides.iter().flat_map(|s| pixels_of_round(window, *s)).collect();
            let [x0, y0, width, height] = window;
            assert_eq!(all.len(), (width * height) as usize, "{window:?}");
            all.sort_unstable();
            all.dedup();
            assert_eq!(all.len(), (width * height) as usize, "{window:?}");
            assert!(all.iter().all(|[x, y]| (x0..x0 + width).contains(x) && (y0..y0 + height).contains(y)));
        }
    }
}
