//! Rays of final gathering: each goes on through mirrors and glass to surfaces that keep photons, where the irradiance of all
//! light is looked up.
//!
//! What such a surface sends back by its gather lobes is its reflectance over pi times the irradiance, whatever the lobe. Light
//! that surfaces send out by themselves is left out: straight from a lamp it is found by shadow rays, through mirrors and glass by
//! the caustic map.

use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use crate::counters::{Counters, timed};
use crate::eye_pass::survival;
use crate::recording::NOT_YET;
use crate::trace::Tracer;
use crate::world::World;
use photinus_geometry::{Hit, Ray, Vec3};
use photinus_num::Sampler;
use photinus_photons::irradiance::IrradianceAtPhotons;
use photinus_profile::queries::RayKind;
use std::f32::consts::FRAC_1_PI;

/// How the width of what a ray stands for grows with its length, as of eye paths after a diffuse bounce.
const SPREAD: f32 = 0.1;
/// Most surfaces that a ray meets: mirrors that lose nothing could keep it for ever.
const MOST_SURFACES: u32 = 64;

/// A ray on its way.
#[derive(Clone)]
pub(super) struct GatherRay {
    pub ray: Ray,
    pub throughput: Vec3,
    pub sampler: Sampler,
    /// Which estimate's it is.
    pub owner: u32,
    /// Edges from the camera, before this ray.
    pub depth: u32,
    pub width: f32,
    eta_sq: f32,
    surfaces: u32,
}

impl GatherRay {
    /// A ray from a visible point.
    pub fn new(ray: Ray, throughput: Vec3, sampler: Sampler, owner: u32, depth: u32, width: f32) -> Self {
        Self { ray, throughput, sampler, owner, depth, width, eta_sq: 1.0, surfaces: 0 }
    }
}

/// What the rays of batches are followed with.
pub(super) struct GatherRays<'g> {
    pub world: &'g World,
    /// Irradiance of all light.
    pub known: &'g IrradianceAtPhotons,
    /// Most edges of a path, camera to light.
    pub max_depth: u32,
    pub profiled: bool,
}

/// Lists of a batch.
#[derive(Default)]
pub(super) struct Buffers {
    next: Vec<GatherRay>,
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    bsdf: Bsdf,
}

impl GatherRays<'_> {
    /// Follows rays to their ends; `add` gets the owner of a ray, the radiance that it brings, and how far away it comes from
    /// where the surface is the first one; rays that meet nothing at once are told of with no light and infinity.
    pub fn follow(
        &self,
        walks: &mut Vec<GatherRay>,
        Buffers { next, rays, hits, bsdf }: &mut Buffers,
        tracer: &mut Tracer,
        counters: &mut Counters,
        mut add: impl FnMut(u32, Vec3, Option<f32>),
    ) {
        while !walks.is_empty() {
            rays.clear();
            rays.extend(walks.iter().map(|walk| walk.ray));
            counters.rays.final_gather += rays.len() as u64;
            tracer.ask(walks.iter().map(|_| (RayKind::Gather, NOT_YET)));
            tracer.closest(rays, hits, counters, |i| walks[i].sampler.next_1d());
            next.clear();
            let irradiance = &mut counters.irradiance;
            timed(self.profiled, &mut counters.spent.surfaces, || {
                for (mut walk, hit) in walks.drain(..).zip(&*hits) {
                    let is_first = walk.surfaces == 0;
                    if !hit.is_hit() {
                        if is_first {
                            add(walk.owner, Vec3::ZERO, Some(f32::INFINITY));
                        }
                        continue;
                    }
                    walk.width += SPREAD * hit.t;
                    let point = self.world.surface(&walk.ray, hit, walk.width);
                    let wo = -walk.ray.dir;
                    self.world.materials.resolve_into(
                        self.world.shapes[point.shape as usize].material,
                        &point,
                        wo,
                        bsdf,
                    );
                    walk.depth += 1;
                    walk.surfaces += 1;
                    let mut radiance = Vec3::ZERO;
                    if walk.depth < self.max_depth && bsdf.has(LobeSet::GATHER) {
                        let normal = bsdf.geometric_normal();
                        let found = self.known.at(point.position, normal);
                        irradiance.count_look_up(found.is_some());
                        let factor =
                            bsdf.constant(LobeSet::GATHER).unwrap_or_else(|| bsdf.albedo(LobeSet::GATHER) * FRAC_1_PI);
                        radiance = walk.throughput * factor * found.unwrap_or(Vec3::ZERO);
                    }
                    add(walk.owner, radiance, is_first.then_some(hit.t));
                    let may_go_on = walk.depth < self.max_depth && walk.surfaces < MOST_SURFACES;
                    if may_go_on && bsdf.has(LobeSet::CONTINUE) {
                        walk.sampler.start_vertex();
                        if Self::bounce(&mut walk, bsdf) {
                            walk.ray = Ray::new(point.ray_origin(walk.ray.dir), walk.ray.dir);
                            next.push(walk);
                        }
                    }
                }
            });
            std::mem::swap(walks, next);
        }
    }

    /// Turns a ray to where a mirror-like lobe sends it; false where it ends.
    fn bounce(walk: &mut GatherRay, bsdf: &Bsdf) -> bool {
        let (choice, chance, u) = (walk.sampler.next_1d(), walk.sampler.next_1d(), walk.sampler.next_2d());
        let Some(s) = bsdf.sample(LobeSet::CONTINUE, choice, u, TransportMode::Radiance) else { return false };
        let throughput = walk.throughput * s.weight;
        let strength = throughput.max_element() * walk.eta_sq * s.eta * s.eta;
        // Never as what the camera sees directly.
        let keep = survival(walk.surfaces + 1, Vec3::splat(strength));
        if !(chance < keep) {
            return false;
        }
        walk.throughput = throughput / keep;
        walk.eta_sq *= s.eta * s.eta;
        walk.ray.dir = s.wi;
        true
    }
}
