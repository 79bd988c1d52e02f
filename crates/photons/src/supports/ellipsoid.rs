//! The ball flattened along the surface's normal into an ellipsoid (Jensen 2001, section 7.2): as the disc, with a soft rim.
//!
//! Measure: the distance with its part along the normal stretched by four. On the tangent plane it is the distance, and the
//! area is the ball's.

use super::Shape;
use crate::Region;
use photinus_geometry::Vec3;

pub(super) const ABOUT: &str = "the ball flattened to r/4 along the normal";

/// Semi-axis along the normal over those across.
const HEIGHT: f32 = 0.25;

pub(super) struct Ellipsoid;

impl Shape for Ellipsoid {
    const REACH_SQ: f32 = 1.0;

    fn region(center: Vec3, radius: f32) -> Region {
        Region::Sphere { center, radius }
    }

    #[inline]
    fn measure_sq(offset: Vec3, distance_sq: f32, normal: Vec3) -> f32 {
        // The distance counts the height once: written so, the measure is never below the distance, not by rounding either.
        let height = offset.dot(normal);
        distance_sq + height * height * (1.0 / (HEIGHT * HEIGHT) - 1.0)
    }

    fn section(normal: Vec3) -> f32 {
        super::ball::section(normal)
    }
}
