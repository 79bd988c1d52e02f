//! Batches of ray queries, surfaces that let light through taken into account.

use crate::SurfacePoint;
use crate::counters::{Counters, timed};
use crate::recording::{NOT_YET, Recording};
use crate::twin::Twin;
use crate::world::World;
use photinus_accel::RayCounters;
use photinus_geometry::{Hit, Ray, Vec3};
use photinus_profile::queries::{BlockKey, RayKind, SearchRecord};
use photinus_profile::undisturbed;

/// Most holes that one ray passes: stacks of leaves are shallow, broken scenes are not.
const MAX_HOLES: u32 = 1024;

/// Answers queries of one batch and counts them.
pub(crate) struct Tracer<'w> {
    world: &'w World,
    twin: Twin,
    recording: Option<Recording<'w>>,
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    blocked: Vec<bool>,
    pending: Vec<usize>,
}

impl<'w> Tracer<'w> {
    pub fn new(world: &'w World, twin: Twin) -> Self {
        Self {
            world,
            twin,
            recording: None,
            rays: Vec::new(),
            hits: Vec::new(),
            blocked: Vec::new(),
            pending: Vec::new(),
        }
    }

    /// Records the queries from now on under `key`, where the world is recorded.
    pub fn record(mut self, key: BlockKey) -> Self {
        self.recording = self.world.recorder.as_deref().map(|sink| Recording::new(sink, key));
        self
    }

    /// Says for each ray of the next query what it is for, and the record of the ray that led to it.
    pub fn ask(&mut self, askers: impl Iterator<Item = (RayKind, u32)>) {
        if let Some(recording) = &mut self.recording {
            recording.ask(askers);
        }
    }

    /// The record of ray `i` of the latest query, once it has been answered.
    pub fn record_of(&self, i: usize) -> u32 {
        self.recording.as_ref().map_or(NOT_YET, |recording| recording.latest(i))
    }

    /// Whether queries are recorded.
    pub fn records(&self) -> bool {
        self.recording.is_some()
    }

    /// Records searches of these paths.
    pub fn record_searches(&mut self, searches: &mut Vec<SearchRecord>) {
        if let Some(recording) = &mut self.recording {
            recording.searches(searches);
        }
    }

    /// Hands over what was recorded.
    pub fn finish(self) {
        if let Some(recording) = self.recording {
            recording.finish();
        }
    }

    /// The nearest hits of rays, whatever they are on. `numbers` are the rays' in the query that was asked.
    fn nearest(
        &mut self,
        rays: &[Ray],
        hits: &mut Vec<Hit>,
        numbers: impl Iterator<Item = usize>,
        counters: &mut Counters,
    ) {
        hits.clear();
        hits.resize(rays.len(), Hit::MISS);
        let structure = &self.world.structure;
        timed(self.twin.is_on(), &mut counters.spent.rays, || {
            for (run, counted) in self.twin.runs(rays.len()) {
                let (rays, hits) = (&rays[run.clone()], &mut hits[run]);
                if counted {
                    steady(&mut counters.sampled_rays, |work| structure.closest_hit_counted(rays, hits, work));
                } else {
                    structure.closest_hit(rays, hits);
                }
            }
        });
        if let Some(recording) = &mut self.recording {
            recording.closest(rays, hits, numbers);
        }
    }

    /// The same for the rays that are still on their way.
    fn closest_batch(&mut self, counters: &mut Counters) {
        let (rays, mut hits) = (std::mem::take(&mut self.rays), std::mem::take(&mut self.hits));
        let pending = std::mem::take(&mut self.pending);
        self.nearest(&rays, &mut hits, pending.iter().copied(), counters);
        (self.rays, self.hits, self.pending) = (rays, hits, pending);
    }

    fn any_batch(&mut self, rays: &[Ray], counters: &mut Counters) {
        self.blocked.clear();
        self.blocked.resize(rays.len(), false);
        let structure = &self.world.structure;
        timed(self.twin.is_on(), &mut counters.spent.rays, || {
            for (run, counted) in self.twin.runs(rays.len()) {
                let (rays, blocked) = (&rays[run.clone()], &mut self.blocked[run]);
                if counted {
                    steady(&mut counters.sampled_rays, |work| structure.any_hit_counted(rays, blocked, work));
                } else {
                    structure.any_hit(rays, blocked);
                }
            }
        });
        if let Some(recording) = &mut self.recording {
            recording.any(rays, &self.blocked);
        }
    }

    /// The nearest hit of each ray on a surface that stops it. `draw(i)` gives a random number of ray `i`, asked for
    /// only where its hit is partly transparent.
    pub fn closest(
        &mut self,
        rays: &[Ray],
        hits: &mut Vec<Hit>,
        counters: &mut Counters,
        mut draw: impl FnMut(usize) -> f32,
    ) {
        if !self.world.passes_light {
            return self.nearest(rays, hits, 0..rays.len(), counters);
        }
        self.rays.clear();
        self.rays.extend_from_slice(rays);
        self.pending.clear();
        self.pending.extend(0..rays.len());
        self.closest_batch(counters);
        hits.clear();
        hits.extend_from_slice(&self.hits);
        for _ in 0..MAX_HOLES {
            let (mut next, mut retry) = (Vec::new(), Vec::new());
            for (slot, &i) in self.pending.iter().enumerate() {
                let hit = self.hits[slot];
                hits[i] = hit;
                if !hit.is_hit() || self.world.stops_light(hit.prim) {
                    continue;
                }
                let point = self.world.surface(&rays[i], &hit, 0.0);
                let through = self.world.transparency(&point);
                if through > 0.0 && draw(i) < through {
                    next.push(i);
                    retry.push(beyond(&self.rays[slot], &hit, &point));
                    hits[i] = Hit::MISS;
                }
            }
            if next.is_empty() {
                return;
            }
            (self.pending, self.rays) = (next, retry);
            counters.rays.beyond += self.rays.len() as u64;
            self.closest_batch(counters);
        }
    }

    /// Share of light that passes along each ray, 0 to 1: `visible` gets one number a ray.
    pub fn visibility(&mut self, rays: &[Ray], visible: &mut Vec<f32>, counters: &mut Counters) {
        visible.clear();
        if !self.world.passes_light {
            self.any_batch(rays, counters);
            visible.extend(self.blocked.iter().map(|&b| if b { 0.0 } else { 1.0 }));
            return;
        }
        visible.resize(rays.len(), 1.0);
        self.rays.clear();
        self.rays.extend_from_slice(rays);
        self.pending.clear();
        self.pending.extend(0..rays.len());
        for _ in 0..MAX_HOLES {
            if self.pending.is_empty() {
                return;
            }
            self.closest_batch(counters);
            let (mut next, mut retry) = (Vec::new(), Vec::new());
            for (slot, &i) in self.pending.iter().enumerate() {
                let hit = self.hits[slot];
                if !hit.is_hit() {
                    continue;
                }
                if self.world.stops_light(hit.prim) {
                    visible[i] = 0.0;
                    continue;
                }
                let point = self.world.surface(&rays[i], &hit, 0.0);
                visible[i] *= self.world.transparency(&point);
                if visible[i] > 0.0 {
                    next.push(i);
                    retry.push(beyond(&self.rays[slot], &hit, &point));
                }
            }
            (self.pending, self.rays) = (next, retry);
            counters.rays.beyond += self.rays.len() as u64;
        }
        for &i in &self.pending {
            visible[i] = 0.0;
        }
    }
}

/// Runs counted queries; ticks during which other programs had the processor are forgotten.
fn steady(work: &mut RayCounters, query: impl FnOnce(&mut RayCounters)) {
    let ticks = work.ticks;
    if !undisturbed(|| query(work)) {
        work.ticks = ticks;
    }
}

/// The rest of a ray after a hit that let it through; parameters stay those of the whole ray.
pub(crate) fn beyond(ray: &Ray, hit: &Hit, point: &SurfacePoint) -> Ray {
    let step = 2.0 * point.offset / ray.dir.length().max(1e-30);
    let after = hit.t + step;
    // Far along a ray the step may vanish in rounding: the next number up always moves on.
    Ray { t_min: if after > hit.t { after } else { hit.t.next_up() }, ..*ray }
}

/// The ray from a surface point along `dir` to `target`, or to infinity.
pub(crate) fn shadow_ray(point: &SurfacePoint, dir: Vec3, target: Option<Vec3>) -> Ray {
    let origin = point.ray_origin(dir);
    match target {
        Some(target) => Ray { origin, t_min: 0.0, dir: target - origin, t_max: 1.0 },
        None => Ray::new(origin, dir),
    }
}
