//! A ray against planes across the axes: where it may be on either side, no hit lost to rounding.
//!
//! The point of a hit lies, along each axis, within a relative rounding of the place where the padded primitive is (see
//! [`crate::bounds`]), both taken from the ray's origin. A ray therefore counts as on both sides of a plane while it is
//! within [`SLACK`] of it, which is relative to the distance from its origin: whatever cell holds the primitive's
//! place is then visited while the ray's parameter is that of the hit.

use crate::bounds::SLAB_SLACK;
use crate::laboratory::can_hit;
use photinus_geometry::{Aabb, Ray};

/// Relative width of the zone around a plane that counts as on both sides: twice what a hit needs.
pub(crate) const SLACK: f32 = 2.0 * SLAB_SLACK;

/// A parameter, or less by what a hit needs.
#[inline(always)]
pub(crate) fn earliest(t: f32) -> f32 {
    (t * (1.0 - SLACK)).min(t * (1.0 + SLACK))
}

/// A parameter, or more by what a hit needs.
#[inline(always)]
pub(crate) fn latest(t: f32) -> f32 {
    (t * (1.0 - SLACK)).max(t * (1.0 + SLACK))
}

/// The parameters at which a ray enters and leaves `bounds`, widened by rounding and cut to the ray's interval; `None`
/// where it misses them or can hit nothing.
pub(crate) fn clip(ray: &Ray, bounds: &Aabb) -> Option<(f32, f32)> {
    if !can_hit(ray) || bounds.is_empty() {
        return None;
    }
    let (mut enter, mut leave) = (ray.t_min, ray.t_max);
    for axis in 0..3 {
        let d = ray.dir[axis];
        let (low, high) = (bounds.min[axis] - ray.origin[axis], bounds.max[axis] - ray.origin[axis]);
        if d == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (a, b) = if d > 0.0 { (low / d, high / d) } else { (high / d, low / d) };
        enter = enter.max(a - SLACK * a.abs());
        leave = leave.min(b + SLACK * b.abs());
    }
    (enter <= leave).then_some((enter, leave))
}

/// On which sides of a plane a part of a ray may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sides {
    /// Below the plane only.
    Below,
    /// Above it only.
    Above,
    /// First on one side, then on the other.
    Both {
        /// Whether the side above comes first.
        above_first: bool,
        /// Earliest parameter on the second side; not a number where nothing is known.
        first: f32,
        /// Latest parameter on the first side; not a number where nothing is known.
        last: f32,
    },
}

/// The sides of a plane, `plane` above the ray's origin along an axis, that a ray with component `d` along it meets
/// from `enter` to `leave`.
#[inline(always)]
pub(crate) fn sides(plane: f32, d: f32, enter: f32, leave: f32) -> Sides {
    let (a, b) = (d * enter, d * leave);
    let (a_slack, b_slack) = (SLACK * a.abs(), SLACK * b.abs());
    let reaches_below = a <= plane + a_slack || b <= plane + b_slack;
    let reaches_above = a >= plane - a_slack || b >= plane - b_slack;
    if !reaches_above {
        Sides::Below
    } else if !reaches_below {
        Sides::Above
    } else {
        let above_first = d < 0.0 || (d == 0.0 && plane < 0.0);
        // Along the plane there is no crossing, and both sides last as long as the cell.
        let t = plane / d;
        let (first, last) = if d == 0.0 { (enter, leave) } else { (t - SLACK * t.abs(), t + SLACK * t.abs()) };
        Sides::Both { above_first, first, last }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;

    #[test]
    fn the_zone_of_a_plane_is_on_both_sides() {
        assert_eq!(sides(2.0, 1.0, 0.0, 1.0), Sides::Below);
        assert_eq!(sides(2.0, 1.0, 3.0, 4.0), Sides::Above);
        let Sides::Both { above_first, first, last } = sides(2.0, -1.0, -3.0, -1.0) else { panic!("one side only") };
        assert!(above_first && first < -2.0 && last > -2.0);
        // A rounding short of the plane, and a rounding beyond.
        assert!(matches!(sides(2.0, 1.0, 0.0, 2f32.next_down()), Sides::Both { .. }));
        assert!(matches!(sides(2.0, 1.0, 2f32.next_up(), 3.0), Sides::Both { .. }));
        // Within the plane.
        assert!(matches!(sides(0.0, 0.0, 0.0, f32::INFINITY), Sides::Both { .. }));
        assert_eq!(sides(1e-30, -0.0, 0.0, f32::INFINITY), Sides::Below);
    }

    #[test]
    fn parameters_are_widened_whatever_their_sign() {
        for t in [-1e30f32, -1.0, -1e-30, 1e-30, 1.0, 1e30] {
            assert!(earliest(t) < t && t < latest(t), "{t}");
        }
        assert_eq!((earliest(f32::INFINITY), latest(f32::NEG_INFINITY)), (f32::INFINITY, f32::NEG_INFINITY));
    }

    #[test]
    fn rays_are_cut_to_boxes() {
        let bounds = Aabb { min: Vec3::splat(-1.0), max: Vec3::ONE };
        let (enter, leave) = clip(&Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X), &bounds).unwrap();
        assert!((enter - 2.0).abs() < 1e-4 && enter < 2.0 && (leave - 4.0).abs() < 1e-4 && leave > 4.0);
        assert!(clip(&Ray::new(Vec3::new(-3.0, 2.0, 0.0), Vec3::X), &bounds).is_none());
        assert!(clip(&Ray::new(Vec3::ZERO, Vec3::X), &Aabb::EMPTY).is_none());
        assert!(clip(&Ray::new(Vec3::NAN, Vec3::X), &bounds).is_none());
    }
}
