//! One light of finite distance: what it sends to a point and how its photons start.
//!
//! Wide triangles have several parts, which can be chosen one by one: of a sky behind a window few are in sight.

use super::area::{cosine_hemisphere, uniform_cone, uniform_sphere, uniform_triangle};
use super::lights::LightSample;
use super::panel::{Panel, ShiningPoint, within_part};
use super::sphere;
use crate::shadow_photons::NO_SOURCE;
use crate::{SurfacePoint, world::World};
use photinus_geometry::{Frame, Ray, Vec3};
use std::f32::consts::{PI, TAU};

/// Most parts along the edge of a triangle, and parts of all emitters beyond one each.
pub(super) const MOST_CUTS: u32 = 24;
const MOST_PARTS: u64 = 1 << 16;

/// Cuts triangles into parts no wider than `width`, or than the least power of two times that with which there are not too
/// many.
pub(crate) fn cut(emitters: &mut [Emitter], mut width: f32) {
    loop {
        let beyond = |emitter: &Emitter| match emitter {
            Emitter::Triangle(panel) => u64::from(cuts_for(panel.widest(), width).pow(2) - 1),
            _ => 0,
        };
        if emitters.iter().map(beyond).sum::<u64>() <= MOST_PARTS {
            break;
        }
        width *= 2.0;
    }
    for emitter in emitters {
        if let Emitter::Triangle(panel) = emitter {
            panel.cuts = cuts_for(panel.widest(), width);
        }
    }
}

/// Cuts along an edge of length `widest`; 1 where the ratio is no number.
fn cuts_for(widest: f32, width: f32) -> u32 {
    let cuts = (widest / width).ceil();
    if cuts.is_finite() { (cuts as u32).clamp(1, MOST_CUTS) } else { 1 }
}

/// A primitive that emits, or a light without area.
#[derive(Clone, Debug)]
pub(crate) enum Emitter {
    Triangle(Panel),
    Sphere { prim: u32 },
    Point { position: Vec3, intensity: Vec3 },
    Spot { position: Vec3, frame: Frame, intensity: Vec3, cutoff: f32, beam: f32, one_minus_cos: f32 },
}

impl Emitter {
    /// The emitter that primitive `prim` is, in one part.
    pub fn of_primitive(world: &World, prim: u32) -> Self {
        if (prim as usize) < world.primitives.triangle_count() {
            Self::Triangle(Panel::new(world, prim))
        } else {
            Self::Sphere { prim }
        }
    }

    /// Number of parts.
    pub fn parts(&self) -> u32 {
        match self {
            Self::Triangle(panel) => panel.cuts * panel.cuts,
            _ => 1,
        }
    }

    /// A spot light; angles in radians.
    pub fn spot(position: Vec3, direction: Vec3, intensity: Vec3, cutoff: f32, beam: f32) -> Self {
        let cutoff = cutoff.clamp(1e-4, PI);
        let half = libm::sinf(0.5 * cutoff);
        Self::Spot {
            position,
            frame: Frame::from_normal(direction),
            intensity,
            cutoff,
            beam: beam.clamp(0.0, cutoff),
            one_minus_cos: 2.0 * half * half,
        }
    }

    /// About the power that a part sends out, W, mean of the channels; positive for everything that may emit.
    pub fn power(&self, world: &World, part: u32) -> f64 {
        let power = match self {
            Self::Triangle(panel) => {
                // A texture may be dark at any one point: look at several before calling the triangle dark.
                const SAMPLES: [[f32; 2]; 7] =
                    [[0.33, 0.33], [0.1, 0.1], [0.8, 0.1], [0.1, 0.8], [0.45, 0.1], [0.1, 0.45], [0.45, 0.45]];
                let total: f64 = SAMPLES
                    .iter()
                    .map(|&at| mean(panel.point(world, within_part(panel.cuts, part, at)).radiance))
                    .sum();
                let area = panel.part_area();
                // Textured emission that the samples missed must keep some chance, or its light would be lost.
                f64::from(PI) * f64::from(area) * (total / SAMPLES.len() as f64).max(1e-6)
            }
            Self::Sphere { prim } => {
                let ball = ball(world, *prim);
                let p = world.sphere_point(*prim, ball.center + Vec3::new(0.36, 0.48, 0.8) * ball.radius);
                let radiance = mean(world.emitted(&p, p.geometric_normal)).max(1e-6);
                f64::from(PI) * f64::from(sphere_area(ball.radius)) * radiance
            }
            Self::Point { intensity, .. } => 4.0 * f64::from(PI) * mean(*intensity),
            Self::Spot { intensity, one_minus_cos, .. } => f64::from(TAU * one_minus_cos) * mean(*intensity),
        };
        if power.is_finite() { power } else { 0.0 }
    }

    /// Area of each part; 1 for lights without area.
    pub fn area(&self, world: &World) -> f32 {
        match self {
            Self::Triangle(panel) => panel.part_area(),
            Self::Sphere { prim } => sphere_area(ball(world, *prim).radius),
            Self::Point { .. } | Self::Spot { .. } => 1.0,
        }
    }

    /// Middle of a part, and the direction that it faces; zero where it shines all around.
    pub fn place(&self, world: &World, part: u32) -> (Vec3, Vec3) {
        match self {
            Self::Triangle(panel) => (panel.place(within_part(panel.cuts, part, [1.0 / 3.0; 2])), panel.normal()),
            Self::Sphere { prim } => (ball(world, *prim).center, Vec3::ZERO),
            Self::Point { position, .. } => (*position, Vec3::ZERO),
            Self::Spot { position, frame, .. } => (*position, frame.n),
        }
    }

    /// A point on a part as seen from `from`; the density is over solid angle, or 1 for lights without area.
    pub fn sample(&self, world: &World, part: u32, from: Vec3, u: [f32; 2]) -> LightSample {
        match self {
            Self::Triangle(panel) => {
                let light = panel.sample(world, part, u);
                let to = light.position - from;
                let distance_sq = to.length_squared();
                let dir = to / distance_sq.sqrt();
                let cos = light.normal.dot(dir).abs();
                let pdf = distance_sq / (cos * panel.part_area()).max(1e-30);
                of_surface(&light, dir, pdf)
            }
            Self::Sphere { prim } => {
                let ball = ball(world, *prim);
                match sphere::sample(&ball, from, u) {
                    Some((dir, at, pdf)) => of_surface(&ball_point(world, *prim, at), dir, pdf),
                    None => {
                        let light = ball_point(world, *prim, ball.center + uniform_sphere(u) * ball.radius);
                        let to = light.position - from;
                        let distance_sq = to.length_squared();
                        let dir = to / distance_sq.sqrt();
                        let cos = light.normal.dot(dir).abs();
                        of_surface(&light, dir, distance_sq / (cos * sphere_area(ball.radius)).max(1e-30))
                    }
                }
            }
            Self::Point { position, intensity } => {
                let to = *position - from;
                let distance_sq = to.length_squared();
                without_area(to / distance_sq.sqrt(), *position, *intensity / distance_sq)
            }
            Self::Spot { position, frame, intensity, cutoff, beam, .. } => {
                let to = *position - from;
                let distance_sq = to.length_squared();
                let dir = to / distance_sq.sqrt();
                let factor = falloff(libm::acosf((-dir).dot(frame.n).clamp(-1.0, 1.0)), *cutoff, *beam);
                without_area(dir, *position, *intensity * (factor / distance_sq))
            }
        }
    }

    /// The part that the point `at` lies on.
    pub fn part_of(&self, at: &SurfacePoint) -> u32 {
        match self {
            Self::Triangle(panel) => panel.part_of(at.position),
            _ => 0,
        }
    }

    /// Density over solid angle with which [`Emitter::sample`] at `from` finds the point `at`, which lies on the part
    /// that is sampled.
    pub fn pdf(&self, world: &World, from: Vec3, at: &SurfacePoint) -> f32 {
        let by_area = |normal: Vec3, area: f32| {
            let to = at.position - from;
            let distance_sq = to.length_squared();
            let cos = normal.dot(to).abs() / distance_sq.sqrt();
            distance_sq / (cos * area).max(1e-30)
        };
        match self {
            Self::Triangle(panel) => by_area(panel.normal(), panel.part_area()),
            Self::Sphere { prim } => {
                let ball = ball(world, *prim);
                match sphere::cone(&ball, from) {
                    Some(one_minus_cos) => 1.0 / (TAU * one_minus_cos),
                    None => by_area(at.geometric_normal, sphere_area(ball.radius)),
                }
            }
            Self::Point { .. } | Self::Spot { .. } => 0.0,
        }
    }

    /// The way of a photon from anywhere on it, and its flux if it were the only one.
    pub fn start(&self, world: &World, place: [f32; 2], way: [f32; 2]) -> (Ray, Vec3) {
        match self {
            Self::Triangle(panel) => lambertian(&panel.point(world, uniform_triangle(place)), way, panel.area()),
            Self::Sphere { prim } => {
                let ball = ball(world, *prim);
                let light = ball_point(world, *prim, ball.center + uniform_sphere(place) * ball.radius);
                lambertian(&light, way, sphere_area(ball.radius))
            }
            Self::Point { position, intensity } => (Ray::new(*position, uniform_sphere(way)), *intensity * (4.0 * PI)),
            Self::Spot { position, frame, intensity, cutoff, beam, one_minus_cos } => {
                let local = uniform_cone(way, *one_minus_cos);
                let factor = falloff(libm::acosf(local.z.clamp(-1.0, 1.0)), *cutoff, *beam);
                (Ray::new(*position, frame.to_world(local)), *intensity * (factor * TAU * one_minus_cos))
            }
        }
    }
}

fn of_surface(light: &ShiningPoint, dir: Vec3, pdf: f32) -> LightSample {
    let (target, radiance) = (Some(light.ray_origin(-dir)), light.radiance_to(-dir));
    LightSample { dir, target, radiance, pdf, delta: false, item: 0, source: NO_SOURCE }
}

fn without_area(dir: Vec3, position: Vec3, radiance: Vec3) -> LightSample {
    LightSample { dir, target: Some(position), radiance, pdf: 1.0, delta: true, item: 0, source: NO_SOURCE }
}

fn lambertian(light: &ShiningPoint, u: [f32; 2], area: f32) -> (Ray, Vec3) {
    let (local, _) = cosine_hemisphere(u);
    let dir = Frame::from_normal(light.normal).to_world(local);
    (Ray::new(light.ray_origin(dir), dir), light.radiance * (PI * area))
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

fn ball_point(world: &World, prim: u32, near: Vec3) -> ShiningPoint {
    ShiningPoint::of_surface(world, &world.sphere_point(prim, near))
}

fn ball(world: &World, prim: u32) -> photinus_geometry::Sphere {
    world.primitives.spheres[prim as usize - world.primitives.triangle_count()]
}

fn sphere_area(radius: f32) -> f32 {
    4.0 * PI * radius * radius
}

/// Mean of the channels.
pub(crate) fn mean(color: Vec3) -> f64 {
    f64::from(color.x + color.y + color.z) / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_as_narrow_as_asked_for_and_few() {
        assert_eq!(cuts_for(1.0, 2.0), 1);
        assert_eq!(cuts_for(1.0, 0.3), 4);
        assert_eq!(cuts_for(1.0, 1e-9), MOST_CUTS);
        for (widest, width) in [(0.0, 0.0), (f32::INFINITY, 1.0), (f32::NAN, 1.0), (1.0, 0.0)] {
            assert_eq!(cuts_for(widest, width), 1);
        }
    }
}
