//! Companions of a visible point: more places of its pixel, on the plane of its surface, that the caustic map is asked about.
//!
//! Where a caustic ends sharply, its rim crosses pixels, and one place a pixel and pass is most of the error. A camera ray
//! costs far more than a search of the map: the tangent plane stands for the surface within a pixel. Together with the
//! point itself the places are a 2 x 2 lattice shifted at random, so that each is spread over the pixel as camera rays
//! are. Where a surface ends inside of the pixel, its plane goes on for that pixel only.

use crate::eye_pass::{EyePass, Path};
use crate::maps::Estimate;
use crate::tile::Tile;
use photinus_photons::GatherQuery;

/// Shifts of the other places in the unit square of the pixel's filter; companions of a point stand in this order.
pub(crate) const SHIFTS: [[f32; 2]; 3] = [[0.5, 0.0], [0.0, 0.5], [0.5, 0.5]];
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
        for shift in SHIFTS {
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
                ..*estimate
            });
        }
        let places = 1 + SHIFTS.len() as u32;
        estimate.places = places;
        companions[first..].iter_mut().for_each(|companion| companion.places = places);
    }
}
