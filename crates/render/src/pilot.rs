//! A look at the scene before the first pass: which part of it is visible, how wide a pixel is there, and how densely
//! photons fall. It steers radii and the aim of photons, and never enters an estimate.

use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use crate::camera::{CameraModel, uniform_disk};
use crate::caustic_plan::{self, CausticPlan};
use crate::control::{Cancelled, Observer};
use crate::counters::Counters;
use crate::light::{Anchor, Lights, SkyView, VisibleRegion, cosine_hemisphere};
use crate::photon_pass::{Keep, PhotonPass};
use crate::photon_window::PhotonWindow;
use crate::trace::Tracer;
use crate::twin::Twin;
use crate::usefulness;
use crate::world::World;
use photinus_geometry::{Frame, Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use photinus_photons::{BuildOptions, Photon, Search};
use rayon::prelude::*;

/// Points looked at along each axis of the picture.
const GRID: u32 = 128;
/// Cells whose rays are followed together.
const PART: u32 = 1024;
/// Most mirrors and clear surfaces before a visible point, and 1.
const MIRRORS: usize = 12;
/// Rays to the sky from each point, and clear surfaces that one may cross.
const SKY_RAYS: u32 = 3;
const CLEAR_SURFACES: u32 = 6;
/// Rays from each anchor to each light at infinity.
const OPEN_RAYS: u32 = 4;
/// Photons sent out by the pilot at most.
const PHOTONS: u32 = 50_000;
/// As many tell how many are stored.
const MEMORY_PHOTONS: u32 = 4000;
/// Neighbours whose distance measures density.
pub(crate) const NEIGHBORS: usize = 32;
/// Passes that look for the strength that photons should have.
const WINDOW_ROUNDS: u32 = 3;
/// Photons at which the density of the caustic map is measured.
const CAUSTIC_PROBES: usize = 1024;
/// Photons that an estimate of the first pass should find, for light after a diffuse bounce and for caustics.
const GLOBAL_TARGET: f32 = 60.0;
const CAUSTIC_TARGET: f32 = 30.0;

/// A point that the camera sees, directly or by mirrors and glass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VisiblePoint {
    pub position: Vec3,
    /// Face normal on the side that is seen.
    pub normal: Vec3,
    /// Width of a pixel there.
    pub width: f32,
    /// How far rays from there must start above the surface.
    pub lift: f32,
}

/// First radii of the maps, scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Radii {
    pub global: f32,
    pub caustic: f32,
}

/// What the pilot photons said.
pub(crate) struct PhotonOutlook {
    pub radii: Radii,
    /// Photons stored by a pass, in the global map and in the caustic map.
    pub stored: [u64; 2],
    /// Photons of their own for caustics, where those are seen.
    pub caustics: Option<CausticPlan>,
    /// How strong photons should be, where they are uneven.
    pub window: Option<PhotonWindow>,
}

/// Follows one ray for each cell of a grid over the picture to the first surface that keeps photons. Points seen directly
/// come first, then those seen by one mirror, and so on.
pub(crate) fn visible_points(world: &World, camera: &CameraModel, crop: [u32; 4], seed: u64) -> Vec<VisiblePoint> {
    let parts = (0..GRID * GRID).into_par_iter().step_by(PART as usize);
    let parts: Vec<_> = parts.map(|first| part_of_visible_points(world, camera, crop, seed, first)).collect();
    (0..MIRRORS).flat_map(|seen_by| parts.iter().flat_map(move |part| &part[seen_by])).copied().collect()
}

/// What the rays of [`PART`] cells from `first` find, by the mirrors on the way.
fn part_of_visible_points(
    world: &World,
    camera: &CameraModel,
    crop: [u32; 4],
    seed: u64,
    first: u32,
) -> [Vec<VisiblePoint>; MIRRORS] {
    let mut paths: Vec<(Ray, f32, f32, Sampler)> = (first..first + PART)
        .map(|i| {
            let mut sampler = Sampler::new(seed, StreamKind::Pilot, 1 << 40, i);
            let [dx, dy] = sampler.next_2d();
            let film = [
                crop[0] as f32 + ((i % GRID) as f32 + dx) / GRID as f32 * crop[2] as f32,
                crop[1] as f32 + ((i / GRID) as f32 + dy) / GRID as f32 * crop[3] as f32,
            ];
            let start = camera.ray(film, &mut sampler);
            (start.ray, start.width, start.spread, sampler)
        })
        .collect();
    let mut tracer = Tracer::new(world, Twin::OFF);
    let (mut rays, mut hits, mut bsdf) = (Vec::new(), Vec::new(), Bsdf::default());
    std::array::from_fn(|_| {
        rays.clear();
        rays.extend(paths.iter().map(|p| p.0));
        tracer.closest(&rays, &mut hits, &mut Counters::default(), |i| paths[i].3.next_1d());
        let (mut points, mut next) = (Vec::new(), Vec::new());
        for ((ray, width, spread, mut sampler), hit) in std::mem::take(&mut paths).into_iter().zip(&hits) {
            if !hit.is_hit() {
                continue;
            }
            let width = width + spread * hit.t;
            let point = world.surface(&ray, hit, width);
            let wo = -ray.dir;
            world.materials.resolve_into(world.shapes[point.shape as usize].material, &point, wo, &mut bsdf);
            if bsdf.has(LobeSet::GATHER) {
                let side = if point.geometric_normal.dot(wo) >= 0.0 { 1.0 } else { -1.0 };
                points.push(VisiblePoint {
                    position: point.position,
                    normal: point.geometric_normal * side,
                    width,
                    lift: point.position.abs().max_element() * 1e-5 + 0.01 * width,
                });
                continue;
            }
            sampler.start_vertex();
            let (choice, u) = (sampler.next_1d(), sampler.next_2d());
            if let Some(s) = bsdf.sample(LobeSet::CONTINUE, choice, u, TransportMode::Radiance) {
                next.push((Ray::new(point.ray_origin(s.wi), s.wi), width, spread, sampler));
            }
        }
        paths = next;
        points
    })
}

/// Which directions of the sky the visible points see, straight or through clear surfaces.
pub(crate) fn sky_view(world: &World, points: &[VisiblePoint], seed: u64) -> SkyView {
    let mut view = SkyView::new();
    let (mut rays, mut samplers): (Vec<Ray>, Vec<Sampler>) = (Vec::new(), Vec::new());
    for (i, point) in points.iter().enumerate() {
        let frame = Frame::from_normal(point.normal);
        for j in 0..SKY_RAYS {
            let mut sampler = Sampler::new(seed, StreamKind::Pilot, 2 << 40, i as u32 * SKY_RAYS + j);
            let (local, _) = cosine_hemisphere(sampler.next_2d());
            rays.push(Ray::new(point.position + point.normal * point.lift, frame.to_world(local)));
            samplers.push(sampler);
        }
    }
    follow_clear(world, rays, samplers, |_, dir, end| match end {
        End::Sky => view.add(dir, true),
        End::Lamp => view.add_lamp(),
        End::Surface => view.add(dir, false),
    });
    view
}

/// For each anchor and each light at infinity, the share of rays from the anchor's disc that reach the light, straight or
/// through clear surfaces.
pub(crate) fn openness(world: &World, lights: &Lights, anchors: &[Anchor], seed: u64) -> Vec<Vec<f64>> {
    let items = lights.far_items();
    let (mut rays, mut samplers, mut owners) = (Vec::new(), Vec::new(), Vec::new());
    for (a, anchor) in anchors.iter().enumerate() {
        for item in (0..items).filter(|&item| lights.far_share(item) > 0.0) {
            for i in 0..OPEN_RAYS {
                let stream = 5 << 40 | (a as u64) << 20 | item as u64;
                let mut sampler = Sampler::new(seed, StreamKind::Pilot, stream, i);
                let (place, way, choice) = (sampler.next_2d(), sampler.next_2d(), sampler.next_1d());
                let Some((dir, ..)) = lights.look_far(item, choice, way) else { continue };
                let frame = Frame::from_normal(dir);
                let [x, y] = uniform_disk(place);
                let origin = anchor.center + (frame.s * x + frame.t * y) * anchor.radius;
                rays.push(Ray::new(origin, dir));
                samplers.push(sampler);
                owners.push([a, item]);
            }
        }
    }
    let mut open = vec![vec![0.0; items]; anchors.len()];
    follow_clear(world, rays, samplers, |ray, _, end| {
        if end == End::Sky {
            let [anchor, item] = owners[ray];
            open[anchor][item] += 1.0 / f64::from(OPEN_RAYS);
        }
    });
    open
}

/// Where a ray through clear surfaces ends.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    Sky,
    Lamp,
    Surface,
}

/// Follows rays straight on through clear surfaces; `found` gets the number of each that ends, its direction, and where.
fn follow_clear(
    world: &World,
    mut rays: Vec<Ray>,
    mut samplers: Vec<Sampler>,
    mut found: impl FnMut(usize, Vec3, End),
) {
    let mut tracer = Tracer::new(world, Twin::OFF);
    let mut numbers: Vec<usize> = (0..rays.len()).collect();
    let mut hits = Vec::new();
    for _ in 0..CLEAR_SURFACES {
        tracer.closest(&rays, &mut hits, &mut Counters::default(), |i| samplers[i].next_1d());
        let (mut next, mut next_samplers, mut next_numbers) = (Vec::new(), Vec::new(), Vec::new());
        for (slot, (ray, hit)) in rays.iter().zip(&hits).enumerate() {
            if !hit.is_hit() {
                found(numbers[slot], ray.dir, End::Sky);
                continue;
            }
            let point = world.surface(ray, hit, 0.0);
            if world.emitted(&point, -ray.dir) != Vec3::ZERO {
                found(numbers[slot], ray.dir, End::Lamp);
                continue;
            }
            let bsdf = world.materials.resolve(world.shapes[point.shape as usize].material, &point, -ray.dir);
            if bsdf.has(LobeSet::DELTA_TRANSMISSION) {
                next.push(Ray::new(point.ray_origin(ray.dir), ray.dir));
                next_samplers.push(samplers[slot].clone());
                next_numbers.push(numbers[slot]);
            } else {
                found(numbers[slot], ray.dir, End::Surface);
            }
        }
        (rays, samplers, numbers) = (next, next_samplers, next_numbers);
    }
}

/// The sphere around the nearer part of what is visible, which fills most of the picture: a plane that runs to the
/// horizon does not thin out the photons where they are looked at. Around everything where nothing is visible, or where
/// that is most of the scene.
pub(crate) fn visible_region(world: &World, points: &[VisiblePoint]) -> VisibleRegion {
    let bounds = world.bounds();
    let whole = if bounds.is_empty() {
        VisibleRegion { center: Vec3::ZERO, radius: 1.0 }
    } else {
        VisibleRegion { center: bounds.center(), radius: (0.5 * bounds.diagonal()).max(1e-6) }
    };
    if points.len() < 16 {
        return whole;
    }
    let middle = |axis: usize| {
        let mut values: Vec<f32> = points.iter().map(|p| p.position[axis]).collect();
        let middle = values.len() / 2;
        *values.select_nth_unstable_by(middle, f32::total_cmp).1
    };
    let center = Vec3::new(middle(0), middle(1), middle(2));
    let mut distances: Vec<f32> = points.iter().map(|p| (p.position - center).length()).collect();
    let most = distances.len() * 6 / 10;
    let radius = *distances.select_nth_unstable_by(most, f32::total_cmp).1 * 1.1;
    if radius > 0.7 * whole.radius || !(radius > 0.0) { whole } else { VisibleRegion { center, radius } }
}

/// The pilot's own photons: those of `pass`, fewer and not aimed.
fn pilot_pass(pass: PhotonPass, photons: u32) -> PhotonPass {
    let count = photons.min(PHOTONS);
    PhotonPass {
        kind: StreamKind::Pilot,
        pass: 0,
        count,
        guide: None,
        together: None,
        window: None,
        profile_every: 0,
        ..pass
    }
}

/// Ways of photons from infinity that light what is seen, of a pass of `photons`; each with what it is worth.
pub(crate) fn useful_rays(
    world: &World,
    lights: &Lights,
    points: &[VisiblePoint],
    pass: PhotonPass,
    photons: u32,
    observer: &dyn Observer,
) -> Result<Vec<(Ray, f64)>, Cancelled> {
    let pilot = PhotonPass { pass: pass.pass, ..pilot_pass(pass, photons) };
    let (stored, _) = pilot.run(world, lights, observer)?;
    Ok(usefulness::useful_rays(world, lights, points, &pilot, stored))
}

/// What the photons of a pilot pass say about radii and memory, for `photons` photons a pass. Where the user gives the
/// `radius` and no photons are aimed, only memory is asked about.
pub(crate) fn photon_outlook(
    world: &World,
    lights: &Lights,
    points: &[VisiblePoint],
    pass: PhotonPass,
    photons: u32,
    radius: Option<f32>,
    observer: &dyn Observer,
) -> Result<PhotonOutlook, Cancelled> {
    let radius = radius.map(|radius| Radii { global: radius, caustic: radius });
    let keeps_all = matches!(pass.keep, Keep::All | Keep::AllApart);
    let only_memory = radius.filter(|_| keeps_all);
    let count = photons.min(if only_memory.is_some() { MEMORY_PHOTONS } else { PHOTONS });
    let pilot = PhotonPass { count, ..pilot_pass(pass, photons) };
    let (mut stored, mut counters) = pilot.run(world, lights, observer)?;
    let mut window = match pass.keep {
        Keep::Indirect => PhotonWindow::learn(world, lights.region(), points, &stored.global, pass.seed),
        Keep::All | Keep::AllApart | Keep::Caustic => None,
    };
    for _ in 0..WINDOW_ROUNDS {
        let Some(wanted) = &window else { break };
        (stored, counters) = PhotonPass { window: Some(wanted), ..pilot }.run(world, lights, observer)?;
        match wanted.eased(counters.photons.split, count) {
            Some(eased) => window = Some(eased),
            None => break,
        }
    }
    let per_pass = |stored: u64| (stored as f64 * f64::from(photons) / f64::from(count.max(1))) as u64;
    let counted = counters.photons;
    let stored_plain = [per_pass(counted.stored - counted.stored_caustic), per_pass(counted.stored_caustic)];
    if let Some(radii) = only_memory {
        return Ok(PhotonOutlook { radii, stored: stored_plain, caustics: None, window });
    }
    let global_search = search(std::mem::take(&mut stored.global));
    let scale = |target: f32| (target / NEIGHBORS as f32 * count as f32 / photons as f32).sqrt();
    let width = median(points.iter().map(|p| p.width)).unwrap_or(0.0);
    let fallback = 0.02 * lights.region().radius;
    let positions: Vec<Vec3> = points.iter().map(|p| p.position).collect();
    let global = typical_distance(&positions, global_search.as_deref(), 0.5).map(|r| r * scale(GLOBAL_TARGET));
    let global = global.unwrap_or(fallback).max(width).max(1e-9);
    if keeps_all {
        return Ok(PhotonOutlook {
            radii: Radii { global, caustic: global },
            stored: stored_plain,
            caustics: None,
            window,
        });
    }
    let global_search = global_search.as_deref();
    if let Some(plan) = caustic_plan::plan(world, lights, points, pilot, &stored, global_search, photons, observer)? {
        // Where a caustic is as smooth as the rest it needs no wider radius than that.
        let radii = radius.unwrap_or(Radii { global, caustic: plan.radius.min(global) });
        let own = (f64::from(plan.stored) * f64::from(plan.count)) as u64;
        let stored = [stored_plain[0], stored_plain[1] + own];
        return Ok(PhotonOutlook { radii, stored, caustics: Some(plan), window });
    }
    let probes = spread(&stored.caustic);
    let caustic = typical_distance(&probes, search(stored.caustic).as_deref(), 0.5).map(|r| r * scale(CAUSTIC_TARGET));
    let caustic = caustic.unwrap_or(global).clamp((0.7 * width).min(global), global);
    let radii = radius.unwrap_or(Radii { global, caustic });
    Ok(PhotonOutlook { radii, stored: stored_plain, caustics: None, window })
}

/// A search over pilot photons; none where they are few.
fn search(photons: Vec<Photon>) -> Option<Box<dyn Search>> {
    if photons.len() < NEIGHBORS * 2 {
        return None;
    }
    photinus_photons::build(photinus_photons::DEFAULT_SEARCH, photons, &BuildOptions::default()).ok()
}

/// Positions of evenly chosen photons.
fn spread(photons: &[Photon]) -> Vec<Vec3> {
    let step = (photons.len() / CAUSTIC_PROBES).max(1);
    photons.iter().step_by(step).map(Photon::position).collect()
}

/// Quantile of the distance to the farthest of [`NEIGHBORS`] photons, over `positions`; none where photons are few.
fn typical_distance(positions: &[Vec3], search: Option<&dyn Search>, quantile: f32) -> Option<f32> {
    let search = search?;
    if positions.is_empty() {
        return None;
    }
    let mut found = Vec::new();
    let mut distances: Vec<f32> = positions
        .iter()
        .map(|&position| {
            search.nearest(position, NEIGHBORS, f32::INFINITY, &mut found);
            found.last().map_or(0.0, |n| n.distance_sq.sqrt())
        })
        .collect();
    distances.sort_unstable_by(f32::total_cmp);
    let distance = distances[((distances.len() - 1) as f32 * quantile) as usize];
    (distance > 0.0 && distance.is_finite()).then_some(distance)
}

pub(crate) fn median(values: impl Iterator<Item = f32>) -> Option<f32> {
    let mut values: Vec<f32> = values.collect();
    values.sort_unstable_by(f32::total_cmp);
    values.get(values.len() / 2).copied()
}
