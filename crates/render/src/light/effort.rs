//! How many shadow rays a point is worth: few where lights are plain, more where they are many or hidden.

use super::emitter::mean;
use super::lights::Lights;
use crate::counters::Counters;
use crate::pilot::VisiblePoint;
use crate::trace::Tracer;
use crate::twin::Twin;
use crate::world::World;
use photinus_geometry::Ray;
use photinus_num::{Sampler, StreamKind};

/// Points that are tried, and shadow rays for each.
const POINTS: usize = 1024;
const RAYS: u32 = 8;
/// Most shadow rays a point.
const MOST: u32 = 8;
/// What the rest of a pass costs, in shadow rays a pixel, and its variance over the square of the picture's mean (pixels'
/// edges and estimates over some sixty photons). Orders of magnitude, chosen and not fitted: their root is what counts.
const OTHER_COST: f64 = 8.0;
const OTHER_VARIANCE: f64 = 0.03;

/// Shadow rays that each directly visible point should send. With variance v of one, n of them make the error over time
/// (other variance + v / n) (other cost + n) least at n = sqrt(v other cost / other variance).
pub(crate) fn shadow_rays(world: &World, lights: &Lights, points: &[VisiblePoint], seed: u64) -> u32 {
    let step = (points.len() / POINTS).max(1);
    let (mut rays, mut asked) = (Vec::new(), Vec::new());
    let mut tried = 0usize;
    for (i, point) in points.iter().enumerate().step_by(step) {
        let origin = point.position + point.normal * point.lift;
        let place = lights.place(point.position, point.normal);
        for j in 0..RAYS {
            let mut sampler = Sampler::new(seed, StreamKind::Pilot, 4 << 40 | i as u64, j);
            let (u, choice) = (sampler.next_2d(), sampler.next_1d());
            let Some(light) = lights.sample(world, origin, place, choice, u) else { continue };
            asked.push((tried, mean(light.radiance) * f64::from(point.normal.dot(light.dir).max(0.0) / light.pdf)));
            rays.push(match light.target {
                Some(target) => Ray { origin, t_min: 0.0, dir: target - origin, t_max: 1.0 },
                None => Ray::new(origin, light.dir),
            });
        }
        tried += 1;
    }
    let mut visible = Vec::new();
    Tracer::new(world, Twin::OFF).visibility(&rays, &mut visible, &mut Counters::default());
    let mut sums = vec![[0.0f64; 2]; tried];
    for (&(slot, value), &share) in asked.iter().zip(&visible) {
        let arriving = value * f64::from(share);
        sums[slot][0] += arriving;
        sums[slot][1] += arriving * arriving;
    }
    let n = f64::from(RAYS);
    let overall = sums.iter().map(|s| s[0]).sum::<f64>() / (n * tried.max(1) as f64);
    // Dark points count by the light around them: nobody sees noise in the black.
    let floor = (0.3 * overall) * (0.3 * overall);
    let variance = sums
        .iter()
        .map(|[sum, squares]| {
            let mean = sum / n;
            (squares / n - mean * mean).max(0.0) / (mean * mean + floor).max(1e-30)
        })
        .sum::<f64>()
        / tried.max(1) as f64;
    let best = (variance * OTHER_COST / OTHER_VARIANCE).sqrt();
    if best.is_finite() { (best.round() as u32).clamp(1, MOST) } else { 1 }
}
