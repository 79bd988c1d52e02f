//! The photon pass: photons leave the lights, scatter, and are stored where they land (thesis, Figure 3: FirePhoton,
//! StorePhoton).

use crate::SurfacePoint;
use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use crate::control::{Cancelled, Observer};
use crate::counters::{Counters, timed};
use crate::light::{EmissionGuide, EmissionPoint, Lights, VisibleRegion};
use crate::photon_window::PhotonWindow;
use crate::recording::NOT_YET;
use crate::trace::Tracer;
use crate::twin::{Queries, Twin};
use crate::world::World;
use photinus_geometry::{Frame, Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use photinus_photons::Photon;
use photinus_profile::queries::{BlockKey, RayKind, Stage};
use rayon::prelude::*;
use std::f32::consts::TAU;
use std::sync::atomic::{AtomicU64, Ordering};

/// Photons of one batch; fixed, so that batches do not depend on the machine.
const CHUNK: u32 = 2048;

/// Batches of each thread between two appendings to the lists: what is held twice stays small. Photons do not depend on
/// it.
const GROUP: usize = 32;

/// More parts than a photon is split into at once, and lineages that split no further: their numbers fit 32 bits.
const LARGEST_FAMILY: u32 = 128;
const MOST_LINEAGES: u32 = u32::MAX / LARGEST_FAMILY - 1;

/// Which photons are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keep {
    /// All of them, in one map: estimates give all of the light.
    All,
    /// All of them, those that came by mirror-like bounces only in the caustic map, all others in the global map.
    AllApart,
    /// Those whose light no shadow ray finds: after a diffuse bounce in the global map, after mirror-like bounces only
    /// in the caustic map.
    Indirect,
    /// The caustic map alone: photons end where they can no longer belong to it.
    Caustic,
}

/// One photon pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PhotonPass<'g> {
    pub seed: u64,
    pub kind: StreamKind,
    pub pass: u32,
    pub count: u32,
    /// Most edges of a photon's path.
    pub max_depth: u32,
    pub keep: Keep,
    /// Photons straight from lights are stored, too, in a list of their own.
    pub keeps_direct: bool,
    /// Where photons are worth starting; none: as the lights shine.
    pub guide: Option<&'g EmissionGuide>,
    /// The caustic map is filled by this pass and another one.
    pub together: Option<Together<'g>>,
    /// How strong photons should be that go on from diffuse surfaces; none: as they are.
    pub window: Option<&'g PhotonWindow>,
    /// One ray in this many is counted, see [`Twin`].
    pub profile_every: u32,
}

/// Two passes that fill one caustic map: one whose photons start as the lights shine, one of aimed photons. Each photon
/// counts over the density with which both of them start photons where it started (the balance heuristic of Veach 1997,
/// section 9.2.2), so that no photon of the map is stronger than an unaimed one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Together<'g> {
    pub guide: &'g EmissionGuide,
    /// Photons of the two passes.
    pub plain: u32,
    pub aimed: u32,
}

impl Together<'_> {
    /// Weight of a photon of a pass that sends out `count` with `density`, started where the guide's density is `aimed`.
    fn weight(&self, count: u32, density: f32, aimed: f32) -> f32 {
        let own = f64::from(count) * f64::from(density);
        (own / (f64::from(self.plain) + f64::from(self.aimed) * f64::from(aimed))) as f32
    }
}

/// Stored photons, in the order of emission.
#[derive(Default)]
pub(crate) struct StoredPhotons {
    pub global: Vec<Photon>,
    pub caustic: Vec<Photon>,
    /// Straight from lights, where those are kept.
    pub direct: Vec<Photon>,
    /// Which photon of the pass each one is, global and caustic; kept by the pilot only.
    pub origins: Vec<u32>,
    pub caustic_origins: Vec<u32>,
}

#[derive(Clone)]
struct Walk {
    index: u32,
    /// Density of its start, over that of an unaimed one.
    density: f32,
    ray: Ray,
    flux: Vec3,
    depth: u32,
    /// Every bounce so far was mirror-like.
    specular_only: bool,
    sampler: Sampler,
    /// Record of the latest ray.
    record: u32,
    /// Which part of which part of its photon it is; 0: the first of all.
    lineage: u32,
}

/// What photons of a batch use one after the other.
#[derive(Default)]
struct Scratch {
    bsdf: Bsdf,
    /// Parts of strong photons, beyond the first, that go on.
    born: Vec<Walk>,
}

impl PhotonPass<'_> {
    /// Sends out the photons. Equal arguments give equal photons in equal order on any number of threads.
    pub fn run(
        &self,
        world: &World,
        lights: &Lights,
        observer: &dyn Observer,
    ) -> Result<(StoredPhotons, Counters), Cancelled> {
        let chunks = self.count.div_ceil(CHUNK);
        let group = GROUP * rayon::current_num_threads();
        let done = AtomicU64::new(0);
        let mut all = StoredPhotons::default();
        let mut counters = Counters::default();
        for first in (0..chunks).step_by(group) {
            let last = chunks.min(first.saturating_add(group as u32));
            let results: Vec<Option<(StoredPhotons, Counters)>> = (first..last)
                .into_par_iter()
                .map(|chunk| {
                    if observer.cancelled() {
                        return None;
                    }
                    let result = self.chunk(world, lights, chunk);
                    observer.progress(done.fetch_add(1, Ordering::Relaxed) + 1, u64::from(chunks));
                    Some(result)
                })
                .collect();
            let results = results.into_iter().collect::<Option<Vec<_>>>().ok_or(Cancelled)?;
            if first == 0 {
                // The first group says what the others will add; a hundredth more is seldom needed.
                let share = 1.0 + f64::from(chunks - last) / f64::from(last) * 1.01;
                let room = |of: fn(&StoredPhotons) -> usize| {
                    (results.iter().map(|(photons, _)| of(photons)).sum::<usize>() as f64 * share) as usize
                };
                all.global.reserve_exact(room(|photons| photons.global.len()));
                all.caustic.reserve_exact(room(|photons| photons.caustic.len()));
            }
            for (photons, c) in results {
                all.global.extend_from_slice(&photons.global);
                all.caustic.extend_from_slice(&photons.caustic);
                all.direct.extend_from_slice(&photons.direct);
                all.origins.extend_from_slice(&photons.origins);
                all.caustic_origins.extend_from_slice(&photons.caustic_origins);
                counters += c;
            }
        }
        if self.keep == Keep::Caustic {
            counters.caustic_photons = std::mem::take(&mut counters.photons);
        }
        Ok((all, counters))
    }

    /// Where photon `index` starts, the density of its start over that of an unaimed one, and the rest of its random
    /// numbers.
    pub fn start(&self, index: u32) -> (EmissionPoint, f32, Sampler) {
        let mut sampler = Sampler::new(self.seed, self.kind, u64::from(self.pass), index);
        let point = EmissionPoint::draw(&mut sampler);
        let (point, density) = self.guide.map_or((point, 1.0), |guide| guide.aim(point));
        (point, density, sampler)
    }

    fn chunk(&self, world: &World, lights: &Lights, chunk: u32) -> (StoredPhotons, Counters) {
        let mut stored = StoredPhotons::default();
        let mut counters = Counters::default();
        let mut tracer = Tracer::new(world, Twin::new(self.profile_every, Queries::PhotonRays, self.pass, chunk));
        if self.kind != StreamKind::Pilot {
            let further = if self.kind == StreamKind::Photon { 0 } else { 1 << 31 };
            tracer = tracer.record(BlockKey { pass: self.pass, stage: Stage::PhotonPass, index: chunk + further });
        }
        let first = chunk * CHUNK;
        let mut walks = Vec::with_capacity(CHUNK as usize);
        for index in first..(first + CHUNK).min(self.count) {
            let (point, density, sampler) = self.start(index);
            counters.photons.emitted += 1;
            if let Some(start) = lights.emit(world, &point) {
                let flux = start.flux / (density * self.count as f32);
                add(&mut counters.photons.power.emitted, flux);
                walks.push(Walk {
                    index,
                    density,
                    ray: start.ray,
                    flux,
                    depth: 0,
                    specular_only: true,
                    sampler,
                    record: NOT_YET,
                    lineage: 0,
                });
            }
        }
        counters.rays.emitted += walks.len() as u64;
        let (mut rays, mut hits) = (Vec::new(), Vec::new());
        let mut scratch = Scratch::default();
        while !walks.is_empty() {
            rays.clear();
            rays.extend(walks.iter().map(|w| w.ray));
            counters.rays.photon += rays.len() as u64;
            tracer.ask(walks.iter().map(|w| (RayKind::Photon, w.record)));
            tracer.closest(&rays, &mut hits, &mut counters, |i| walks[i].sampler.next_1d());
            let mut slot = 0;
            let mut surfaces = 0;
            let mut land = |walk: &mut Walk| {
                let hit = hits[slot];
                walk.record = tracer.record_of(slot);
                slot += 1;
                if !hit.is_hit() {
                    counters.photons.escaped += 1;
                    add(&mut counters.photons.power.escaped, walk.flux);
                    return false;
                }
                // A caustic needs a mirror first.
                let is_diffuse = || world.materials.is_diffuse(world.shapes[world.shape_of(hit.prim)].material);
                if self.keep == Keep::Caustic && walk.depth == 0 && is_diffuse() {
                    counters.photons.absorbed += 1;
                    add(&mut counters.photons.power.absorbed, walk.flux);
                    return false;
                }
                let point = world.surface(&walk.ray, &hit, 0.0);
                self.land(world, lights, walk, &point, &mut scratch, &mut stored, &mut counters)
            };
            timed(self.profile_every > 0, &mut surfaces, || walks.retain_mut(&mut land));
            walks.append(&mut scratch.born);
            counters.spent.surfaces += surfaces;
        }
        tracer.finish();
        (stored, counters)
    }

    /// What a photon does where it lands: it may be stored, and goes on or ends, or goes on as several, of which the others are
    /// born. Returns whether it goes on.
    fn land(
        &self,
        world: &World,
        lights: &Lights,
        walk: &mut Walk,
        point: &SurfacePoint,
        Scratch { bsdf, born }: &mut Scratch,
        stored: &mut StoredPhotons,
        counters: &mut Counters,
    ) -> bool {
        walk.depth += 1;
        walk.sampler.start_vertex();
        let wo = -walk.ray.dir;
        world.materials.resolve_into(world.shapes[point.shape as usize].material, point, wo, bsdf);
        if bsdf.has(LobeSet::GATHER) {
            self.store(walk, point, wo, bsdf, stored, counters);
        }
        if walk.depth >= self.max_depth {
            counters.photons.cut += 1;
            add(&mut counters.photons.power.cut, walk.flux);
            return false;
        }
        if self.keep == Keep::Caustic && !bsdf.has(LobeSet::CONTINUE) {
            counters.photons.absorbed += 1;
            add(&mut counters.photons.power.absorbed, walk.flux);
            return false;
        }
        let window = self.window.filter(|_| bsdf.has(LobeSet::GATHER));
        let parts = window.map_or(1, |window| self.split(window, walk, point.position, counters));
        let strength =
            window.filter(|window| window.contains(point.position)).map(|window| window.strength(self.count));
        for part in 1..parts {
            let lineage = walk.lineage * LARGEST_FAMILY + part;
            let stream = u64::from(lineage) << 32 | u64::from(self.pass);
            let sampler = Sampler::new(self.seed, self.kind, stream, walk.index);
            let mut other = Walk { sampler, lineage, ..walk.clone() };
            if self.scatter(lights, &mut other, point, bsdf, strength, counters) {
                born.push(other);
            }
        }
        self.scatter(lights, walk, point, bsdf, strength, counters)
    }

    /// Makes a photon the first of several, each of so much less flux; returns how many.
    fn split(&self, window: &PhotonWindow, walk: &mut Walk, position: Vec3, counters: &mut Counters) -> u32 {
        let mean = window.parts(walk.flux.max_element(), self.count, position);
        if !(mean > 1.0) || walk.lineage >= MOST_LINEAGES {
            return 1;
        }
        let parts = (mean + walk.sampler.next_1d()) as u32;
        let before = walk.flux;
        walk.flux /= mean;
        // What chance adds or takes.
        add(&mut counters.photons.power.absorbed, before - walk.flux * parts as f32);
        counters.photons.split += u64::from(parts - 1);
        parts
    }

    /// Lets a photon go on from a surface, or end there. Where a `strength` is wanted, it is brought up to that.
    fn scatter(
        &self,
        lights: &Lights,
        walk: &mut Walk,
        point: &SurfacePoint,
        bsdf: &Bsdf,
        strength: Option<f32>,
        counters: &mut Counters,
    ) -> bool {
        let choice = walk.sampler.next_1d();
        let survival = walk.sampler.next_1d();
        let u = walk.sampler.next_2d();
        let far = lights.aims() && outside(lights.region(), point.position) && bsdf.has(LobeSet::NON_DELTA);
        let sample = if far {
            guided_sample(bsdf, lights.region(), point.position, choice, u)
        } else {
            bsdf.sample(LobeSet::ALL, choice, u, TransportMode::Importance)
                .map(|s| (s.wi, s.weight, s.kind.intersects(LobeSet::CONTINUE)))
        };
        // Photons for caustics alone scatter as all others, so that both agree on what is a caustic.
        let sample = sample.filter(|&(.., specular)| specular || self.keep != Keep::Caustic);
        let Some((wi, weight, specular)) = sample else {
            counters.photons.absorbed += 1;
            add(&mut counters.photons.power.absorbed, walk.flux);
            return false;
        };
        let outgoing = walk.flux * weight;
        // Survival keeps the largest channel of the flux, or brings it up to what is wanted, so that all photons weigh about the
        // same.
        let kept = strength.filter(|_| !specular).unwrap_or_else(|| walk.flux.max_element());
        let keep = (outgoing.max_element() / kept.max(1e-30)).min(1.0);
        if !(survival < keep) {
            counters.photons.absorbed += 1;
            add(&mut counters.photons.power.absorbed, walk.flux);
            return false;
        }
        let outgoing = outgoing / keep;
        add(&mut counters.photons.power.absorbed, walk.flux - outgoing);
        walk.flux = outgoing;
        walk.specular_only &= specular;
        walk.ray = Ray::new(point.ray_origin(wi), wi);
        true
    }

    fn store(
        &self,
        walk: &Walk,
        point: &SurfacePoint,
        wo: Vec3,
        bsdf: &Bsdf,
        stored: &mut StoredPhotons,
        counters: &mut Counters,
    ) {
        let caustic = walk.specular_only && walk.depth > 1;
        let wanted = match self.keep {
            Keep::All | Keep::AllApart => true,
            Keep::Indirect => walk.depth > 1 || self.keeps_direct,
            Keep::Caustic => caustic,
        };
        if !wanted {
            return;
        }
        // A density counts flux over the face; scattering is defined over the shading normal. Their ratio here lets
        // the estimate agree with a path tracer on smooth meshes (Veach 1997, section 5.3); its limit bounds noise.
        let facing = point.geometric_normal.dot(wo);
        let normal = if facing >= 0.0 { point.geometric_normal } else { -point.geometric_normal };
        let shading = bsdf.shading_normal();
        let ratio = if shading == normal { 1.0 } else { (shading.dot(wo) / facing).abs().min(8.0) };
        let weight = match self.together {
            Some(both) if caustic => {
                let aimed = match self.guide {
                    Some(_) => walk.density,
                    None => both.guide.density(&self.start(walk.index).0),
                };
                both.weight(self.count, walk.density, aimed)
            }
            _ => 1.0,
        };
        let arriving = walk.flux * weight;
        let flux = arriving * if ratio.is_finite() { ratio } else { 1.0 };
        let Ok(photon) = Photon::new(point.position, flux, wo, normal, walk.depth, caustic) else {
            return;
        };
        if walk.depth == 1 && self.keeps_direct {
            stored.direct.push(photon);
            return;
        }
        add(&mut counters.photons.power.stored, arriving);
        counters.photons.stored += 1;
        if caustic && self.keep != Keep::All {
            counters.photons.stored_caustic += 1;
            if self.kind == StreamKind::Pilot {
                stored.caustic_origins.push(walk.index);
            }
            stored.caustic.push(photon);
        } else {
            if self.kind == StreamKind::Pilot {
                stored.origins.push(walk.index);
            }
            stored.global.push(photon);
        }
    }
}

fn outside(region: VisibleRegion, position: Vec3) -> bool {
    (position - region.center).length_squared() > region.radius * region.radius
}

/// Scatters a photon that landed far outside the visible region: half of the time towards the region, so that the
/// powerful photons out there come back weak and many instead of strong and rare.
fn guided_sample(
    bsdf: &Bsdf,
    region: VisibleRegion,
    position: Vec3,
    choice: f32,
    u: [f32; 2],
) -> Option<(Vec3, Vec3, bool)> {
    let target = photinus_geometry::Sphere { center: region.center, radius: region.radius };
    let mode = TransportMode::Importance;
    let Some(one_minus_cos) = crate::light::sphere_cone(&target, position) else {
        let s = bsdf.sample(LobeSet::ALL, choice, u, mode)?;
        return Some((s.wi, s.weight, s.kind.intersects(LobeSet::CONTINUE)));
    };
    let cone_pdf = 1.0 / (TAU * one_minus_cos);
    let axis = (region.center - position).normalize();
    let in_cone = |wi: Vec3| wi.dot(axis) >= 1.0 - one_minus_cos;
    if choice < 0.5 {
        let wi = Frame::from_normal(axis).to_world(crate::light::uniform_cone(u, one_minus_cos));
        let pdf = 0.5 * cone_pdf + 0.5 * bsdf.pdf(LobeSet::ALL, wi);
        let value = bsdf.eval(LobeSet::ALL, wi, mode);
        (value.max_element() > 0.0).then(|| (wi, value / pdf, false))
    } else {
        let s = bsdf.sample(LobeSet::ALL, 2.0 * choice - 1.0, u, mode)?;
        let specular = s.kind.intersects(LobeSet::CONTINUE);
        if s.kind.intersects(LobeSet::DELTA) {
            return Some((s.wi, s.weight * 2.0, specular));
        }
        let pdf = 0.5 * s.pdf + if in_cone(s.wi) { 0.5 * cone_pdf } else { 0.0 };
        Some((s.wi, s.weight * (s.pdf / pdf), specular))
    }
}

fn add(sum: &mut [f64; 3], flux: Vec3) {
    for (s, f) in sum.iter_mut().zip(flux.to_array()) {
        *s += f64::from(f);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::SurfaceModel;
    use crate::control::Silent;
    use crate::light::SkyView;
    use crate::world::Compiled;

    /// Two maps hold together what one map holds: each photon once, word for word.
    #[test]
    fn maps_apart_hold_every_photon_once() {
        let compiled = Compiled::new(photinus_scene::builtin::build("two-spheres").expect("it is built in"));
        let options = photinus_accel::BuildOptions::default();
        let structure =
            photinus_accel::build("wide-bvh", compiled.primitives().clone(), &options).expect("a small scene");
        let world = compiled.with_structure(structure, SurfaceModel::Physical);
        let region = VisibleRegion { center: Vec3::splat(2.75), radius: 5.0 };
        let mut lights = Lights::new(&world, region, &SkyView::new());
        lights.begin_pass(7, 0);
        let pass = |keep| PhotonPass {
            seed: 7,
            kind: StreamKind::Photon,
            pass: 0,
            count: 10_000,
            keeps_direct: false,
            max_depth: 127,
            keep,
            guide: None,
            together: None,
            window: None,
            profile_every: 0,
        };
        let stored = |keep| pass(keep).run(&world, &lights, &Silent).expect("nothing stops it");
        let ((one, counted), (two, counted_apart)) = (stored(Keep::All), stored(Keep::AllApart));
        let words = |photons: &[&[Photon]]| {
            let mut words: Vec<_> = photons.iter().copied().flatten().map(Photon::to_words).collect();
            words.sort_unstable();
            words
        };
        assert!(one.caustic.is_empty() && two.caustic.len() > 100 && two.global.len() > 5000, "seed 7");
        assert_eq!(words(&[&one.global]), words(&[&two.global, &two.caustic]), "seed 7");
        assert!(two.caustic.iter().all(Photon::is_caustic) && !two.global.iter().any(Photon::is_caustic), "seed 7");
        assert_eq!(counted.photons.power, counted_apart.photons.power, "seed 7");
        assert_eq!(counted_apart.photons.stored_caustic, two.caustic.len() as u64, "seed 7");
    }
}
