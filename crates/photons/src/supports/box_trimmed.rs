//! The box along the axes, whose photons are then trimmed to the ball: what the thesis's memory does (Hoggins 2010, section
//! 6.2.2.4.2, the third of three choices). The same photons as the ball, and the same area.

use super::Shape;
use crate::Region;
use photinus_geometry::Vec3;

pub(super) const ABOUT: &str = "a box, its hits trimmed to the ball, over pi r^2";

pub(super) struct BoxTrimmed;

/// What rounding may add to the distance along an axis that passes the ball's test: a share of the radius, and where its
/// square is too small for a number a length.
const SHARE: f32 = 1e-6;
const LENGTH: f32 = 1e-22;

impl Shape for BoxTrimmed {
    const REACH_SQ: f32 = 1.0;

    fn region(center: Vec3, radius: f32) -> Region {
        // A radius that is none stays none.
        let half = if radius >= 0.0 { radius * (1.0 + SHARE) + LENGTH } else { radius };
        Region::Cuboid { center, half: Vec3::splat(half) }
    }

    #[inline]
    fn measure_sq(_: Vec3, distance_sq: f32, _: Vec3) -> f32 {
        distance_sq
    }

    fn section(normal: Vec3) -> f32 {
        super::ball::section(normal)
    }
}
