//! Axis-aligned ellipsoids: the smallest around points, and where a ray enters one.

use crate::hierarchy::round::{Frame, RoundRay};
use crate::hierarchy::volume::{Fit, PaddedPoint, Volume};
use photinus_geometry::Ray;
use std::f64::consts::PI;

/// An ellipsoid: the points p with the sum of ((p - center) / radii)^2 over the axes at most 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ellipsoid {
    /// Middle.
    pub center: [f32; 3],
    /// Half axes, positive; infinite where floats end.
    pub radii: [f32; 3],
}

impl Volume for Ellipsoid {
    type Prepared = RoundRay;

    fn prepare(ray: &Ray) -> Option<RoundRay> {
        RoundRay::new(ray)
    }

    /// The test runs where the ellipsoid is a unit ball. A point that is displaced by up to e along every axis is in
    /// the ellipsoid of radii r + e, grown by the factor 1 + sum of e / (r + e).
    #[inline(always)]
    fn enter(&self, ray: &RoundRay, end: f32) -> Option<f32> {
        let radii = self.radii.map(f64::from);
        let (offset, error) = ray.error(self.center.map(f64::from), |k| radii[k]);
        let inv = radii.map(|r| 1.0 / (r + error));
        let grown = 1.0 + error * (inv[0] + inv[1] + inv[2]);
        let q: [f64; 3] = std::array::from_fn(|k| offset[k] * inv[k]);
        let d: [f64; 3] = std::array::from_fn(|k| ray.dir[k] * inv[k]);
        let dir_sq = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let foot = -(q[0] * d[0] + q[1] * d[1] + q[2] * d[2]) / dir_sq;
        // From the nearest point of the line, whose distance keeps its digits however far the start is.
        let p: [f64; 3] = std::array::from_fn(|k| q[k] + foot * d[k]);
        let left = grown * grown - (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        ray.enter(foot, left, dir_sq, end)
    }

    /// Thomsen's approximation of the surface, off by at most 1.1 %.
    fn half_surface(&self) -> f64 {
        const P: f64 = 1.6075;
        let [a, b, c] = self.radii.map(|r| libm::pow(f64::from(r), P));
        2.0 * PI * libm::pow((a * b + a * c + b * c) / 3.0, 1.0 / P)
    }
}

/// Steps of the fit: enough to come within some per mille of the smallest radii.
const STEPS: usize = 24;
/// No ellipsoid is flatter than this.
const FLATTEST: f64 = 1.0 / 4096.0;

impl Fit for Ellipsoid {
    /// The ellipsoid of least volume rests on weighted points: its radii are sqrt(3) of their weighted standard
    /// deviations, whose product the best weights make largest. Weights are found by the multiplicative steps of
    /// Titterington ("Estimation of Correlation Coefficients by Ellipsoidal Trimming", Applied Statistics 27, 1978),
    /// here for diagonal matrices; what remains outside is let in by a common factor.
    fn fit(points: &[PaddedPoint]) -> Self {
        let frame = Frame::of(points, FLATTEST);
        let carriers = frame.carriers(points);
        let mut weights = vec![1.0 / carriers.len() as f64; carriers.len()];
        let (mut mean, mut variance) = ([0.0; 3], [1.0; 3]);
        for step in 0..=STEPS {
            for k in 0..3 {
                mean[k] = carriers.iter().zip(&weights).map(|(p, w)| w * p[k]).sum();
                let squares = |(p, w): (&[f64; 3], &f64)| w * (p[k] - mean[k]) * (p[k] - mean[k]);
                variance[k] = carriers.iter().zip(&weights).map(squares).sum::<f64>().max(1e-9);
            }
            if step < STEPS {
                for (p, w) in carriers.iter().zip(&mut weights) {
                    *w *= (0..3).map(|k| (p[k] - mean[k]) * (p[k] - mean[k]) / variance[k]).sum::<f64>();
                }
                let sum: f64 = weights.iter().sum();
                if !(sum > 0.0) {
                    break;
                }
                weights.iter_mut().for_each(|w| *w /= sum);
            }
        }
        let center = std::array::from_fn(|k| frame.middle[k] + frame.size[k] * mean[k]);
        let radii = std::array::from_fn(|k| (frame.size[k] * (3.0 * variance[k]).sqrt()).max(frame.floor));
        let by_weights = around(points, center, radii);
        let by_box = around(points, frame.middle, frame.size);
        let volume = |e: &Self| e.radii.map(f64::from).iter().product::<f64>();
        if volume(&by_weights) < volume(&by_box) { by_weights } else { by_box }
    }
}

/// The smallest ellipsoid of that middle and those proportions around padded points.
fn around(points: &[PaddedPoint], center: [f64; 3], radii: [f64; 3]) -> Ellipsoid {
    let center = center.map(|x| (x as f32).clamp(f32::MIN, f32::MAX));
    let mut farthest = 0.0_f64;
    for p in points {
        let distance_sq = (0..3).map(|k| {
            let x = ((p.at[k] - f64::from(center[k])).abs() + p.pad) / radii[k];
            x * x
        });
        farthest = farthest.max(distance_sq.sum());
    }
    let factor = farthest.sqrt().max(f64::from(f32::MIN_POSITIVE));
    // Rounded up, with what the sums above lost.
    Ellipsoid { center, radii: radii.map(|r| ((r * factor * (1.0 + 1e-12)) as f32).next_up()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;
    use photinus_num::{Sampler, StreamKind};

    fn points(at: impl IntoIterator<Item = [f64; 3]>) -> Vec<PaddedPoint> {
        at.into_iter().map(|at| PaddedPoint { at, pad: 0.0 }).collect()
    }

    fn is_inside(e: &Ellipsoid, p: &PaddedPoint) -> bool {
        let x = |k: usize| ((p.at[k] - f64::from(e.center[k])).abs() + p.pad) / f64::from(e.radii[k]);
        (0..3).map(|k| x(k) * x(k)).sum::<f64>() <= 1.0
    }

    /// Around the corners of a box the radii are sqrt(3) of half its edges; around a regular octahedron it is the ball.
    #[test]
    fn known_ellipsoids_are_found() {
        let corners =
            points((0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).map(|[x, y, z]| [x, 4.0 * y, z]));
        let e = Ellipsoid::fit(&corners);
        for (radius, expected) in e.radii.into_iter().zip([0.866_025_4, 3.464_101_6, 0.866_025_4]) {
            assert!((radius / expected - 1.0).abs() < 1e-5, "{e:?}");
        }
        let ball = Ellipsoid::fit(&points(
            (0..6).map(|i| std::array::from_fn(|k| if i / 2 == k { 1.0 - 2.0 * (i % 2) as f64 } else { 0.0 })),
        ));
        assert!(ball.radii.iter().all(|r| (r - 1.0).abs() < 1e-3), "{ball:?}");
    }

    #[test]
    fn every_point_is_inside_and_none_could_be_left_out() {
        for seed in 0..50u32 {
            let mut s = Sampler::new(5, StreamKind::Test, 0, seed);
            let scale = [1.0, [1.0, 1e-3, 1e6, 0.0][seed as usize % 4], 1.0];
            let count = 1 + seed as usize * 3;
            let cloud: Vec<PaddedPoint> = (0..count)
                .map(|_| {
                    let at = std::array::from_fn(|k| 100.0 + scale[k] * f64::from(s.next_1d()));
                    PaddedPoint { at, pad: 1e-6 }
                })
                .collect();
            let e = Ellipsoid::fit(&cloud);
            assert!(cloud.iter().all(|p| is_inside(&e, p)), "seed {seed}: {e:?}");
            let smaller = Ellipsoid { radii: e.radii.map(|r| r * 0.9999), ..e };
            assert!(!cloud.iter().all(|p| is_inside(&smaller, p)), "seed {seed}: {e:?} is too large");
        }
    }

    /// The fit is no larger than many others, and within 2 % of the best of them.
    #[test]
    fn no_other_ellipsoid_is_much_smaller() {
        let mut s = Sampler::new(6, StreamKind::Test, 0, 0);
        let cloud = points((0..20).map(|_| std::array::from_fn(|_| f64::from(s.next_1d()))));
        let volume = |e: &Ellipsoid| e.radii.iter().map(|r| f64::from(*r)).product::<f64>();
        let fitted = Ellipsoid::fit(&cloud);
        let mut best = f64::INFINITY;
        for _ in 0..20_000 {
            let mut near = |x: f32, by: f32| f64::from(x) * (1.0 + f64::from(by) * f64::from(s.next_1d() - 0.5));
            let center = fitted.center.map(|x| near(x, 0.1));
            let radii = fitted.radii.map(|x| near(x, 0.2));
            best = best.min(volume(&around(&cloud, center, radii)));
        }
        assert!(volume(&fitted) < 1.02 * best, "{} {best}", volume(&fitted));
    }

    #[test]
    fn rays_enter_where_they_should() {
        let e = Ellipsoid { center: [10.0, 0.0, 0.0], radii: [2.0, 1.0, 0.5] };
        let enter = |origin: Vec3, dir: Vec3, end: f32| e.enter(&RoundRay::new(&Ray::new(origin, dir)).unwrap(), end);
        let t = enter(Vec3::ZERO, Vec3::X, f32::INFINITY).unwrap();
        assert!(t <= 8.0 && t > 7.999, "{t}");
        assert_eq!(enter(Vec3::ZERO, Vec3::X, 7.9), None);
        assert_eq!(enter(Vec3::ZERO, -Vec3::X, f32::INFINITY), None);
        assert_eq!(enter(Vec3::new(10.0, 0.0, 0.0), Vec3::Y, 1.0), Some(0.0));
        assert!(enter(Vec3::new(0.0, 0.999, 0.0), Vec3::X, f32::INFINITY).is_some());
        assert!(enter(Vec3::new(0.0, 1.001, 0.0), Vec3::X, f32::INFINITY).is_none());
        assert!(enter(Vec3::new(0.0, 0.0, 1e6), Vec3::new(1e-5, 0.0, -1.0), f32::INFINITY).is_some());
    }

    #[test]
    fn areas_are_those_of_balls_and_disks() {
        let area = |radii: [f32; 3]| Ellipsoid { center: [0.0; 3], radii }.half_surface();
        assert!((area([2.0; 3]) / (8.0 * PI) - 1.0).abs() < 1e-9);
        assert!((area([1.0, 1.0, 1e-6]) / PI - 1.0).abs() < 0.011);
    }
}
