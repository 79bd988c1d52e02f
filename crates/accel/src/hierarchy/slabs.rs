//! A ray prepared for tests against boxes and slabs that lose no hit (see [`crate::bounds`]).

use super::volume::Volume;
use crate::bounds::{SLAB_SLACK, half_area_f64, size_f64};
use crate::laboratory::can_hit;
use photinus_geometry::{Aabb, Ray};

/// A ray as slabs see it.
///
/// Parameters are widened outward by [`SLAB_SLACK`], whatever their sign. Comparisons are written so that what is not
/// a number, or overflows, bounds nothing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlabRay {
    origin: [f32; 3],
    /// Reciprocal direction; NaN along axes on which the ray does not move, or too slowly for a reciprocal.
    inv: [f32; 3],
    /// Whether it does not move along an axis.
    still: [bool; 3],
    any_still: bool,
    /// Start of the ray's interval.
    pub t_min: f32,
}

impl SlabRay {
    /// Prepares a ray; `None` where it can hit nothing.
    pub fn new(ray: &Ray) -> Option<Self> {
        can_hit(ray).then(|| {
            let still = ray.dir.to_array().map(|d| d == 0.0);
            let inv = ray.dir.to_array().map(|d| 1.0 / d).map(|x| if x.is_infinite() { f32::NAN } else { x });
            Self { origin: ray.origin.to_array(), inv, still, any_still: still.contains(&true), t_min: ray.t_min }
        })
    }

    /// Whether the ray runs towards lower coordinates along an axis.
    #[inline(always)]
    pub fn is_backward(&self, axis: usize) -> bool {
        self.inv[axis] < 0.0
    }

    /// The part of `[enter, leave]` within the slab from `low` to `high` across an axis; empty where none is.
    #[inline(always)]
    pub fn cut(&self, axis: usize, low: f32, high: f32, enter: f32, leave: f32) -> (f32, f32) {
        let o = self.origin[axis];
        if self.still[axis] {
            return if o < low || o > high { (f32::INFINITY, f32::NEG_INFINITY) } else { (enter, leave) };
        }
        let inv = self.inv[axis];
        let (near, far) = if inv < 0.0 { (high, low) } else { (low, high) };
        let (a, b) = ((near - o) * inv, (far - o) * inv);
        let (a, b) = (a - SLAB_SLACK * a.abs(), b + SLAB_SLACK * b.abs());
        (if a > enter { a } else { enter }, if b < leave { b } else { leave })
    }
}

impl Volume for Aabb {
    type Prepared = SlabRay;

    fn prepare(ray: &Ray) -> Option<SlabRay> {
        SlabRay::new(ray)
    }

    #[inline(always)]
    fn enter(&self, ray: &SlabRay, end: f32) -> Option<f32> {
        let (mut enter, mut leave) = (ray.t_min, end);
        for axis in 0..3 {
            let (o, inv) = (ray.origin[axis], ray.inv[axis]);
            let (near, far) =
                if inv < 0.0 { (self.max[axis], self.min[axis]) } else { (self.min[axis], self.max[axis]) };
            let (a, b) = ((near - o) * inv, (far - o) * inv);
            let (a, b) = (a - SLAB_SLACK * a.abs(), b + SLAB_SLACK * b.abs());
            enter = if a > enter { a } else { enter };
            leave = if b < leave { b } else { leave };
        }
        let beside =
            |axis: usize| ray.still[axis] && (ray.origin[axis] < self.min[axis] || ray.origin[axis] > self.max[axis]);
        if ray.any_still && (beside(0) || beside(1) || beside(2)) {
            return None;
        }
        (enter <= leave).then_some(enter)
    }

    fn half_surface(&self) -> f64 {
        half_area_f64(size_f64(self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;

    const BOX: Aabb = Aabb { min: Vec3::new(1.0, -1.0, -1.0), max: Vec3::new(2.0, 1.0, 1.0) };

    fn enter(origin: Vec3, dir: Vec3, end: f32) -> Option<f32> {
        BOX.enter(&SlabRay::new(&Ray::new(origin, dir)).unwrap(), end)
    }

    #[test]
    fn boxes_are_entered_a_little_early_and_left_a_little_late() {
        let t = enter(Vec3::ZERO, Vec3::X, f32::INFINITY).unwrap();
        assert!(t < 1.0 && t > 1.0 - 1e-5);
        assert_eq!(enter(Vec3::ZERO, Vec3::X, 0.9), None);
        assert_eq!(enter(Vec3::ZERO, -Vec3::X, f32::INFINITY), None);
        assert_eq!(enter(Vec3::new(1.5, 0.0, 0.0), Vec3::Y, 1.0), Some(0.0));
    }

    #[test]
    fn rays_that_stand_still_along_an_axis_are_inside_or_beside() {
        assert!(enter(Vec3::new(0.0, 1.0, 0.0), Vec3::X, f32::INFINITY).is_some());
        assert!(enter(Vec3::new(0.0, 1.0001, 0.0), Vec3::new(1.0, -0.0, 0.0), f32::INFINITY).is_none());
        // Too slow for a reciprocal: the axis bounds nothing.
        assert!(enter(Vec3::new(0.0, 5.0, 0.0), Vec3::new(1.0, 1e-45, 0.0), f32::INFINITY).is_some());
    }

    #[test]
    fn parameters_behind_the_start_are_widened_too() {
        let ray = Ray { t_min: -10.0, ..Ray::new(Vec3::new(4.0, 0.0, 0.0), Vec3::X) };
        let t = BOX.enter(&SlabRay::new(&ray).unwrap(), 10.0).unwrap();
        assert!(t < -3.0 && t > -3.0001);
    }
}
