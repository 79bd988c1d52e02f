//! Places that useful light from infinity passes by: windows, gaps, clearings.
//!
//! Photons from the sky start on discs across their direction. A disc around all that is seen wastes most of them on walls;
//! so there are small ones too, around the points that rays which were useful pass closest to. Openings are found that way
//! without any look at the geometry.

use super::lights::VisibleRegion;
use photinus_geometry::{Ray, Vec3};

/// Places at most, rounds of improving them, and rays for each at least.
const MOST: usize = 32;
const ROUNDS: usize = 12;
const RAYS: usize = 8;
/// Share of its rays that the disc of a place holds.
const HELD: f64 = 0.97;
/// Least radius of a disc over that of the visible region.
const LEAST_RADIUS: f32 = 0.01;
/// Pull of every place towards the middle of the region, over that of one of its rays: parallel rays leave it open where
/// along them the place is.
const PULL: f64 = 1e-3;

/// Middle and radius of a disc that photons from infinity start on, seen along each direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Anchor {
    pub center: Vec3,
    pub radius: f32,
    /// What the rays are worth that pass it.
    pub weight: f64,
}

impl Anchor {
    /// Whether the line through `point` along the unit vector `dir` passes its disc.
    pub fn holds(&self, point: Vec3, dir: Vec3) -> bool {
        distance_sq(self.center, point, dir) <= self.radius * self.radius
    }
}

/// Places that `rays`, each with a positive weight, pass closely: k-means of points among lines. None where rays are few.
pub(crate) fn anchors(rays: &[(Ray, f64)], region: VisibleRegion) -> Vec<Anchor> {
    let count = MOST.min(rays.len() / RAYS);
    let total: f64 = rays.iter().map(|r| r.1).sum();
    if count == 0 || !(total > 0.0) || !total.is_finite() {
        return Vec::new();
    }
    // The first places: where rays of evenly chosen weight pass the middle of the region.
    let mut centers: Vec<Vec3> = Vec::with_capacity(count);
    let mut before = 0.0;
    for (ray, weight) in rays {
        before += weight;
        if before >= (centers.len() as f64 + 0.5) / count as f64 * total && centers.len() < count {
            centers.push(ray.origin + ray.dir * ray.dir.dot(region.center - ray.origin));
        }
    }
    let mut owners = vec![0usize; rays.len()];
    for _ in 0..ROUNDS {
        for ((ray, _), owner) in rays.iter().zip(&mut owners) {
            *owner = nearest(&centers, ray);
        }
        for (i, center) in centers.iter_mut().enumerate() {
            let own = rays.iter().zip(&owners).filter(|&(_, &owner)| owner == i).map(|(ray, _)| ray);
            *center = closest_point(own, region.center).unwrap_or(*center);
        }
    }
    for ((ray, _), owner) in rays.iter().zip(&mut owners) {
        *owner = nearest(&centers, ray);
    }
    let mut found = Vec::with_capacity(count);
    for (i, &center) in centers.iter().enumerate() {
        let mut distances: Vec<(f32, f64)> = rays
            .iter()
            .zip(&owners)
            .filter(|&(_, &owner)| owner == i)
            .map(|((ray, weight), _)| (distance_sq(center, ray.origin, ray.dir), *weight))
            .collect();
        if distances.len() < RAYS / 2 {
            continue;
        }
        distances.sort_by(|a, b| a.0.total_cmp(&b.0));
        let weight = distances.iter().map(|d| d.1).sum::<f64>();
        let mut sum = 0.0;
        let edge = distances.iter().find(|d| {
            sum += d.1;
            sum >= HELD * weight
        });
        let radius = edge.map_or(0.0, |d| d.0.sqrt()).max(LEAST_RADIUS * region.radius);
        if center.is_finite() && radius.is_finite() {
            found.push(Anchor { center, radius, weight });
        }
    }
    found
}

fn distance_sq(center: Vec3, point: Vec3, dir: Vec3) -> f32 {
    let to = center - point;
    let along = to.dot(dir);
    (to - dir * along).length_squared()
}

fn nearest(centers: &[Vec3], ray: &Ray) -> usize {
    let mut best = (0, f32::INFINITY);
    for (i, &center) in centers.iter().enumerate() {
        let d = distance_sq(center, ray.origin, ray.dir);
        if d < best.1 {
            best = (i, d);
        }
    }
    best.0
}

/// The point with the least weighted sum of squared distances from the rays and, a little, from `middle`; none without
/// rays. Distances from a line are those in the plane across it, so that the sum is a quadratic form.
fn closest_point<'r>(rays: impl Iterator<Item = &'r (Ray, f64)>, middle: Vec3) -> Option<Vec3> {
    let (mut matrix, mut right, mut total) = ([[0.0f64; 3]; 3], [0.0f64; 3], 0.0);
    for (ray, weight) in rays {
        // Relative to the middle, where numbers are small.
        let (d, o) = (ray.dir.to_array().map(f64::from), (ray.origin - middle).to_array().map(f64::from));
        let along = d[0] * o[0] + d[1] * o[1] + d[2] * o[2];
        for i in 0..3 {
            for j in 0..3 {
                matrix[i][j] += weight * (f64::from(u8::from(i == j)) - d[i] * d[j]);
            }
            right[i] += weight * (o[i] - along * d[i]);
        }
        total += weight;
    }
    if !(total > 0.0) {
        return None;
    }
    (0..3).for_each(|i| matrix[i][i] += PULL * total);
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    // Cramer's rule; the matrix is symmetric and positive.
    let [a, b, c] = matrix;
    let determinant = dot(a, cross(b, c));
    let solution = [
        dot(right, cross(b, c)) / determinant,
        dot(right, cross(c, a)) / determinant,
        dot(right, cross(a, b)) / determinant,
    ];
    let offset = Vec3::from(solution.map(|x| x as f32));
    offset.is_finite().then_some(middle + offset)
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_num::{Sampler, StreamKind};

    /// Rays of all downward directions through two openings, far from each other.
    fn through_windows(count: u32) -> Vec<(Ray, f64)> {
        (0..count)
            .map(|i| {
                let mut sampler = Sampler::new(5, StreamKind::Test, 1, i);
                let ([x, y], [u, v]) = (sampler.next_2d(), sampler.next_2d());
                let window = if i % 3 == 0 { Vec3::new(-2.0, 1.0, 0.5) } else { Vec3::new(1.5, 1.5, -2.0) };
                let at = window + Vec3::new(x - 0.5, y - 0.5, 0.0) * 0.4;
                let dir = Vec3::new(2.0 * u - 1.0, v - 1.2, 0.7).normalize();
                (Ray::new(at - dir * 30.0, dir), 1.0)
            })
            .collect()
    }

    /// Discs lie on the windows and are about as large; without them a disc that holds all rays has a radius of 2.5.
    #[test]
    fn openings_are_found_from_rays_alone() {
        let region = VisibleRegion { center: Vec3::ZERO, radius: 3.0 };
        let rays = through_windows(3000);
        let found = anchors(&rays, region);
        assert!(found.len() > 8 && found.len() <= MOST, "{}", found.len());
        assert!(found.iter().all(|a| a.radius < 0.5), "{found:?}");
        let held = rays.iter().filter(|(ray, _)| found.iter().any(|a| a.holds(ray.origin, ray.dir))).count();
        assert!(held > 2600, "{held}");
    }

    #[test]
    fn degenerate_rays_give_something_finite_or_nothing() {
        let region = VisibleRegion { center: Vec3::ONE, radius: 1.0 };
        assert!(anchors(&[], region).is_empty());
        assert!(anchors(&through_windows(RAYS as u32 - 1), region).is_empty());
        let same = vec![(Ray::new(Vec3::new(0.0, 9.0, 0.0), -Vec3::Y), 2.0); 100];
        let found = anchors(&same, region);
        assert!(!found.is_empty() && found.iter().all(|a| a.center.is_finite() && a.radius > 0.0), "{found:?}");
        let dark: Vec<_> = through_windows(100).into_iter().map(|(ray, _)| (ray, 0.0)).collect();
        assert!(anchors(&dark, region).is_empty());
        let broken = vec![(Ray::new(Vec3::splat(f32::NAN), Vec3::Y), 1.0); 100];
        assert!(anchors(&broken, region).is_empty());
    }
}
