//! All lights of a scene behind one choice.

use super::alias::AliasTable;
use super::area::{cosine_hemisphere, uniform_cone, uniform_sphere, uniform_triangle};
use super::emission::{EmissionPoint, LightChoice};
use super::environment::Environment;
use super::sky_view::SkyView;
use super::sphere;
use crate::camera::uniform_disk;
use crate::{SurfacePoint, world::World};
use photinus_geometry::{Frame, Ray, Vec3};
use photinus_scene::Light;
use std::f32::consts::{PI, TAU};

/// The part of the scene that matters to the picture: photons from infinity are aimed at it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibleRegion {
    /// Middle.
    pub center: Vec3,
    /// Radius, positive.
    pub radius: f32,
}

/// Light that may reach a point, before anything in between is asked for.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction from the point to the light.
    pub dir: Vec3,
    /// Where the shadow ray ends; none: at infinity.
    pub target: Option<Vec3>,
    /// Radiance from there, or intensity over squared distance for lights without area (then `delta`).
    pub radiance: Vec3,
    /// Density over solid angle, the choice of the light included; of the choice alone where `delta`.
    pub pdf: f32,
    /// The light cannot be hit by chance.
    pub delta: bool,
}

/// A photon as it leaves its light.
#[derive(Clone, Copy, Debug)]
pub struct PhotonStart {
    /// Its way, of unit direction.
    pub ray: Ray,
    /// Flux in W if it were the only photon: divide by the number emitted.
    pub flux: Vec3,
}

#[derive(Clone, Debug)]
enum Emitter {
    Triangle { prim: u32 },
    Sphere { prim: u32 },
    Point { position: Vec3, intensity: Vec3 },
    Spot { position: Vec3, frame: Frame, intensity: Vec3, cutoff: f32, beam: f32, one_minus_cos: f32 },
    Directional { direction: Vec3, irradiance: Vec3 },
    Environment,
}

/// The lights of a scene.
pub struct Lights {
    emitters: Vec<Emitter>,
    table: AliasTable,
    emission: LightChoice,
    /// For each shape, the emitter of its first primitive; `u32::MAX`: it emits nothing.
    first_emitter: Vec<u32>,
    environment: Option<(Environment, usize)>,
    region: VisibleRegion,
    /// Radii of the discs that photons from infinity start on, with the share of each.
    rings: Vec<(f32, f32)>,
    /// Some light comes from infinity.
    from_infinity: bool,
}

impl Lights {
    /// The lights of `world`, chosen in proportion to their power; light from infinity counts what falls on `region`, by
    /// the share of it that `view` finds open.
    pub(crate) fn new(world: &World, region: VisibleRegion, view: &SkyView) -> Self {
        let mut emitters = Vec::new();
        let mut powers = Vec::new();
        let mut first_emitter = vec![u32::MAX; world.shapes.len()];
        for (i, shape) in world.shapes.iter().enumerate() {
            if shape.emission.is_none() {
                continue;
            }
            first_emitter[i] = emitters.len() as u32;
            for prim in shape.first_prim..shape.first_prim + shape.prim_count {
                let (emitter, power) = area_emitter(world, prim);
                emitters.push(emitter);
                powers.push(power);
            }
        }
        let disc = f64::from(PI) * f64::from(region.radius) * f64::from(region.radius);
        let mut environment = None;
        for light in &world.lights {
            let (emitter, power) = match light {
                Light::Point { position, intensity } => (
                    Emitter::Point { position: *position, intensity: *intensity },
                    4.0 * f64::from(PI) * mean(*intensity),
                ),
                Light::Spot { position, direction, intensity, cutoff_angle, beam_width } => {
                    let cutoff = cutoff_angle.clamp(1e-4, PI);
                    let half = libm::sinf(0.5 * cutoff);
                    let one_minus_cos = 2.0 * half * half;
                    let emitter = Emitter::Spot {
                        position: *position,
                        frame: Frame::from_normal(*direction),
                        intensity: *intensity,
                        cutoff,
                        beam: beam_width.clamp(0.0, cutoff),
                        one_minus_cos,
                    };
                    (emitter, f64::from(TAU * one_minus_cos) * mean(*intensity))
                }
                Light::Directional { direction, irradiance } => {
                    (Emitter::Directional { direction: *direction, irradiance: *irradiance }, disc * mean(*irradiance))
                }
                Light::Environment(light) => {
                    let field = Environment::new(light, view);
                    let power = 4.0 * f64::from(PI) * disc * mean(field.mean()) * view.openness();
                    environment = Some((field, emitters.len()));
                    (Emitter::Environment, power)
                }
            };
            emitters.push(emitter);
            powers.push(if power.is_finite() { power } else { 0.0 });
        }
        let (table, emission) = (AliasTable::new(&powers), LightChoice::new(&powers));
        let from_infinity = emitters.iter().any(|e| matches!(e, Emitter::Directional { .. } | Emitter::Environment));
        let rings = rings(world, region);
        Self { emitters, table, emission, first_emitter, environment, region, rings, from_infinity }
    }

    /// Whether the scene is dark.
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    /// Where photons from infinity are aimed.
    pub fn region(&self) -> VisibleRegion {
        self.region
    }

    /// Whether photons from infinity are aimed at a region smaller than the scene.
    pub(crate) fn aims(&self) -> bool {
        self.rings.len() > 1 && self.from_infinity
    }

    /// Whether light comes from all around.
    pub fn has_environment(&self) -> bool {
        self.environment.is_some()
    }

    /// Bytes of the tables.
    pub fn bytes(&self) -> usize {
        self.emitters.len() * (size_of::<Emitter>() + 20) + self.environment.as_ref().map_or(0, |(e, _)| e.bytes())
    }

    /// Radiance from infinity, looking along `dir`.
    pub fn environment_radiance(&self, dir: Vec3) -> Vec3 {
        self.environment.as_ref().map_or(Vec3::ZERO, |(e, _)| e.radiance(dir))
    }

    /// Density with which `sample` chooses the direction `dir` to infinity.
    pub fn environment_pdf(&self, dir: Vec3) -> f32 {
        self.environment.as_ref().map_or(0.0, |(e, i)| self.table.probability(*i) * e.pdf(dir))
    }

    /// Density with which `sample` at `from` chooses the point `at` on an emitting shape, over solid angle.
    pub(crate) fn area_pdf(&self, world: &World, from: Vec3, at: &SurfacePoint) -> f32 {
        let first = self.first_emitter[at.shape as usize];
        if first == u32::MAX {
            return 0.0;
        }
        let emitter = (first + at.prim - world.shapes[at.shape as usize].first_prim) as usize;
        let choice = self.table.probability(emitter);
        let density = match self.emitters[emitter] {
            Emitter::Triangle { prim } => {
                let to = at.position - from;
                let distance_sq = to.length_squared();
                let cos = triangle_normal(world, prim).dot(to).abs() / distance_sq.sqrt();
                distance_sq / (cos * triangle_area(world, prim)).max(1e-30)
            }
            Emitter::Sphere { prim } => {
                let ball = world.primitives.spheres[prim as usize - world.primitives.triangle_count()];
                match sphere::cone(&ball, from) {
                    Some(one_minus_cos) => 1.0 / (TAU * one_minus_cos),
                    None => {
                        let to = at.position - from;
                        let distance_sq = to.length_squared();
                        let cos = at.geometric_normal.dot(to).abs() / distance_sq.sqrt();
                        distance_sq / (cos * sphere_area(ball.radius)).max(1e-30)
                    }
                }
            }
            _ => return 0.0,
        };
        choice * density
    }

    /// Chooses a light and a point on it as seen from `from`; none where the choice sends nothing there.
    pub(crate) fn sample(&self, world: &World, from: Vec3, choice: f32, u: [f32; 2]) -> Option<LightSample> {
        if self.table.is_empty() {
            return None;
        }
        let (index, probability, rest) = self.table.sample(choice);
        if probability <= 0.0 {
            return None;
        }
        let sample = match &self.emitters[index] {
            Emitter::Triangle { prim } => {
                let [alpha, beta] = uniform_triangle(u);
                let light = world.triangle_point(*prim, alpha, beta);
                let to = light.position - from;
                let distance_sq = to.length_squared();
                let dir = to / distance_sq.sqrt();
                let cos = triangle_normal(world, *prim).dot(dir).abs();
                let pdf = distance_sq / (cos * triangle_area(world, *prim)).max(1e-30);
                LightSample {
                    dir,
                    target: Some(light.ray_origin(-dir)),
                    radiance: world.emitted(&light, -dir),
                    pdf: pdf * probability,
                    delta: false,
                }
            }
            Emitter::Sphere { prim } => {
                let ball = world.primitives.spheres[*prim as usize - world.primitives.triangle_count()];
                let (light, dir, pdf) = match sphere::sample(&ball, from, u) {
                    Some((dir, at, pdf)) => (world.sphere_point(*prim, at), dir, pdf),
                    None => {
                        let at = ball.center + uniform_sphere(u) * ball.radius;
                        let light = world.sphere_point(*prim, at);
                        let to = light.position - from;
                        let distance_sq = to.length_squared();
                        let dir = to / distance_sq.sqrt();
                        let cos = light.geometric_normal.dot(dir).abs();
                        (light, dir, distance_sq / (cos * sphere_area(ball.radius)).max(1e-30))
                    }
                };
                LightSample {
                    dir,
                    target: Some(light.ray_origin(-dir)),
                    radiance: world.emitted(&light, -dir),
                    pdf: pdf * probability,
                    delta: false,
                }
            }
            Emitter::Point { position, intensity } => {
                let to = *position - from;
                let distance_sq = to.length_squared();
                LightSample {
                    dir: to / distance_sq.sqrt(),
                    target: Some(*position),
                    radiance: *intensity / distance_sq,
                    pdf: probability,
                    delta: true,
                }
            }
            Emitter::Spot { position, frame, intensity, cutoff, beam, .. } => {
                let to = *position - from;
                let distance_sq = to.length_squared();
                let dir = to / distance_sq.sqrt();
                let factor = falloff(libm::acosf((-dir).dot(frame.n).clamp(-1.0, 1.0)), *cutoff, *beam);
                LightSample {
                    dir,
                    target: Some(*position),
                    radiance: *intensity * (factor / distance_sq),
                    pdf: probability,
                    delta: true,
                }
            }
            Emitter::Directional { direction, irradiance } => {
                LightSample { dir: -*direction, target: None, radiance: *irradiance, pdf: probability, delta: true }
            }
            Emitter::Environment => {
                let (environment, _) = self.environment.as_ref()?;
                let (dir, pdf) = environment.sample(rest, u);
                LightSample {
                    dir,
                    target: None,
                    radiance: environment.radiance(dir),
                    pdf: pdf * probability,
                    delta: false,
                }
            }
        };
        let useful = sample.dir.is_finite()
            && sample.radiance.max_element() > 0.0
            && sample.pdf > 0.0
            && (sample.pdf.is_finite() && sample.radiance.is_finite());
        useful.then_some(sample)
    }

    /// Starts a photon from numbers that are uniform over the cube; none where they choose what emits nothing.
    pub(crate) fn emit(&self, world: &World, point: &EmissionPoint) -> Option<PhotonStart> {
        let (place, way) = (point.place(), point.direction());
        let (index, probability, rest) = self.emission.at(point.light())?;
        let (ray, flux) = match &self.emitters[index] {
            Emitter::Triangle { prim } => {
                let [alpha, beta] = uniform_triangle(place);
                let light = world.triangle_point(*prim, alpha, beta);
                self.lambertian(world, &light, way, triangle_area(world, *prim))
            }
            Emitter::Sphere { prim } => {
                let ball = world.primitives.spheres[*prim as usize - world.primitives.triangle_count()];
                let light = world.sphere_point(*prim, ball.center + uniform_sphere(place) * ball.radius);
                self.lambertian(world, &light, way, sphere_area(ball.radius))
            }
            Emitter::Point { position, intensity } => {
                (Ray::new(*position, uniform_sphere(way)), *intensity * (4.0 * PI))
            }
            Emitter::Spot { position, frame, intensity, cutoff, beam, one_minus_cos } => {
                let local = uniform_cone(way, *one_minus_cos);
                let factor = falloff(libm::acosf(local.z.clamp(-1.0, 1.0)), *cutoff, *beam);
                (Ray::new(*position, frame.to_world(local)), *intensity * (factor * TAU * one_minus_cos))
            }
            Emitter::Directional { direction, irradiance } => {
                let (ray, density) = self.start_outside(*direction, place, point.disc());
                (ray, *irradiance / density)
            }
            Emitter::Environment => {
                let (environment, _) = self.environment.as_ref()?;
                let (dir, pdf) = environment.sample(rest, way);
                let (ray, density) = self.start_outside(-dir, place, point.disc());
                (ray, environment.radiance(dir) / (pdf * density))
            }
        };
        let flux = flux / probability;
        (flux.is_finite() && flux.max_element() > 0.0).then_some(PhotonStart { ray, flux })
    }

    fn lambertian(&self, world: &World, light: &SurfacePoint, u: [f32; 2], area: f32) -> (Ray, Vec3) {
        let (local, _) = cosine_hemisphere(u);
        let dir = Frame::from_normal(light.geometric_normal).to_world(local);
        let radiance = world.emitted(light, light.geometric_normal);
        (Ray::new(light.ray_origin(dir), dir), radiance * (PI * area))
    }

    /// A ray that travels along `dir` from beyond the scene, and the density of its place per area across it.
    ///
    /// Its place is drawn from nested discs around the visible region, each twice as wide as the one before: light
    /// that falls far outside still counts, at a density that falls like the square of the distance.
    fn start_outside(&self, dir: Vec3, u: [f32; 2], choice: f32) -> (Ray, f32) {
        let mut rest = choice;
        let mut radius = self.rings[self.rings.len() - 1].0;
        for &(r, share) in &self.rings {
            if rest < share {
                radius = r;
                break;
            }
            rest -= share;
        }
        let [x, y] = uniform_disk(u);
        let frame = Frame::from_normal(dir);
        let off = radius * (x * x + y * y).sqrt();
        let density = self.rings.iter().filter(|(r, _)| *r >= off).map(|(r, share)| share / (PI * r * r)).sum::<f32>();
        let reach = self.rings[self.rings.len() - 1].0;
        let origin = self.region.center + (frame.s * x + frame.t * y) * radius - dir * (2.0 * reach);
        (Ray::new(origin, dir), density)
    }
}

/// Half of the photons go to the visible region, the others to discs that double in radius until the scene ends.
fn rings(world: &World, region: VisibleRegion) -> Vec<(f32, f32)> {
    let bounds = world.bounds;
    let reach = if bounds.is_empty() {
        region.radius
    } else {
        (region.center - bounds.center()).length() + 0.5 * bounds.diagonal()
    };
    let mut radii = vec![region.radius];
    while radii[radii.len() - 1] < reach && radii.len() < 64 {
        radii.push((radii[radii.len() - 1] * 2.0).min(reach));
    }
    if radii.len() == 1 {
        return vec![(radii[0], 1.0)];
    }
    let others = 0.5 / (radii.len() - 1) as f32;
    radii.into_iter().enumerate().map(|(i, r)| (r, if i == 0 { 0.5 } else { others })).collect()
}

fn area_emitter(world: &World, prim: u32) -> (Emitter, f64) {
    let triangles = world.primitives.triangle_count();
    let (emitter, area, radiance) = if (prim as usize) < triangles {
        // A texture may be dark at any one point: look at several before calling the triangle dark.
        const SAMPLES: [[f32; 2]; 7] =
            [[0.33, 0.33], [0.1, 0.1], [0.8, 0.1], [0.1, 0.8], [0.45, 0.1], [0.1, 0.45], [0.45, 0.45]];
        let total: f64 = SAMPLES
            .iter()
            .map(|&[alpha, beta]| {
                let p = world.triangle_point(prim, alpha, beta);
                mean(world.emitted(&p, p.geometric_normal))
            })
            .sum();
        let radiance = total / SAMPLES.len() as f64;
        (Emitter::Triangle { prim }, triangle_area(world, prim), radiance)
    } else {
        let ball = world.primitives.spheres[prim as usize - triangles];
        let p = world.sphere_point(prim, ball.center + Vec3::new(0.36, 0.48, 0.8) * ball.radius);
        (Emitter::Sphere { prim }, sphere_area(ball.radius), mean(world.emitted(&p, p.geometric_normal)))
    };
    // Textured emission that the samples missed must keep some chance, or its light would be lost.
    let power = f64::from(PI) * f64::from(area) * radiance.max(1e-6);
    (emitter, if power.is_finite() { power } else { 0.0 })
}

/// Linear fall of a spot's intensity from the beam's edge to the cutoff.
fn falloff(angle: f32, cutoff: f32, beam: f32) -> f32 {
    if angle >= cutoff {
        0.0
    } else if angle <= beam {
        1.0
    } else {
        (cutoff - angle) / (cutoff - beam)
    }
}

fn triangle_cross(world: &World, prim: u32) -> Vec3 {
    let [a, b, c] = world.primitives.triangle(prim as usize);
    (b - a).cross(c - a)
}

fn triangle_area(world: &World, prim: u32) -> f32 {
    0.5 * triangle_cross(world, prim).length()
}

fn triangle_normal(world: &World, prim: u32) -> Vec3 {
    triangle_cross(world, prim).try_normalize().unwrap_or(Vec3::Z)
}

fn sphere_area(radius: f32) -> f32 {
    4.0 * PI * radius * radius
}

fn mean(color: Vec3) -> f64 {
    f64::from(color.x + color.y + color.z) / 3.0
}
