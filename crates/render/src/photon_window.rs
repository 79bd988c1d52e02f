//! How strong photons should be: a weight window (Booth and Hendricks, "Importance estimation in forward Monte Carlo calculations",
//! Nuclear Technology/Fusion 5, 1984).
//!
//! Where light from infinity enters a room by windows, photons differ in strength a hundredfold, as their ways are chosen by what
//! few photons of the pilot found, and the strong ones are blotches. Where the light of a surface reaches what is seen, a photon
//! that is too strong goes on as several weak ones, each with directions of its own, and too weak ones go on by chance as few
//! strong ones.

use crate::counters::Counters;
use crate::light::{VisibleRegion, cosine_hemisphere};
use crate::pilot::VisiblePoint;
use crate::trace::Tracer;
use crate::twin::Twin;
use crate::world::World;
use photinus_geometry::{Frame, Ray, Vec3};
use photinus_num::{Sampler, StreamKind};
use photinus_photons::Photon;

/// Cells along each axis of the cube around the visible region.
const CELLS: usize = 32;
/// Rays from each visible point, and bounces of each.
const RAYS: usize = 2;
const BOUNCES: u64 = 2;
/// How far above surfaces rays go on, in cells.
const LIFT: f32 = 1e-3;
/// Photons that one becomes at most.
const MOST: f32 = 64.0;
/// How much stronger photons may be where they do not light what is seen.
const ELSEWHERE: f32 = 8.0;
/// Parts that are split off at most, for each photon that is sent out.
const MOST_SPLIT: f32 = 4.0;
/// Photons that are worth as many equal ones as this share of their number, or more, stay as they are.
const EVEN: f64 = 0.5;
/// Fewest photons of the pilot to judge by.
const FEWEST: usize = 64;

/// The strength that is wanted, and where.
#[derive(Clone, Debug)]
pub(crate) struct PhotonWindow {
    low: Vec3,
    /// Cells per length.
    scale: f32,
    /// Cells that light what is seen, directly or by one bounce.
    cells: Vec<bool>,
    /// Largest channel of the flux of a photon, W, if it were the only one.
    flux: f32,
}

impl PhotonWindow {
    /// What suits photons like those that a pilot pass stored; none where they are about even.
    pub fn learn(
        world: &World,
        region: VisibleRegion,
        points: &[VisiblePoint],
        stored: &[Photon],
        seed: u64,
    ) -> Option<Self> {
        let size = 2.0 * region.radius;
        let low = region.center - Vec3::splat(region.radius);
        let scale = CELLS as f32 / size;
        let mut window = Self { low, scale, cells: vec![false; CELLS * CELLS * CELLS], flux: 0.0 };
        window.mark(world, points, seed);
        let fluxes: Vec<f64> = stored
            .iter()
            .filter(|p| window.contains(p.position()))
            .map(|p| f64::from(p.flux().max_element()))
            .collect();
        let (sum, squares) = fluxes.iter().fold((0.0, 0.0), |(sum, squares), f| (sum + f, squares + f * f));
        let is_even = sum * sum >= EVEN * squares * fluxes.len() as f64;
        if fluxes.len() < FEWEST || is_even {
            return None;
        }
        // As many photons stored as sent out, about as in a room with its lamps inside.
        window.flux = sum as f32;
        (window.flux > 0.0 && window.flux.is_finite()).then_some(window)
    }

    /// Marks the cells of visible points, and of what rays from them meet in one or two bounces.
    fn mark(&mut self, world: &World, points: &[VisiblePoint], seed: u64) {
        let mut starts: Vec<(Vec3, Vec3)> = Vec::new();
        for point in points {
            self.mark_cell(point.position);
            starts.extend([(point.position + point.normal * point.lift, point.normal); RAYS]);
        }
        let mut tracer = Tracer::new(world, Twin::OFF);
        let mut hits = Vec::new();
        for bounce in 0..BOUNCES {
            let rays: Vec<Ray> = (0u32..)
                .zip(&starts)
                .map(|(i, &(origin, normal))| {
                    let mut sampler = Sampler::new(seed, StreamKind::Pilot, 6 << 40 | bounce, i);
                    let (local, _) = cosine_hemisphere(sampler.next_2d());
                    Ray::new(origin, Frame::from_normal(normal).to_world(local))
                })
                .collect();
            tracer.closest(&rays, &mut hits, &mut Counters::default(), |_| 0.5);
            starts.clear();
            for (ray, hit) in rays.iter().zip(&hits).filter(|(_, hit)| hit.is_hit()) {
                let outward = world.outward_normal(ray, hit);
                let normal = if outward.dot(ray.dir) > 0.0 { -outward } else { outward };
                let position = ray.at(hit.t);
                self.mark_cell(position);
                starts.push((position + normal * (LIFT / self.scale), normal));
            }
        }
    }

    fn mark_cell(&mut self, position: Vec3) {
        if let Some(cell) = self.cell(position) {
            self.cells[cell] = true;
        }
    }

    /// What suits better after a pass that sent out `count` photons split off so many: what strong photons go on as costs rays,
    /// wherever those end.
    pub fn eased(&self, split: u64, count: u32) -> Option<Self> {
        let excess = split as f32 / (MOST_SPLIT * count as f32);
        (excess > 1.0).then(|| Self { flux: self.flux * excess, ..self.clone() })
    }

    fn cell(&self, position: Vec3) -> Option<usize> {
        let [x, y, z] = ((position - self.low) * self.scale).to_array();
        let inside = [x, y, z].iter().all(|c| (0.0..CELLS as f32).contains(c));
        inside.then(|| (z as usize * CELLS + y as usize) * CELLS + x as usize)
    }

    /// Whether photons that leave this place are wanted at the window's strength.
    pub fn contains(&self, position: Vec3) -> bool {
        self.cell(position).is_some_and(|cell| self.cells[cell])
    }

    /// The strength that is wanted of the photons of a pass of `count`: largest channel of the flux, W.
    pub fn strength(&self, count: u32) -> f32 {
        self.flux / count as f32
    }

    /// As how many photons one of this strength should go on from a place, on the mean: 1 to [`MOST`].
    pub fn parts(&self, strength: f32, count: u32, position: Vec3) -> f32 {
        let slack = if self.contains(position) { 1.0 } else { ELSEWHERE };
        (strength / (slack * self.strength(count))).clamp(1.0, MOST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_and_cells() {
        let mut window = PhotonWindow {
            low: Vec3::splat(-1.0),
            scale: CELLS as f32 / 2.0,
            cells: vec![false; CELLS * CELLS * CELLS],
            flux: 1000.0,
        };
        assert_eq!(window.strength(500), 2.0);
        let inside = Vec3::new(0.5, -0.25, 0.99);
        let cell = window.cell(inside).unwrap();
        window.cells[cell] = true;
        for (strength, parts) in [(0.1, 1.0), (2.0, 1.0), (7.0, 3.5), (1e9, MOST), (f32::NAN, f32::NAN)] {
            for (position, slack) in [(inside, 1.0), (Vec3::ZERO, ELSEWHERE)] {
                let found = window.parts(strength * slack, 500, position);
                assert!(found == parts || (found.is_nan() && parts.is_nan()), "{strength}: {found}");
            }
        }
        assert!(window.contains(Vec3::new(0.51, -0.24, 0.98)));
        for outside in [Vec3::ZERO, Vec3::splat(1.0), Vec3::splat(-1.01), Vec3::NAN, Vec3::INFINITY] {
            assert!(!window.contains(outside));
        }
    }
}
