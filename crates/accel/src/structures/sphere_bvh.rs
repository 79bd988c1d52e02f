//! The thesis's bounding volume hierarchy with spheres in place of ellipsoids: less to store and quicker to test, but
//! looser.

use crate::hierarchy::octree_bvh;
use crate::hierarchy::round::{Frame, RoundRay};
use crate::hierarchy::volume::{Fit, PaddedPoint, Volume};
use crate::options::{BuildError, BuildOptions};
use crate::structure::Structure;
use photinus_geometry::{Primitives, Ray};
use std::f64::consts::PI;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "sphere-bvh";
/// One line for the help.
pub const SUMMARY: &str = "spheres over an octree's voxels";
/// Where it was published.
pub const SOURCE: &str = "the thesis, section 3.1.2, with another volume";

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    octree_bvh::build::<Ball>(NAME, &primitives, options)
}

/// A sphere as a bounding volume.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ball {
    center: [f32; 3],
    /// Positive; infinite where floats end.
    radius: f32,
}

/// Half the diagonal of a unit cube's face-centred octant: how far a displacement of 1 along every axis leads.
const SQRT_3: f64 = 1.732_050_807_568_877_3;

impl Volume for Ball {
    type Prepared = RoundRay;

    fn prepare(ray: &Ray) -> Option<RoundRay> {
        RoundRay::new(ray)
    }

    #[inline(always)]
    fn enter(&self, ray: &RoundRay, end: f32) -> Option<f32> {
        let radius = f64::from(self.radius);
        let (q, error) = ray.error(self.center.map(f64::from), |_| radius);
        let grown = radius + SQRT_3 * error;
        let d = ray.dir;
        let dir_sq = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let foot = -(q[0] * d[0] + q[1] * d[1] + q[2] * d[2]) / dir_sq;
        let p: [f64; 3] = std::array::from_fn(|k| q[k] + foot * d[k]);
        let left = grown * grown - (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        ray.enter(foot, left, dir_sq, end)
    }

    fn half_surface(&self) -> f64 {
        2.0 * PI * f64::from(self.radius) * f64::from(self.radius)
    }
}

/// Steps towards the farthest point; the middle is then off by a part in so many of the radius.
const STEPS: usize = 48;

impl Fit for Ball {
    /// The smallest sphere after Badoiu and Clarkson ("Smaller Core-Sets for Balls", SODA 2003): from the middle of the
    /// box, ever smaller steps towards the farthest point.
    fn fit(points: &[PaddedPoint]) -> Self {
        let mut frame = Frame::of(points, 1.0);
        // One unit along all axes, so that spheres stay spheres.
        frame.size = [frame.size[0].max(frame.size[1]).max(frame.size[2]); 3];
        let carriers = frame.carriers(points);
        let mut middle = [0.0; 3];
        for step in 1..=STEPS {
            let distance_sq = |p: &[f64; 3]| (0..3).map(|k| (p[k] - middle[k]) * (p[k] - middle[k])).sum::<f64>();
            let farthest = carriers
                .iter()
                .map(|p| (distance_sq(p), p))
                .fold((-1.0, &middle), |a, b| if b.0 > a.0 { b } else { a });
            let target = *farthest.1;
            for k in 0..3 {
                middle[k] += (target[k] - middle[k]) / (step + 1) as f64;
            }
        }
        let by_steps = around(points, std::array::from_fn(|k| frame.middle[k] + frame.size[k] * middle[k]));
        let by_box = around(points, frame.middle);
        if by_steps.radius < by_box.radius { by_steps } else { by_box }
    }
}

/// The smallest sphere of that middle around padded points.
fn around(points: &[PaddedPoint], center: [f64; 3]) -> Ball {
    let center = center.map(|x| (x as f32).clamp(f32::MIN, f32::MAX));
    let distance = |p: &PaddedPoint| {
        let d: [f64; 3] = std::array::from_fn(|k| p.at[k] - f64::from(center[k]));
        (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() + SQRT_3 * p.pad
    };
    let radius = points.iter().map(distance).fold(0.0, f64::max);
    // Rounded up, with what the sums above lost.
    Ball { center, radius: ((radius * (1.0 + 1e-12)) as f32).next_up() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;
    use photinus_num::{Sampler, StreamKind};

    #[test]
    fn every_point_is_inside_a_ball_near_the_smallest() {
        for seed in 0..50u32 {
            let mut s = Sampler::new(7, StreamKind::Test, 0, seed);
            let cloud: Vec<PaddedPoint> = (0..4 + 2 * seed)
                .map(|_| {
                    let v = Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - Vec3::ONE;
                    PaddedPoint { at: (v.normalize() * 3.0 + 50.0).to_array().map(f64::from), pad: 1e-6 }
                })
                .collect();
            let ball = Ball::fit(&cloud);
            for p in &cloud {
                let d = (0..3).map(|k| (p.at[k] - f64::from(ball.center[k])).powi(2)).sum::<f64>().sqrt();
                assert!(d + p.pad <= f64::from(ball.radius), "seed {seed}");
            }
            assert!(ball.radius < 3.1, "seed {seed}: {ball:?}");
        }
    }

    #[test]
    fn rays_enter_where_they_should() {
        let ball = Ball { center: [10.0, 0.0, 0.0], radius: 2.0 };
        let enter =
            |y: f32, end: f32| ball.enter(&RoundRay::new(&Ray::new(Vec3::new(0.0, y, 0.0), Vec3::X)).unwrap(), end);
        let t = enter(0.0, f32::INFINITY).unwrap();
        assert!(t <= 8.0 && t > 7.999, "{t}");
        assert_eq!(enter(0.0, 7.9), None);
        assert!(enter(1.999, f32::INFINITY).is_some() && enter(2.001, f32::INFINITY).is_none());
    }
}
