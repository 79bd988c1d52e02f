//! Companions of a visible point: more places of its pixel, on the plane of its surface, that the caustic map is asked about.
//!
//! Where a caustic ends sharply, its rim crosses pixels, and one place a pixel and pass is most of the error. A camera ray
//! costs far more than a search of the map: the tangent plane stands for the surface within a pixel. Together with the
//! point itself the places are a 2 x 2 lattice shifted at random, so that each is spread over the pixel as camera rays
//! are, or 4 x 4 where passes before saw a rim. Where a surface ends inside of the pixel, its plane goes on for that pixel only.

use crate::eye_pass::{EyePass, Path};
use crate::maps::{Estimate, Estimated};
use crate::tile::Tile;
use photinus_photons::GatherQuery;

/// Edge of the lattice of places, and where a rim crosses the pixel.
const PLACES: u32 = 2;
const RIM_PLACES: u32 = 4;
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
        let edge = if has_rim { RIM_PLACES } else { PLACES };
        for place in 1..edge * edge {
            let shift = [place % edge, place / edge].map(|c| c as f32 / edge as f32);
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
                places: edge * edge,
                shift,
                ..*estimate
            });
        }
        estimate.places = edge * edge;
    }
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
