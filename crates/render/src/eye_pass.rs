//! The eye pass: rays from the camera, direct light by shadow rays, and either photons or further path tracing for
//! the rest (thesis, Figure 3: FireViewerRay, CalculateRayColour).

use crate::SurfacePoint;
use crate::bsdf::{Bsdf, BsdfSample, LobeSet, TransportMode};
use crate::camera::CameraModel;
use crate::control::{Cancelled, Observer};
use crate::counters::{Counters, timed};
use crate::cut_pixels::CutPixels;
use crate::film::{Aov, FilmLayout};
use crate::film_filter::{FilterSampler, SharedFilter};
use crate::indirect::{IndirectEstimate, Kept};
use crate::light::{Lights, Place};
use crate::maps::{Estimate, Estimates, Maps};
use crate::recording::NOT_YET;
use crate::shadow::{Shadow, power_heuristic};
use crate::shadow_photons::ShadowPhotons;
use crate::tile::{Part, Tile, Tiles};
use crate::trace::Tracer;
use crate::twin::{Queries, Twin};
use crate::world::World;
use photinus_geometry::{Hit, Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use photinus_photons::GatherQuery;
use photinus_profile::queries::{BlockKey, RayKind, Stage};

/// Edge of a tile in pixels.
pub(crate) const TILE: u32 = 32;

/// Steps of points that fill the square evenly: powers of the plastic number's inverse (Roberts 2018, the R2 sequence).
pub(crate) const R2: [f32; 2] = [0.754_877_7, 0.569_840_3];
/// Rays along a rough mirror-like lobe that the camera sees, where light may be anywhere.
const LOOKS: u32 = 4;

/// Everything an eye pass needs.
pub(crate) struct EyePass<'a> {
    pub world: &'a World,
    pub lights: &'a Lights,
    pub camera: &'a CameraModel,
    pub filter: &'a FilterSampler,
    /// The same filter where pixels share samples.
    pub shared: Option<&'a SharedFilter>,
    pub layout: &'a FilmLayout,
    /// Window of the film: x, y, width, height.
    pub crop: [u32; 4],
    pub seed: u64,
    pub pass: u32,
    pub spp: u32,
    /// Most edges of a path, camera to light.
    pub max_depth: u32,
    /// None: light after the first diffuse surface is path traced.
    pub maps: Option<&'a Maps>,
    /// What estimates light after a diffuse bounce from the maps.
    pub indirect: &'a dyn IndirectEstimate,
    /// A ray from each diffuse surface looks for lights too, weighted against the shadow ray.
    pub probe: bool,
    /// One query in this many is counted, see [`Twin`].
    pub profile_every: u32,
    /// Shadow rays from each surface that is seen, directly or by mirrors; one from those after a diffuse bounce.
    pub shadow_rays: u32,
    /// Photons that tell where no shadow ray is needed.
    pub shadow_photons: Option<&'a ShadowPhotons>,
    /// Pixels whose estimates are told how much of their discs is surface; none: all of it.
    pub cut_pixels: Option<&'a CutPixels>,
}

#[derive(Clone)]
pub(crate) struct Path {
    pub ray: Ray,
    pub throughput: Vec3,
    pub sampler: Sampler,
    /// Pixel within the tile.
    pub pixel: u32,
    /// Edges so far.
    pub depth: u32,
    /// Pixel's cone: width at the ray's origin and growth.
    pub width: f32,
    pub spread: f32,
    /// Density of the last direction and where it started; infinite after a mirror or the camera.
    last_pdf: f32,
    last_position: Vec3,
    /// Choice of lights that held there.
    pub last_place: Place,
    /// Shadow rays that were sent there.
    pub last_shadows: f32,
    /// Rays that were sent along lobes like the last direction's, this one among them.
    last_looks: f32,
    /// Diffuse bounces, and mirror-like ones after the last of them.
    pub diffuse: u32,
    mirrors: u32,
    /// Undoes the scaling of radiance at refraction, for roulette.
    eta_sq: f32,
    /// Sees lights only, then ends.
    probe: bool,
    /// Record of the latest ray.
    pub record: u32,
}

impl Path {
    fn kind(&self) -> RayKind {
        match (self.probe, self.depth) {
            (true, _) => RayKind::Gather,
            (false, 0) => RayKind::Camera,
            (false, _) => RayKind::Specular,
        }
    }

    /// One of `looks` rays that go on from a point to see lights only.
    fn probe(&self, point: &SurfacePoint, s: &BsdfSample, looks: u32) -> Self {
        Self {
            ray: Ray::new(point.ray_origin(s.wi), s.wi),
            throughput: self.throughput * s.weight,
            last_pdf: s.pdf,
            last_position: point.position,
            last_looks: looks as f32,
            probe: true,
            ..self.clone()
        }
    }

    fn part(&self) -> Part {
        match (self.probe, self.diffuse, self.mirrors) {
            (true, ..) => Part::Direct,
            (_, 0, _) if self.last_pdf.is_infinite() => Part::Emitted,
            (_, 0, _) | (_, 1, 0) => Part::Direct,
            (_, 1, _) => Part::Caustic,
            _ => Part::Indirect,
        }
    }
}

/// Edges of blocks in pixels, the larger first: camera rays that follow each other run side by side.
const BLOCKS: [u32; 2] = [8, 4];

/// Corners, and edges where they end, of the blocks of an area, row by row.
fn blocks([x0, y0, x1, y1]: [u32; 4], edge: u32) -> impl Iterator<Item = [u32; 4]> {
    let corners = (y0..y1).step_by(edge as usize);
    let corners = corners.flat_map(move |y| (x0..x1).step_by(edge as usize).map(move |x| [x, y]));
    corners.map(move |[x, y]| [x, y, (x + edge).min(x1), (y + edge).min(y1)])
}

/// The pixels of a tile, by blocks of blocks.
fn pixels_of(width: u32, height: u32) -> impl Iterator<Item = u32> {
    let blocks = blocks([0, 0, width, height], BLOCKS[0]).flat_map(|area| blocks(area, BLOCKS[1]));
    blocks.flat_map(move |[x0, y0, x1, y1]| (y0..y1).flat_map(move |y| (x0..x1).map(move |x| y * width + x)))
}

/// Lists that tiles hand on to one another.
#[derive(Default)]
struct Buffers {
    paths: Vec<Path>,
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    bsdf: Bsdf,
    asked: Asked,
    shadow_rays: Vec<Ray>,
    visible: Vec<f32>,
}

/// What paths ask for where they land.
#[derive(Default)]
struct Asked {
    next: Vec<Path>,
    shadows: Vec<Shadow>,
    estimates: Estimates,
}

impl EyePass<'_> {
    /// Renders one pass into `film` (channels of each pixel of the window, row by row), means over the samples of
    /// the pass. Where it is stopped, tiles that have any sample are there, as means over those.
    pub fn run(&self, film: &mut [f32], observer: &dyn Observer) -> Result<Counters, Cancelled> {
        self.tiles(TILE).run(film, observer, |buffers: &mut Buffers, index, tile, counters| {
            let mut tracer = self.tracer(index);
            let mut twin = self.twin(Queries::Estimates, index);
            for sample in 0..self.spp {
                if observer.cancelled() {
                    return sample;
                }
                buffers.paths.clear();
                buffers.paths.extend(self.camera_paths(sample, tile));
                counters.rays.camera += buffers.paths.len() as u64;
                self.follow(buffers, tile, &mut tracer, counters);
                self.gather(&buffers.asked.estimates, &mut twin, tile, &mut tracer, counters);
                tile.end_sample();
            }
            tracer.finish();
            self.spp
        })
    }

    /// The tiles of the pass.
    pub(crate) fn tiles(&self, edge: u32) -> Tiles<'_> {
        Tiles { layout: self.layout, window: self.crop, samples: self.spp, edge, shared: self.shared }
    }

    /// The tracer of a tile.
    pub(crate) fn tracer(&self, tile: u32) -> Tracer<'_> {
        let key = BlockKey { pass: self.pass, stage: Stage::EyePass, index: tile };
        Tracer::new(self.world, self.twin(Queries::EyeRays, tile)).record(key)
    }

    /// Which queries of a tile are counted.
    pub(crate) fn twin(&self, queries: Queries, tile: u32) -> Twin {
        Twin::new(self.profile_every, queries, self.pass, tile)
    }

    /// The pixel of the film that is number `pixel` of the tile at `place`.
    pub(crate) fn film_pixel(&self, [x0, y0, width, _]: [u32; 4], pixel: u32) -> [u32; 2] {
        [self.crop[0] + x0 + pixel % width, self.crop[1] + y0 + pixel / width]
    }

    /// The random numbers of a path, those of its camera ray first.
    pub(crate) fn camera_sampler(&self, [x, y]: [u32; 2], sample: u32) -> Sampler {
        Sampler::new(self.seed, StreamKind::Eye, u64::from(y) << 32 | u64::from(x), self.pass * self.spp + sample)
    }

    /// Where a sample lies, from its pixel's middle, and its weight.
    pub(crate) fn film_offset(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        if self.shared.is_some() { (u.map(|u| u - 0.5), 1.0) } else { self.filter.sample(u) }
    }

    /// The paths of a sample of a tile.
    pub(crate) fn camera_paths<'t>(&'t self, sample: u32, tile: &'t mut Tile) -> impl Iterator<Item = Path> + 't {
        tile.sample = sample;
        pixels_of(tile.place[2], tile.place[3]).map(move |pixel| {
            let [x, y] = self.film_pixel(tile.place, pixel);
            let mut sampler = self.camera_sampler([x, y], sample);
            let ([dx, dy], weight) = self.film_offset(sampler.next_2d());
            tile.place_sample(pixel, [dx, dy], weight);
            let film = [x as f32 + 0.5 + dx, y as f32 + 0.5 + dy];
            let start = self.camera.ray(film, &mut sampler);
            Path {
                ray: start.ray,
                throughput: Vec3::ONE,
                sampler,
                pixel,
                depth: 0,
                width: start.width,
                spread: start.spread,
                last_pdf: f32::INFINITY,
                last_position: start.ray.origin,
                last_place: Place::ANY,
                last_shadows: 0.0,
                last_looks: 1.0,
                diffuse: 0,
                mirrors: 0,
                eta_sq: 1.0,
                probe: false,
                record: NOT_YET,
            }
        })
    }

    /// Follows all paths of a batch to their ends, and collects the estimates that they ask for.
    fn follow(&self, buffers: &mut Buffers, tile: &mut Tile, tracer: &mut Tracer, counters: &mut Counters) {
        let Buffers { paths, rays, hits, bsdf, asked, shadow_rays, visible, .. } = buffers;
        asked.estimates.clear();
        while !paths.is_empty() {
            rays.clear();
            rays.extend(paths.iter().map(|p| p.ray));
            tracer.ask(paths.iter().map(|p| (p.kind(), p.record)));
            tracer.closest(rays, hits, counters, |i| paths[i].sampler.next_1d());
            paths.iter_mut().enumerate().for_each(|(i, path)| path.record = tracer.record_of(i));
            asked.next.clear();
            asked.shadows.clear();
            timed(self.profile_every > 0, &mut counters.spent.surfaces, || {
                for (path, hit) in paths.drain(..).zip(&*hits) {
                    if hit.is_hit() {
                        let width = path.width + path.spread * hit.t;
                        let point = self.world.surface(&path.ray, hit, width);
                        self.shade(path, hit.t, &point, bsdf, tile, asked);
                    } else {
                        self.escape(&path, tile);
                    }
                }
            });
            shadow_rays.clear();
            let asking = || asked.shadows.iter().filter(|s| s.known.is_none());
            shadow_rays.extend(asking().map(|s| s.ray));
            counters.rays.shadow += shadow_rays.len() as u64;
            tracer.ask(asking().map(|s| (RayKind::Shadow, s.record)));
            tracer.visibility(shadow_rays, visible, counters);
            let mut visible = visible.iter();
            for shadow in &asked.shadows {
                let share = match shadow.known {
                    None => visible.next().copied().unwrap_or(0.0),
                    Some(share) => {
                        counters.shadow_photons.count_known(share);
                        share
                    }
                };
                if let Some(slot) = shadow.slot {
                    self.lights.saw(slot, share > 0.0);
                }
                if share > 0.0 {
                    tile.add(shadow.pixel, shadow.diffuse.1, shadow.diffuse.0 * share);
                    tile.add(shadow.pixel, shadow.glossy.1, shadow.glossy.0 * share);
                }
            }
            let probes = asked.next.iter().filter(|p| p.probe).count() as u64;
            counters.rays.gather += probes;
            counters.rays.specular += asked.next.len() as u64 - probes;
            std::mem::swap(paths, &mut asked.next);
        }
    }

    /// A path leaves the scene.
    fn escape(&self, path: &Path, tile: &mut Tile) {
        if path.depth + 1 > self.max_depth || (path.depth == 0 && self.world.integrator.hide_emitters) {
            return;
        }
        let radiance = self.lights.environment_radiance(path.ray.dir);
        if radiance == Vec3::ZERO {
            return;
        }
        let weight = if path.last_pdf.is_infinite() {
            1.0
        } else {
            let rival = self.lights.environment_pdf(path.last_place, path.ray.dir);
            power_heuristic(path.last_pdf * path.last_looks, path.last_shadows * rival) / path.last_looks
        };
        tile.add(path.pixel, path.part(), path.throughput * radiance * weight);
    }

    fn shade(
        &self,
        mut path: Path,
        distance: f32,
        point: &SurfacePoint,
        bsdf: &mut Bsdf,
        tile: &mut Tile,
        asked: &mut Asked,
    ) {
        path.depth += 1;
        path.width += path.spread * distance;
        let wo = -path.ray.dir;
        let emitted = self.world.emitted(point, wo);
        if emitted != Vec3::ZERO && !(path.depth == 1 && self.world.integrator.hide_emitters) {
            let weight = if path.last_pdf.is_infinite() {
                1.0
            } else {
                let rival = self.lights.area_pdf(self.world, path.last_position, path.last_place, point);
                power_heuristic(path.last_pdf * path.last_looks, path.last_shadows * rival) / path.last_looks
            };
            tile.add(path.pixel, path.part(), path.throughput * emitted * weight);
        }
        if path.probe {
            return;
        }
        let material = self.world.shapes[point.shape as usize].material;
        self.world.materials.resolve_into(material, point, wo, bsdf);
        if path.depth == 1 {
            self.first_surface(path.pixel, distance, point, bsdf, material.0, tile);
        }
        if path.depth >= self.max_depth {
            return;
        }
        path.sampler.start_vertex();
        if bsdf.has(LobeSet::NON_DELTA) {
            let normal =
                if point.geometric_normal.dot(wo) >= 0.0 { point.geometric_normal } else { -point.geometric_normal };
            path.last_place = self.lights.place(point.position, normal);
            self.light(&mut path, point, bsdf, &mut asked.shadows);
        }
        if self.maps.is_some() && bsdf.has(LobeSet::GATHER) {
            self.ask(&mut path, point, bsdf, wo, tile, asked);
        }
        self.bounce(path, point, bsdf, &mut asked.next);
    }

    /// Asks for a photon estimate, and sends a probe for direct light where those are on.
    fn ask(
        &self,
        path: &mut Path,
        point: &SurfacePoint,
        bsdf: &Bsdf,
        wo: Vec3,
        tile: &Tile,
        Asked { next, estimates, .. }: &mut Asked,
    ) {
        let side = if point.geometric_normal.dot(wo) >= 0.0 { 1.0 } else { -1.0 };
        let scatter = estimates.scatter(bsdf);
        let query = GatherQuery {
            position: point.position,
            radius: 0.7 * path.width,
            normal: point.geometric_normal * side,
            max_depth: (self.max_depth - path.depth).min(127),
        };
        let (throughput, offset, ray) = (path.throughput, point.offset, path.record);
        let is_first = path.depth == 1;
        let mut estimate = Estimate {
            query,
            side,
            scatter,
            throughput,
            path: path.pixel,
            places: 1,
            shift: [0.0; 2],
            ray,
            offset,
            is_first,
            scale: 1.0,
            caustic_scale: 1.0,
        };
        if is_first {
            self.add_companions(path, tile, &mut estimate, &mut estimates.companions);
        }
        if let (true, Some(pixels), Some(maps)) = (is_first, self.cut_pixels, self.maps) {
            let [x0, y0, w, _] = tile.place;
            estimate.scale = pixels.scale([x0 + path.pixel % w, y0 + path.pixel / w], &estimate, maps.global.radius);
        }
        estimates.list.push(estimate);
        if self.indirect.keeps_surfaces() {
            let [x, y] = self.film_pixel(tile.place, path.pixel);
            estimates.kept.push(Kept {
                point: *point,
                bsdf: bsdf.clone(),
                stream: u64::from(path.depth.min(255)) << 56 | u64::from(y) << 32 | u64::from(x),
                depth: path.depth,
                width: path.width,
            });
        }
        if !self.probe {
            return;
        }
        let (choice, u) = (path.sampler.next_1d(), path.sampler.next_2d());
        if let Some(s) = bsdf.sample(LobeSet::GATHER, choice, u, TransportMode::Radiance) {
            next.push(path.probe(point, &s, 1));
        }
    }

    /// Continues a path: mirror-like lobes only where photons give the rest. Glass and water that the camera sees send both
    /// a reflected and a refracted ray.
    fn bounce(&self, path: Path, point: &SurfacePoint, bsdf: &Bsdf, next: &mut Vec<Path>) {
        let set = if self.maps.is_some() { LobeSet::CONTINUE } else { LobeSet::ALL };
        let both = [LobeSet::DELTA_REFLECTION, LobeSet::DELTA_TRANSMISSION];
        let fork =
            path.depth == 1 && both.into_iter().all(|lobe| bsdf.has(lobe)) && !bsdf.has(set & LobeSet::NON_DELTA);
        if fork {
            self.bounce_once(path.clone(), both[0], point, bsdf, next);
            self.bounce_once(path, both[1], point, bsdf, next);
        } else if bsdf.has(set) {
            self.bounce_once(path, set, point, bsdf, next);
        }
    }

    fn bounce_once(&self, mut path: Path, set: LobeSet, point: &SurfacePoint, bsdf: &Bsdf, next: &mut Vec<Path>) {
        let choice = path.sampler.next_1d();
        let chance = path.sampler.next_1d();
        let u = path.sampler.next_2d();
        let looks = self.looks(&path, bsdf);
        for i in 1..looks {
            let u = [(u[0] + i as f32 * R2[0]).fract(), (u[1] + i as f32 * R2[1]).fract()];
            let choice = (choice + i as f32 / looks as f32).fract();
            let Some(s) = bsdf.sample(set, choice, u, TransportMode::Radiance) else { continue };
            next.push(path.probe(point, &s, looks));
        }
        path.last_looks = looks as f32;
        let Some(s) = bsdf.sample(set, choice, u, TransportMode::Radiance) else { return };
        let throughput = path.throughput * s.weight;
        let strength = throughput.max_element() * path.eta_sq * s.eta * s.eta;
        let keep = survival(path.depth, Vec3::splat(strength));
        if !(chance < keep) {
            return;
        }
        // The same survival as shadow rays reckon with, which do not know the scaling at refraction.
        let found = survival(path.depth, throughput);
        path.throughput = throughput / keep;
        path.eta_sq *= s.eta * s.eta;
        if s.kind.intersects(LobeSet::GATHER) {
            path.diffuse += 1;
            path.mirrors = 0;
            path.spread = path.spread.max(0.1);
        } else if path.diffuse > 0 {
            path.mirrors += 1;
        }
        path.last_pdf = if s.kind.intersects(LobeSet::DELTA) { f32::INFINITY } else { s.pdf * found };
        path.last_position = point.position;
        path.ray = Ray::new(point.ray_origin(s.wi), s.wi);
        next.push(path);
    }

    /// Rays that look along the mirror-like lobes of a surface for lights; all but one of them end there.
    pub(crate) fn looks(&self, path: &Path, bsdf: &Bsdf) -> u32 {
        let rough = bsdf.has(LobeSet::CONTINUE & LobeSet::NON_DELTA) && !bsdf.has(LobeSet::DELTA);
        if self.maps.is_some() && self.probe && path.depth == 1 && rough { LOOKS } else { 1 }
    }

    pub(crate) fn first_surface(
        &self,
        pixel: u32,
        distance: f32,
        point: &SurfacePoint,
        bsdf: &Bsdf,
        material: u32,
        tile: &mut Tile,
    ) {
        if let Some(offset) = self.layout.offset(Aov::Albedo) {
            tile.add_at(pixel, offset, bsdf.albedo(LobeSet::ALL));
        }
        if let Some(offset) = self.layout.offset(Aov::Normal) {
            tile.add_at(pixel, offset, bsdf.shading_normal());
        }
        tile.add_scalar(pixel, Aov::Depth, distance);
        // Ids are labels: those of the first sample of the first pass stand for the pixel.
        if self.pass == 0 {
            for (aov, id) in [(Aov::ObjectId, point.shape + 1), (Aov::MaterialId, material + 1)] {
                if let Some(offset) = self.layout.offset(aov) {
                    let value = &mut tile.out[pixel as usize * self.layout.channels() + offset];
                    if *value == 0.0 {
                        *value = id as f32;
                    }
                }
            }
        }
    }
}

/// Probability that a bounce of this throughput is followed: always from what the camera sees, as lamps shine in weak
/// coats too; further on weak reflections are followed in proportion.
pub(crate) fn survival(depth: u32, throughput: Vec3) -> f32 {
    match depth {
        0..=1 if throughput.max_element() > 0.0 => 1.0,
        0..=3 => (5.0 * throughput.max_element()).min(1.0),
        _ => throughput.max_element().min(0.95),
    }
}
