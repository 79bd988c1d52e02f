//! How much of an estimate's disc is surface.
//!
//! A density estimate divides the light found by the area of a disc. Where a wall, the rim of a table or a body that stands on
//! the floor cuts the disc, no photon can land on the part cut off, and the estimate is too dark by the share of that part:
//! dark seams, which no number of photons removes while the radius is wider than they are. Points of the disc, drawn in
//! proportion to the kernel, tell the share that is there (the boundary correction of kernel density estimates: Jones,
//! "Simple boundary correction for kernel density estimation", Statistics and Computing 3, 1993).
//!
//! Looking costs rays, so it is done everywhere in the first pass, and later only around pixels where the pass before saw
//! a disc cut: radii do not grow.

use crate::counters::Counters;
use crate::maps::Estimate;
use crate::trace::Tracer;
use crate::world::World;
use photinus_geometry::{Frame, Hit, Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use photinus_photons::Kernel;
use photinus_profile::queries::RayKind;
use std::sync::atomic::{AtomicBool, Ordering};

/// Points of the disc of an estimate that is all there is in its pixel, and of one that hardly counts.
const MOST_POINTS: f32 = 8.0;
const FEWEST_POINTS: f32 = 3.0;
/// How many points of an estimate's disc are worth looking at where it is this part, 0 to 1, of the light of its pixel.
pub(crate) fn points_for(part: f32) -> u32 {
    if part > 0.0 { (MOST_POINTS * part).ceil().clamp(FEWEST_POINTS, MOST_POINTS) as u32 } else { 0 }
}

/// What a missing point takes off a disc: a little less than its part, as the mean of the inverse of a share that is a matter
/// of chance is more than the inverse of its mean. A quarter of a point makes up for that: within 0.5 % where half of the disc
/// is missing, and 2 % where three quarters are.
fn part(points: u32) -> f32 {
    (1.0 - 0.25 / points as f32) / points as f32
}

/// Edge of the squares of pixels of which the first pass looks at one first; a tile's edge is a multiple.
const COARSE: u32 = 2;
/// How far above the surface rays run along it, in radii: over what is too low to matter.
const HEIGHT: f32 = 0.03;
/// Least share: a corner of three walls leaves a quarter, and a few points may miss it.
const LEAST_SHARE: f32 = 0.125;
/// Most: a surface that bends has more of it within the radius than a plane.
const MOST_SHARE: f32 = 2.0;
/// Differences from a plane that are none.
const ROUNDING: f32 = 1e-3;
/// Least cosine between normals of photons and query, as searches have it.
const LEAST_COSINE: f32 = 0.5;

/// Pixels whose estimates are near something that cuts their discs.
pub(crate) struct CutPixels {
    width: usize,
    /// Whether a pass has looked.
    is_known: bool,
    /// By the pass before, row by row.
    before: Vec<bool>,
    now: Vec<AtomicBool>,
}

impl CutPixels {
    /// Nothing is known of a window of this size.
    pub fn new(width: u32, height: u32) -> Self {
        let count = width as usize * height as usize;
        let now = (0..count).map(|_| AtomicBool::new(false)).collect();
        Self { width: width as usize, is_known: false, before: vec![false; count], now }
    }

    /// Ends a pass: what it saw steers the next.
    pub fn advance(&mut self) {
        for (before, now) in self.before.iter_mut().zip(&mut self.now) {
            *before = std::mem::take(now.get_mut());
        }
        self.is_known = true;
    }

    /// Forgets what an unfinished pass saw: the next one begins as that did.
    pub fn forget(&mut self) {
        self.now.iter_mut().for_each(|now| *now.get_mut() = false);
    }

    /// Whether the pass before saw a disc cut here or next to here, as samples of a pixel fall anywhere in it.
    fn were_cut(&self, place: [u32; 2]) -> bool {
        self.around(place).any(|i| self.before[i])
    }

    /// The same of this pass. Only what the caller's own tile has seen is sure to be there: a tile ends where a square of
    /// [`COARSE`] pixels ends, and nothing is asked beyond it.
    fn are_cut(&self, [x, y]: [u32; 2]) -> bool {
        let seen = [x, y].map(|c| c - c % COARSE);
        self.now[self.index(seen)].load(Ordering::Relaxed)
    }

    fn saw_cut(&self, place: [u32; 2]) {
        self.now[self.index(place)].store(true, Ordering::Relaxed);
    }

    fn index(&self, [x, y]: [u32; 2]) -> usize {
        y as usize * self.width + x as usize
    }

    /// A pixel and its neighbours.
    fn around(&self, [x, y]: [u32; 2]) -> impl Iterator<Item = usize> {
        let [x, y] = [x as usize, y as usize];
        let (width, height) = (self.width, self.before.len() / self.width);
        let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
        (y.saturating_sub(1)..=(y + 1).min(height - 1)).flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }
}

/// How an estimate's disc is looked at.
#[derive(Clone, Copy)]
pub(crate) struct Look {
    pub radius: f32,
    /// Points that are looked at.
    pub count: u32,
}

/// A point of a disc that is looked at.
struct Point {
    estimate: usize,
    position: Vec3,
    /// How far below it a photon may lie and be found, squared.
    depth_sq: f32,
    /// How far above the surface rays run.
    height: f32,
    /// Heights that differ by less do so by rounding.
    offset: f32,
    /// Numbers for surfaces that let a part of the light through.
    draws: Sampler,
}

/// Looks at the discs of a batch of estimates.
pub(crate) struct Looker<'a> {
    pub world: &'a World,
    pub kernel: Kernel,
    pub pixels: &'a CutPixels,
    pub seed: u64,
    /// The window's first pixel of the film.
    pub origin: [u32; 2],
    /// Number of the sample over all passes.
    pub sample: u32,
}

impl Looker<'_> {
    /// The share of each estimate's disc that is surface, `LEAST_SHARE` to `MOST_SHARE`, one `look` each. `pixel` gives the place of
    /// a path in the window.
    pub fn shares(
        &self,
        estimates: &[Estimate],
        looks: &[Look],
        pixel: impl Fn(u32) -> [u32; 2],
        tracer: &mut Tracer,
        counters: &mut Counters,
    ) -> Vec<f32> {
        let mut shares = vec![1.0; estimates.len()];
        if self.pixels.is_known {
            self.look(estimates, looks, &pixel, |place| self.pixels.were_cut(place), &mut shares, tracer, counters);
        } else {
            // One pixel of a square first, then the others of those squares where a disc is cut.
            let is_first = |place: [u32; 2]| place.iter().all(|c| c % COARSE == 0);
            self.look(estimates, looks, &pixel, is_first, &mut shares, tracer, counters);
            let is_next = |place| !is_first(place) && self.pixels.are_cut(place);
            self.look(estimates, looks, &pixel, is_next, &mut shares, tracer, counters);
        }
        shares
    }

    /// Looks at the discs of those pixels that are wanted.
    fn look(
        &self,
        estimates: &[Estimate],
        looks: &[Look],
        pixel: impl Fn(u32) -> [u32; 2],
        is_wanted: impl Fn([u32; 2]) -> bool,
        shares: &mut [f32],
        tracer: &mut Tracer,
        counters: &mut Counters,
    ) {
        let mut points = Vec::new();
        for (i, e) in estimates.iter().enumerate().filter(|(_, e)| is_wanted(pixel(e.path))) {
            self.add_points(i, e, looks[i], pixel(e.path), &mut points);
        }
        for (i, lost) in self.lost(estimates, points, tracer, counters) {
            shares[i] -= lost * part(looks[i].count);
            if lost == 1.0 {
                self.pixels.saw_cut(pixel(estimates[i].path));
            }
        }
        shares.iter_mut().for_each(|share| *share = share.clamp(LEAST_SHARE, MOST_SHARE));
    }

    fn add_points(&self, estimate: usize, e: &Estimate, look: Look, [x, y]: [u32; 2], points: &mut Vec<Point>) {
        let Look { radius, count } = look;
        let frame = Frame::from_normal(e.query.normal);
        let stream = u64::from(self.origin[1] + y) << 32 | u64::from(self.origin[0] + x);
        let shift = Sampler::new(self.seed, StreamKind::Support, stream, self.sample).next_2d();
        for i in 0..count {
            // Steps of the plastic number's powers fill the square evenly (Roberts 2018, the R2 sequence).
            let step = |u: f32, by: f32| (u + i as f32 * by).fract();
            let [u, v] = [step(shift[0], 0.754_877_7), step(shift[1], 0.569_840_3)];
            // The part of the kernel's integral within a distance d: d^2 / r^2 for the constant one, 2 s - s^2 of that for
            // Epanechnikov's.
            let s = if self.kernel == Kernel::Epanechnikov { 1.0 - (1.0 - u).sqrt() } else { u };
            let (sin, cos) = libm::sincosf(std::f32::consts::TAU * v);
            let distance = radius * s.sqrt();
            points.push(Point {
                estimate,
                position: e.query.position + (frame.s * cos + frame.t * sin) * distance,
                depth_sq: (radius * radius * (1.0 - s)).max(0.0),
                height: (radius * HEIGHT).max(e.offset),
                offset: e.offset,
                draws: Sampler::new(self.seed, StreamKind::Support, stream | u64::from(i + 1) << 60, self.sample),
            });
        }
    }

    /// The estimates of those points that are not there, or not with the weight that they have on a plane, and how much of that
    /// weight is lost: 1 where there is no surface.
    fn lost(
        &self,
        estimates: &[Estimate],
        points: Vec<Point>,
        tracer: &mut Tracer,
        counters: &mut Counters,
    ) -> Vec<(usize, f32)> {
        let query = |point: &Point| &estimates[point.estimate].query;
        let above = |point: &Point| query(point).normal * point.height;
        let along = |point: &Point| {
            let origin = query(point).position + above(point);
            Ray { t_max: 1.0, ..Ray::new(origin, point.position - query(point).position) }
        };
        let back = |point: &Point| {
            let origin = point.position + above(point);
            Ray { t_max: 1.0, ..Ray::new(origin, query(point).position - point.position) }
        };
        let down = |point: &Point| {
            let origin = point.position + above(point);
            Ray {
                t_max: point.height + point.depth_sq.sqrt().max(point.height),
                ..Ray::new(origin, -query(point).normal)
            }
        };
        let mut lost = Vec::new();
        // Along the surface: the way is free, or a surface that is found rises into it, or something stands there.
        let (mut free, mut blocked) = (Vec::new(), Vec::new());
        self.trace(points, along, estimates, tracer, counters, |point, ray, hit| match hit {
            None => free.push(point),
            Some((normal, _)) if facing(normal, ray).dot(query(&point).normal) >= LEAST_COSINE => (),
            Some(_) => blocked.push(point),
        });
        // Back from behind what stands there: a thin thing has a free side, inside a body or behind a wall there is none.
        self.trace(blocked, back, estimates, tracer, counters, |point, ray, hit| match hit {
            Some((normal, _)) if normal.dot(ray.dir) > 0.0 => lost.push((point.estimate, 1.0)),
            _ => free.push(point),
        });
        self.trace(free, down, estimates, tracer, counters, |point, ray, hit| {
            let cos = hit.map_or(0.0, |(normal, _)| facing(normal, ray).dot(query(&point).normal));
            let drop = hit.map_or(0.0, |(_, t)| ((t - point.height).abs() - point.offset).max(0.0));
            let share = if cos >= LEAST_COSINE { self.weight(&point, drop) / cos } else { 0.0 };
            if (share - 1.0).abs() > ROUNDING {
                lost.push((point.estimate, 1.0 - share));
            }
        });
        lost
    }

    /// The weight of a photon that lies so far below a point, over that of one at the point itself.
    fn weight(&self, point: &Point, drop: f32) -> f32 {
        match self.kernel {
            Kernel::Epanechnikov if point.depth_sq > 0.0 => (1.0 - drop * drop / point.depth_sq).max(0.0),
            _ => 1.0,
        }
    }

    /// Traces a ray for each point and hands the normal where it hits, towards the outside, and the ray's parameter to `take` where it hits.
    fn trace(
        &self,
        mut points: Vec<Point>,
        ray: impl Fn(&Point) -> Ray,
        estimates: &[Estimate],
        tracer: &mut Tracer,
        counters: &mut Counters,
        mut take: impl FnMut(Point, &Ray, Option<(Vec3, f32)>),
    ) {
        let rays: Vec<Ray> = points.iter().map(ray).collect();
        let mut hits: Vec<Hit> = Vec::new();
        counters.rays.support += rays.len() as u64;
        tracer.ask(points.iter().map(|point| (RayKind::Support, estimates[point.estimate].ray)));
        tracer.closest(&rays, &mut hits, counters, |i| points[i].draws.next_1d());
        for ((point, ray), hit) in points.into_iter().zip(&rays).zip(&hits) {
            let normal = hit.is_hit().then(|| (self.world.outward_normal(ray, hit), hit.t));
            take(point, ray, normal);
        }
    }
}

/// A normal turned against a ray.
fn facing(normal: Vec3, ray: &Ray) -> Vec3 {
    if normal.dot(ray.dir) > 0.0 { -normal } else { normal }
}
