//! The ball without what lies far above and below the surface: photons of other surfaces in corners and behind thin walls
//! are left out (the flattened sphere of Jensen 2001, section 7.2, here with straight faces).
//!
//! Measure: the larger of the distance and four times the height over the tangent plane. On that plane it is the distance,
//! and the area is the ball's.

use super::Shape;
use crate::Region;
use photinus_geometry::Vec3;

pub(super) const ABOUT: &str = "the ball, no higher over the surface than r/4";

/// Half the thickness over the radius.
const HEIGHT: f32 = 0.25;

pub(super) struct Disc;

impl Shape for Disc {
    const REACH_SQ: f32 = 1.0;

    fn region(center: Vec3, radius: f32) -> Region {
        Region::Sphere { center, radius }
    }

    #[inline]
    fn measure_sq(offset: Vec3, distance_sq: f32, normal: Vec3) -> f32 {
        let height = offset.dot(normal) * (1.0 / HEIGHT);
        distance_sq.max(height * height)
    }

    fn section(normal: Vec3) -> f32 {
        super::ball::section(normal)
    }
}
