//! Companions of a visible point: more places of its pixel, on the plane of its surface, that the caustic map is
//! asked about.
//!
//! Where a caustic ends sharply, its rim crosses pixels, and one place a pixel and pass is most of the error. A
//! camera ray costs far more than a search of the map: the tangent plane stands for the surface within a pixel.
//! Together with the point itself the places are a lattice of five shifted at random, so that each is spread over the
//! pixel as camera rays are, or of 17 where passes before saw a rim. Where a surface ends inside of the pixel, its
//! plane goes on for that pixel only.

use crate::eye_pass::{EyePass, Path};
use crate::maps::{Estimate, Estimated};
use crate::tile::Tile;
use photinus_photons::GatherQuery;

/// Places of a pixel, and the step of their lattice (see [`place`]); and where a rim crosses it.
const PLACES: [u32; 2] = [5, 2];
const RIM_PLACES: [u32; 2] = [17, 4];
/// Part of the map's radius that is enough there: many places make one estimate of the pixel.
const RIM_SCALE: f32 = 0.5;
/// A rim crosses a pixel where one place has less than this share of the light of another one ...
const RIM: f32 = 0.5;
/// ... whose photons are so many that it is not by chance.
const RIM_PHOTONS: f32 = 8.0;
/// Maps with radii of more pixels than this have no rims that are sharper than their estimates.
const SHARP: f32 = 8.0;
/// Places farther from the point than this share of its distance from the camera are no part of the same surface.
const FAR: f32 = 0.1;

impl EyePass<'_> {
    /// Adds the companions of what the camera sees directly, where the caustic map is fine enough; they share the estimate
    /// with it.
    pub(crate) fn add_companions(
        &self,
        path: &Path,
        tile: &Tile,
        estimate: &mut Estimate,
        companions: &mut Vec<Estimate>,
    ) {
        let Some(caustic) = self.maps.and_then(|maps| maps.caustic.as_ref()) else { return };
        if caustic.radius > SHARP * path.width {
            return;
        }
        let [x, y] = self.film_pixel(tile.place, path.pixel);
        let mut sampler = self.camera_sampler([x, y], tile.sample);
        let u = sampler.next_2d();
        let own_weight = tile.weights[path.pixel as usize];
        let first = companions.len();
        let has_rim = self.cut_pixels.is_some_and(|pixels| pixels.has_rim(tile.window_pixel(path.pixel)));
        let [places, step] = if has_rim { RIM_PLACES } else { PLACES };
        // Wider than the pixel the discs of its places are nearly one.
        let caustic_scale = if has_rim && RIM_SCALE * caustic.radius <= path.width { RIM_SCALE } else { 1.0 };
        for number in 1..places {
            let shift = place(number, places, step);
            let u = [(u[0] + shift[0]).fract(), (u[1] + shift[1]).fract()];
            let ([dx, dy], weight) = self.film_offset(u);
            let ray = self.camera.ray([x as f32 + 0.5 + dx, y as f32 + 0.5 + dy], &mut sampler.clone()).ray;
            let normal = estimate.query.normal;
            let t = normal.dot(estimate.query.position - ray.origin) / normal.dot(ray.dir);
            let position = ray.at(t);
            let near = (position - estimate.query.position).length() <= FAR * t;
            if !(near && own_weight != 0.0) {
                companions.truncate(first);
                return;
            }
            companions.push(Estimate {
                query: GatherQuery { position, ..estimate.query },
                throughput: estimate.throughput * (weight / own_weight),
                places,
                caustic_scale,
                shift,
                ..*estimate
            });
        }
        (estimate.places, estimate.caustic_scale) = (places, caustic_scale);
    }
}

/// Place `number` of `count` in the unit square. With a^2 + 1 places and a step of a they are a square lattice turned
/// so that no two share a row or a column: a rim along a row of pixels is resolved by all of them.
fn place(number: u32, count: u32, step: u32) -> [f32; 2] {
    [number, number * step % count].map(|c| c as f32 / count as f32)
}

/// What the places of a pixel found: least and most light, and the photons of the latter.
#[derive(Clone, Copy)]
pub(crate) struct Spread {
    least: f32,
    most: f32,
    photons: f32,
}

impl Spread {
    /// Nothing yet.
    pub const NONE: Self = Self { least: f32::INFINITY, most: 0.0, photons: 0.0 };

    /// Takes note of a place.
    pub fn add(&mut self, found: &Estimated) {
        let light = found.radiance.element_sum();
        self.least = self.least.min(light);
        if light > self.most {
            (self.most, self.photons) = (light, found.density * std::f32::consts::PI * found.radius * found.radius);
        }
    }

    /// Whether a rim crosses the pixel.
    pub fn is_rim(&self) -> bool {
        self.photons >= RIM_PHOTONS && self.least < RIM * self.most
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Variance, over all shifts, of the share of places beyond a straight rim that runs along a direction.
    fn variance(places: &[[f32; 2]], [x, y]: [f32; 2]) -> f64 {
        let (mut sum, mut squares) = (0.0, 0.0);
        for shift in 0..64 * 64 {
            let shift = [shift % 64, shift / 64].map(|c| (c as f32 + 0.5) / 64.0);
            let at = |place: &[f32; 2], axis: usize| (place[axis] + shift[axis]).fract() - 0.5;
            let beyond = places.iter().filter(|place| at(place, 1) * x - at(place, 0) * y > 0.1).count();
            let share = beyond as f64 / places.len() as f64;
            (sum, squares) = (sum + share, squares + share * share);
        }
        squares / 4096.0 - (sum / 4096.0).powi(2)
    }

    /// Against square lattices of about as many places: along rows and columns there is no comparison, and the worst
    /// direction is a better one.
    #[test]
    fn rims_along_rows_are_resolved_by_all_places() {
        for ([count, step], edge) in [(PLACES, 2), (RIM_PLACES, 4)] {
            let lattice: Vec<[f32; 2]> = (0..count).map(|number| place(number, count, step)).collect();
            let square: Vec<[f32; 2]> =
                (0..edge * edge).map(|i| [i % edge, i / edge].map(|c| c as f32 / edge as f32)).collect();
            for along in [[1.0, 0.0], [0.0, 1.0]] {
                let (turned, straight) = (variance(&lattice, along), variance(&square, along));
                assert!(turned < 0.3 * straight, "{count} places along {along:?}: {turned} against {straight}");
            }
            let worst = |places: &[[f32; 2]]| {
                let angles = (0..32).map(|i| i as f32 / 32.0 * std::f32::consts::PI);
                angles.map(|angle| variance(places, [angle.cos(), angle.sin()])).fold(0.0, f64::max)
            };
            let (turned, straight) = (worst(&lattice), worst(&square));
            assert!(turned < 0.7 * straight, "{count} places, worst direction: {turned} against {straight}");
        }
    }
}
