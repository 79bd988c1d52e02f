//! How much of an estimate's disc is surface.
//!
//! A density estimate divides the light found by the area of a disc. Where a wall, the rim of a table or a body that stands on
//! the floor cuts the disc, no photon can land on the part cut off, and the estimate is too dark by the share of that part:
//! dark seams, which no number of photons removes while the radius is wider than they are. Points of the disc, drawn in
//! proportion to the kernel, tell the share that is there (the boundary correction of kernel density estimates: Jones,
//! "Simple boundary correction for kernel density estimation", Statistics and Computing 3, 1993).
//!
//! Which pixels are looked at, and how often: [`CutPixels`].

use crate::counters::Counters;
use crate::cut_pixels::{COARSE, CutPixels, Seen};
use crate::maps::Estimate;
use crate::trace::Tracer;
use crate::world::World;
use photinus_geometry::{Frame, Hit, Ray, Vec3};
use photinus_num::{Sampler, StreamKind, unit_f32};
use photinus_photons::Kernel;
use photinus_profile::queries::RayKind;
use std::ops::Range;

/// Steps of points that fill the square evenly, as those of [`R2`](crate::eye_pass::R2), in units of 2^-32.
const STEPS: [u32; 2] = [3_242_174_889, 2_447_445_414];

/// Points of the disc of an estimate that is all there is in its pixel, and of one that hardly counts.
const MOST_POINTS: f32 = 8.0;
const FEWEST_POINTS: f32 = 3.0;
/// Points of an estimate that is seen in a mirror or behind glass: later passes see another place.
const POINTS_ELSEWHERE: u32 = 3;
/// So many times as many where something is missing.
const MORE_POINTS: u32 = 3;
/// How many points of an estimate's disc are worth looking at where it is this part, 0 to 1, of the light of its pixel.
pub(crate) fn points_for(part: f32) -> u32 {
    if part > 0.0 { (MOST_POINTS * part).ceil().clamp(FEWEST_POINTS, MOST_POINTS) as u32 } else { 0 }
}

/// What a missing point takes off a disc: a little less than its part, as the mean of the inverse of a share that is a matter
/// of chance is more than the inverse of its mean. For points that are drawn alone it would be 1 / (points + 1), which is right
/// to within the chance that all are missing; ours are spread. Where a wall or a corner of two takes off up to a half of the
/// disc, the mean of the inverse is within 7 % for 3 points, 3 % for 8 and 1 % for 24.
fn part(points: f32) -> f32 {
    1.0 / (points + 0.2 + 0.9 / points.max(1.0))
}

/// How far above the surface rays run along it, in radii: over what is too low to matter.
const HEIGHT: f32 = 0.03;
/// Least share: a corner of three walls leaves a quarter, and a few points may miss it.
const LEAST_SHARE: f32 = 0.125;
/// Most. Surfaces are counted from either side, as it is not known which of them are open: a plate thinner than the radius has
/// more than a plane, and keeps its brightness.
const MOST_SHARE: f32 = 1.0;
/// Surfaces that a line through a disc meets at most.
const MOST_LAYERS: usize = 6;
/// Step from one to the next, in heights.
const STEP: f32 = 0.01;
/// The row of pixels that estimates at photons have the random numbers of: beyond all pictures.
const ROW_OF_PHOTONS: u32 = 1 << 19;
/// Differences from a plane that are none.
const ROUNDING: f32 = 1e-3;
/// Least cosine between normals of photons and query, as searches have it.
const LEAST_COSINE: f32 = 0.5;

/// How an estimate's disc is looked at.
#[derive(Clone, Copy)]
pub(crate) struct Look {
    pub radius: f32,
    /// Photons per area.
    pub density: f32,
    /// Points that are looked at.
    pub count: u32,
}

/// A point of a disc that is looked at.
struct Point {
    estimate: usize,
    position: Vec3,
    /// Its squared distance from the middle.
    distance_sq: f32,
    /// How far above or below it a photon may lie and be found, squared.
    depth_sq: f32,
    /// How far above the surface rays run along it.
    height: f32,
    /// Heights that differ by less do so by rounding.
    offset: f32,
    /// Numbers for surfaces that let a part of the light through.
    draws: Sampler,
    /// Something stands there.
    is_covered: bool,
    /// How far below the point the line through it has been followed.
    at: f32,
    /// What the line has met so far, over what it would meet on a plane.
    share: f32,
}

impl Point {
    fn depth(&self) -> f32 {
        self.depth_sq.sqrt().max(self.height)
    }
}

/// Looks at the discs of a batch of estimates.
pub(crate) struct Looker<'a> {
    pub world: &'a World,
    pub kernel: Kernel,
    /// What passes know; none of estimates at photons.
    pub pixels: Option<&'a CutPixels>,
    pub seed: u64,
    /// The window's first pixel of the film.
    pub origin: [u32; 2],
    /// Number of the sample in its pass, and over all passes.
    pub sample: [u32; 2],
}

impl<'a> Looker<'a> {
    /// Looks at the discs of estimates at photons, number `first` and those that follow.
    pub fn of_photons(world: &'a World, kernel: Kernel, seed: u64, first: u32) -> Self {
        Self { world, kernel, pixels: None, seed, origin: [first, ROW_OF_PHOTONS], sample: [0; 2] }
    }

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
        let Some(pixels) = self.pixels else { return shares };
        if pixels.is_known() {
            self.look(estimates, looks, &pixel, |place| pixels.were_cut(place), &mut shares, tracer, counters);
        } else {
            // One pixel of a square first, then the others of those squares where a disc is cut.
            let is_first = |place: [u32; 2]| place.iter().all(|c| c % COARSE == 0);
            self.look(estimates, looks, &pixel, is_first, &mut shares, tracer, counters);
            let is_next = |place| !is_first(place) && pixels.are_cut(place);
            self.look(estimates, looks, &pixel, is_next, &mut shares, tracer, counters);
        }
        shares
    }

    /// The share of each disc that is surface, of estimates at photons, which no pixel and no pass before knows of; one radius
    /// each.
    pub fn shares_of_photons(
        &self,
        estimates: &[Estimate],
        radii: &[f32],
        tracer: &mut Tracer,
        counters: &mut Counters,
    ) -> Vec<f32> {
        let mut lost = vec![0.0; estimates.len()];
        let mut used = vec![0; estimates.len()];
        // Where something is missing, more points tell how much.
        for stage in [1, MORE_POINTS] {
            let mut points = Vec::new();
            for (i, e) in estimates.iter().enumerate().filter(|(i, _)| stage == 1 || lost[*i] > 0.0) {
                let range = used[i]..POINTS_ELSEWHERE * stage;
                used[i] = range.end;
                self.add_points(i, e, radii[i], range, [i as u32, 0], &mut points);
            }
            for (i, part) in self.lost(estimates, points, tracer, counters) {
                lost[i] += part;
            }
        }
        let share = |(lost, used): (f32, u32)| (1.0 - lost * part(used as f32)).clamp(LEAST_SHARE, MOST_SHARE);
        lost.into_iter().zip(used).map(share).collect()
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
        let Some(pixels) = self.pixels else { return };
        let wanted: Vec<usize> = (0..estimates.len()).filter(|&i| is_wanted(pixel(estimates[i].path))).collect();
        let mut seen: Vec<Seen> = estimates.iter().zip(looks).map(|_| Seen::default()).collect();
        for &i in &wanted {
            let e = &estimates[i];
            let before = if e.is_first { pixels.seen(pixel(e.path)) } else { Seen::default() };
            seen[i] = before.turned_to(e, looks[i]);
        }
        // Where something is missing, more points tell how much.
        for stage in [1, MORE_POINTS] {
            let mut points = Vec::new();
            for &i in wanted.iter().filter(|i| looks[**i].count > 0) {
                let seen = &mut seen[i];
                let count = if estimates[i].is_first { looks[i].count } else { looks[i].count.min(POINTS_ELSEWHERE) };
                if stage == 1 || (estimates[i].is_first && seen.lost > 0.0) {
                    let missing = ((count * stage) as f32 - seen.points).ceil() as u32;
                    let new = if stage == 1 { missing.max(1) } else { missing };
                    self.add_points(
                        i,
                        &estimates[i],
                        looks[i].radius,
                        seen.used..seen.used + new,
                        pixel(estimates[i].path),
                        &mut points,
                    );
                    seen.used += new;
                    seen.points += new as f32;
                }
            }
            for (i, lost) in self.lost(estimates, points, tracer, counters) {
                seen[i].lost += lost;
                if lost == 1.0 {
                    seen[i].is_cut = true;
                    pixels.saw_cut(pixel(estimates[i].path));
                }
            }
        }
        for &i in wanted.iter().filter(|i| looks[**i].count > 0) {
            shares[i] = (1.0 - seen[i].lost * part(seen[i].points)).clamp(LEAST_SHARE, MOST_SHARE);
        }
        let first = wanted.into_iter().filter(|&i| estimates[i].is_first && seen[i].points > 0.0);
        let new = first.map(|i| (pixels.index(pixel(estimates[i].path)) as u32, seen[i]));
        pixels.add_new(new.collect());
    }

    fn add_points(
        &self,
        estimate: usize,
        e: &Estimate,
        radius: f32,
        range: Range<u32>,
        [x, y]: [u32; 2],
        points: &mut Vec<Point>,
    ) {
        let frame = Frame::from_normal(e.query.normal);
        let stream = u64::from(self.origin[1] + y) << 32 | u64::from(self.origin[0] + x);
        // One sequence for all that the camera sees directly in a pixel, others for what else is seen there.
        let [own, sample] = self.sample;
        let shift =
            Sampler::new(self.seed, StreamKind::Support, stream, if e.is_first { own } else { !sample }).next_2d();
        for i in range {
            let step = |u: f32, by: u32| (u + unit_f32(i.wrapping_mul(by))).fract();
            let [u, v] = [step(shift[0], STEPS[0]), step(shift[1], STEPS[1])];
            let s = self.kernel.square_within(u);
            let (sin, cos) = libm::sincosf(std::f32::consts::TAU * v);
            let distance = radius * s.sqrt();
            let mut point = Point {
                estimate,
                position: e.query.position + (frame.s * cos + frame.t * sin) * distance,
                distance_sq: distance * distance,
                depth_sq: (radius * radius * (1.0 - s)).max(0.0),
                height: (radius * HEIGHT).max(e.offset),
                offset: e.offset,
                draws: Sampler::new(self.seed, StreamKind::Support, stream | u64::from(i + 1) << 52, sample),
                is_covered: false,
                at: 0.0,
                share: 0.0,
            };
            point.at = -point.depth();
            points.push(point);
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
            // What lies below a body is covered by it.
            let end = if point.is_covered { -point.height } else { point.depth() };
            let origin = point.position - query(point).normal * point.at;
            Ray { t_max: end - point.at, ..Ray::new(origin, -query(point).normal) }
        };
        let outward = |point: &Point, normal: Vec3| normal * estimates[point.estimate].side;
        // Along the surface: the way is free, or something stands there.
        let (mut lines, mut blocked) = (Vec::new(), Vec::new());
        self.trace(points, along, estimates, tracer, counters, |point, _, hit| match hit {
            None => lines.push(point),
            Some(_) => blocked.push(point),
        });
        // Back from behind what stands there: a thin thing has a free side, the inside of a body none.
        self.trace(blocked, back, estimates, tracer, counters, |mut point, ray, hit| {
            point.is_covered = hit.is_some_and(|(normal, _)| outward(&point, normal).dot(ray.dir) > 0.0);
            lines.push(point);
        });
        let mut ended = Vec::new();
        for _ in 0..MOST_LAYERS {
            let mut next = Vec::new();
            self.trace(lines, down, estimates, tracer, counters, |mut point, _, hit| {
                let Some((normal, t)) = hit else {
                    ended.push(point);
                    return;
                };
                let at = point.at + t;
                let cos = normal.dot(query(&point).normal).abs();
                if cos >= LEAST_COSINE {
                    point.share += self.weight(&point, (at.abs() - point.offset).max(0.0)) / cos;
                }
                point.at = at + STEP * point.height + point.offset;
                next.push(point);
            });
            lines = next;
            if lines.is_empty() {
                break;
            }
        }
        ended.extend(lines);
        let is_other = |point: &Point| (point.share - 1.0).abs() > ROUNDING;
        ended.into_iter().filter(is_other).map(|point| (point.estimate, 1.0 - point.share)).collect()
    }

    /// The weight of a photon that lies so far below a point, over that of one at the point itself.
    fn weight(&self, point: &Point, drop: f32) -> f32 {
        match self.kernel {
            Kernel::Epanechnikov if point.depth_sq > 0.0 => (1.0 - drop * drop / point.depth_sq).max(0.0),
            Kernel::Constant | Kernel::Epanechnikov => 1.0,
            Kernel::Cone { .. } | Kernel::Gaussian => {
                let radius = (point.distance_sq + point.depth_sq).sqrt();
                let weight = |distance_sq: f32| self.kernel.weight(distance_sq.min(radius * radius), radius);
                let own = weight(point.distance_sq);
                if own > 0.0 { weight(point.distance_sq + drop * drop) / own } else { 1.0 }
            }
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
