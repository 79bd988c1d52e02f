//! Which photons of the pilot were useful: what each is worth to the light around visible points.

use crate::light::Lights;
use crate::photon_pass::{PhotonPass, StoredPhotons};
use crate::pilot::{NEIGHBORS, VisiblePoint};
use crate::world::World;
use photinus_geometry::Ray;
use photinus_photons::{BuildOptions, Photon};

/// Ways of the photons from infinity whose light, after a bounce, arrives at `points`, of what the pilot's own `pass`
/// stored; each with its worth. None where few photons land.
pub(crate) fn useful_rays(
    world: &World,
    lights: &Lights,
    points: &[VisiblePoint],
    pass: &PhotonPass,
    stored: StoredPhotons,
) -> Vec<(Ray, f64)> {
    let mut by_start: Vec<(u32, f64)> = stored.origins.iter().copied().zip(worth(points, stored.global)).collect();
    by_start.sort_by_key(|&(index, _)| index);
    let mut rays = Vec::new();
    for of_one in by_start.chunk_by(|a, b| a.0 == b.0) {
        let (start, ..) = pass.start(of_one[0].0);
        let worth = of_one.iter().map(|&(_, squared)| squared).sum::<f64>().sqrt();
        if worth > 0.0 && worth.is_finite() && lights.is_far(&start) {
            rays.extend(lights.emit(world, &start).map(|photon| (photon.ray, worth)));
        }
    }
    rays
}

/// Square of what each photon is worth. At a visible point, the nearest photons lie within area A and bring the flux F; the
/// relative variance that a photon of flux f adds to an estimate over a fixed area is in proportion to f^2 A / F^2.
fn worth(points: &[VisiblePoint], photons: Vec<Photon>) -> Vec<f64> {
    let mut worth = vec![0.0f64; photons.len()];
    if photons.len() < 2 * NEIGHBORS {
        return worth;
    }
    let seen: Vec<_> = photons.iter().map(|p| (f64::from(p.flux().element_sum()), p.normal())).collect();
    let search = photinus_photons::build(photinus_photons::DEFAULT_SEARCH, photons, &BuildOptions::default());
    let Ok(search) = search else { return worth };
    let mut found = Vec::new();
    for point in points {
        search.nearest(point.position, NEIGHBORS, f32::INFINITY, &mut found);
        let area = f64::from(found.last().map_or(0.0, |n| n.distance_sq));
        found.retain(|n| seen[n.photon as usize].1.dot(point.normal) > 0.5);
        let flux: f64 = found.iter().map(|n| seen[n.photon as usize].0).sum();
        for n in found.iter().filter(|_| flux > 0.0) {
            let share = seen[n.photon as usize].0 / flux;
            worth[n.photon as usize] += share * share * area;
        }
    }
    worth
}
