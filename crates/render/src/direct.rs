//! The thesis's renderer: one photon map with all light in it, an estimate at every hit, reflected and transmitted
//! children both followed to a level limit, no shadow rays (Figure 3: FireViewerRay, CalculateRayColour).

use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use crate::control::{Cancelled, Observer};
use crate::counters::{Counters, timed};
use crate::eye_pass::EyePass;
use crate::maps::{Estimate, EstimateScratch, Estimated, Estimates, Maps, Scatter};
use crate::pooled::{Asking, Pooled};
use crate::recording::NOT_YET;
use crate::tile::Tile;
use crate::trace::Tracer;
use crate::twin::{Queries, Twin};
use crate::world::{AHEAD, Met};
use photinus_geometry::{Hit, Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use photinus_photons::GatherQuery;
use photinus_profile::queries::RayKind;
use std::iter;

/// Levels followed where neither the scene nor the user limits them: 2^8 rays a pixel at the very most.
pub(crate) const DEFAULT_LEVELS: u32 = 8;

/// Edge of a tile in pixels: rays from all over it end in the same places.
const TILE: u32 = 64;

struct Node {
    ray: Ray,
    throughput: Vec3,
    pixel: u32,
    level: u32,
    /// Number in the pixel's binary tree of rays, the root 1: it picks the random numbers.
    number: u64,
    width: f32,
    spread: f32,
    /// Record of the ray.
    record: u32,
}

impl Node {
    fn kind(&self) -> RayKind {
        if self.level == 0 { RayKind::Camera } else { RayKind::Specular }
    }
}

/// What rays ask for where they land.
struct Asked<'b> {
    next: &'b mut Vec<Node>,
    estimates: &'b mut Estimates,
    /// Where estimates of many tiles are made together.
    pooled: Option<&'b mut Asking>,
}

/// Lists that tiles hand on to one another.
#[derive(Default)]
pub(crate) struct Buffers {
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    /// Numbers of the rays that partly transparent surfaces asked for some.
    draws: Vec<Option<Sampler>>,
    nodes: Vec<Node>,
    next: Vec<Node>,
    bsdf: Bsdf,
    asking: Asking,
    estimates: Estimates,
    scratch: EstimateScratch,
    found: Vec<Estimated>,
}

/// A tile whose samples are followed.
pub(crate) struct Followed<'f, 't, 'w> {
    pub tile: &'f mut Tile<'t>,
    pub tracer: &'f mut Tracer<'w>,
    /// Of the estimates that the tile makes itself.
    pub twin: &'f mut Twin,
    pub counters: &'f mut Counters,
    /// Where the estimates are made together with those of other tiles.
    pub pooled: Option<&'f mut Pooled>,
}

impl EyePass<'_> {
    /// As [`EyePass::run`], by the thesis's recursion.
    pub fn run_direct(&self, maps: &Maps, film: &mut [f32], observer: &dyn Observer) -> Result<Counters, Cancelled> {
        match maps.knn {
            // Searches are recorded beside the rays that ask for them, tile by tile; and waves know one map.
            Some(k) if self.world.recorder.is_none() && maps.caustic.is_none() => {
                self.run_waves(maps, k, film, observer)
            }
            _ => self.run_alone(maps, film, observer),
        }
    }

    /// Each tile makes its own estimates. The picture is the same to the last bit.
    fn run_alone(&self, maps: &Maps, film: &mut [f32], observer: &dyn Observer) -> Result<Counters, Cancelled> {
        self.tiles(TILE).run(film, observer, |buffers, index, tile, counters| {
            let (mut tracer, mut twin) = (self.tracer(index), self.twin(Queries::Estimates, index));
            for sample in 0..self.spp {
                if observer.cancelled() {
                    return sample;
                }
                let (tracer, twin) = (&mut tracer, &mut twin);
                self.direct_sample(maps, buffers, sample, Followed { tile, tracer, twin, counters, pooled: None });
            }
            tracer.finish();
            self.spp
        })
    }

    /// Follows a sample of a tile.
    pub fn direct_sample(
        &self,
        maps: &Maps,
        Buffers { rays, hits, draws, nodes, next, bsdf, asking, estimates, scratch, found }: &mut Buffers,
        sample: u32,
        Followed { tile, tracer, twin, counters, pooled }: Followed,
    ) {
        let place = tile.place;
        scratch.begin_batch_of(tracer);
        nodes.clear();
        nodes.extend(self.camera_paths(sample, tile).map(|p| Node {
            ray: p.ray,
            throughput: p.throughput,
            pixel: p.pixel,
            level: 0,
            number: 1,
            width: p.width,
            spread: p.spread,
            record: NOT_YET,
        }));
        counters.rays.camera += nodes.len() as u64;
        estimates.clear();
        asking.clear();
        while !nodes.is_empty() {
            rays.clear();
            rays.extend(nodes.iter().map(|n| n.ray));
            draws.clear();
            draws.resize(if self.world.passes_light { nodes.len() } else { 0 }, None);
            tracer.ask(nodes.iter().map(|n| (n.kind(), n.record)));
            tracer.closest(rays, hits, counters, |i| {
                draws[i].get_or_insert_with(|| self.node_sampler(&nodes[i], place, sample)).next_1d()
            });
            nodes.iter_mut().enumerate().for_each(|(i, node)| node.record = tracer.record_of(i));
            next.clear();
            timed(self.profile_every > 0, &mut counters.spent.surfaces, || {
                let mut asked = Asked { next, estimates, pooled: pooled.is_some().then_some(&mut *asking) };
                let mut draws = draws.iter_mut();
                for (nodes, hits) in nodes.chunks(AHEAD).zip(hits.chunks(AHEAD)) {
                    let met = self.world.meet(hits);
                    for ((node, hit), met) in nodes.iter().zip(hits).zip(met) {
                        let mut drawn = draws.next().and_then(Option::take);
                        let sampler = || drawn.take().unwrap_or_else(|| self.node_sampler(node, place, sample));
                        self.branch(node, (hit, met), maps.global.radius, sampler, bsdf, tile, &mut asked);
                    }
                }
            });
            counters.rays.specular += next.len() as u64;
            std::mem::swap(nodes, next);
        }
        if let Some(pooled) = pooled {
            asking.file(&maps.global, pooled);
        }
        for map in iter::once(&maps.global).chain(&maps.caustic) {
            map.estimate(&estimates.list, estimates, maps.knn, twin, scratch, found, counters);
            // Those that might be pooled come last, as where they are: the picture is the same to the last bit.
            for last in [false, true] {
                let made = estimates.list.iter().zip(&*found);
                for (e, found) in made.filter(|(e, _)| matches!(e.scatter, Scatter::Constant(_)) == last) {
                    tile.estimated(map.kind, e.path, found.radiance, found.density);
                }
            }
        }
        scratch.hand_over(tracer);
    }

    /// What a ray finds where it ends: light, an estimate to be made, and a reflected and a transmitted ray.
    fn branch(
        &self,
        node: &Node,
        (hit, met): (&Hit, Met),
        radius: f32,
        mut sampler: impl FnMut() -> Sampler,
        bsdf: &mut Bsdf,
        tile: &mut Tile,
        Asked { next, estimates, pooled }: &mut Asked,
    ) {
        if !hit.is_hit() {
            let radiance = self.lights.environment_radiance(node.ray.dir);
            if radiance != Vec3::ZERO {
                tile.emitted(node.pixel, node.throughput * radiance);
            }
            return;
        }
        let width = node.width + node.spread * hit.t;
        let point = self.world.surface_of(met, &node.ray, hit, width);
        let wo = -node.ray.dir;
        let emitted = self.world.emitted(&point, wo);
        if emitted != Vec3::ZERO {
            tile.emitted(node.pixel, node.throughput * emitted);
        }
        let material = self.world.shapes[point.shape as usize].material;
        self.world.materials.resolve_into(material, &point, wo, bsdf);
        if node.level == 0 {
            self.first_surface(node.pixel, hit.t, &point, bsdf, material.0, tile);
        }
        if bsdf.has(LobeSet::GATHER) {
            let side = if point.geometric_normal.dot(wo) >= 0.0 { 1.0 } else { -1.0 };
            let query = GatherQuery {
                position: point.position,
                radius: 0.0,
                normal: point.geometric_normal * side,
                max_depth: 127,
            };
            match (pooled, bsdf.constant(LobeSet::GATHER)) {
                (Some(pooled), Some(factor)) => {
                    pooled.push(GatherQuery { radius, ..query }, node.throughput * factor, node.pixel);
                }
                _ => {
                    let scatter = estimates.scatter(bsdf);
                    estimates.list.push(Estimate {
                        query,
                        side,
                        scatter,
                        throughput: node.throughput,
                        path: node.pixel,
                        places: 1,
                        shift: [0.0; 2],
                        ray: node.record,
                        offset: point.offset,
                        is_first: node.level == 0,
                        scale: 1.0,
                        caustic_scale: 1.0,
                    })
                }
            }
        }
        if node.level + 1 >= self.max_depth || !bsdf.has(LobeSet::CONTINUE) {
            return;
        }
        let mut draws = None;
        for (child, side) in [LobeSet::REFLECTION, LobeSet::TRANSMISSION].into_iter().enumerate() {
            let set = LobeSet::CONTINUE & side;
            if !bsdf.has(set) {
                continue;
            }
            let (choice, u) = if bsdf.is_certain(set) {
                (0.0, [0.0; 2])
            } else {
                let draws: &mut Sampler = draws.get_or_insert_with(&mut sampler);
                draws.start_vertex();
                (draws.next_1d(), draws.next_2d())
            };
            let Some(s) = bsdf.sample(set, choice, u, TransportMode::Radiance) else { continue };
            next.push(Node {
                ray: Ray::new(point.ray_origin(s.wi), s.wi),
                throughput: node.throughput * s.weight,
                pixel: node.pixel,
                level: node.level + 1,
                number: node.number * 2 + child as u64,
                width,
                spread: node.spread,
                record: node.record,
            });
        }
    }

    fn node_sampler(&self, node: &Node, place: [u32; 4], sample: u32) -> Sampler {
        let [x, y] = self.film_pixel(place, node.pixel);
        let stream = node.number << 40 | u64::from(y) << 20 | u64::from(x);
        Sampler::new(self.seed, StreamKind::Eye, stream, self.pass * self.spp + sample)
    }
}
