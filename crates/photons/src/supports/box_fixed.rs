//! The box along the axes over the area of one of its faces, whatever the surface's slant (Hoggins 2010, section
//! 6.2.2.4.2, the first of three choices): too bright by up to the square root of two.
//!
//! Measure: the largest of the distances along the axes.

use super::Shape;
use crate::Region;
use photinus_geometry::Vec3;

pub(super) const ABOUT: &str = "a box, over (2 r)^2 whatever the slant (too bright)";

pub(super) struct BoxFixed;

impl Shape for BoxFixed {
    const REACH_SQ: f32 = REACH_SQ;

    fn region(center: Vec3, radius: f32) -> Region {
        Region::Cuboid { center, half: Vec3::splat(radius) }
    }

    #[inline]
    fn measure_sq(offset: Vec3, _: f32, _: Vec3) -> f32 {
        measure_sq(offset)
    }

    fn section(_: Vec3) -> f32 {
        FACE
    }
}

/// A corner lies the root of three away from the middle; a little more, as squares and sums are rounded.
pub(super) const REACH_SQ: f32 = 3.000_01;

/// Area of a face of the box of half-size 1.
pub(super) const FACE: f32 = 4.0;

#[inline]
pub(super) fn measure_sq(offset: Vec3) -> f32 {
    let largest = offset.abs().max_element();
    largest * largest
}
