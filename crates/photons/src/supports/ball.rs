//! The ball, over the disc that a plane cuts out of it (Jensen 2001, section 7.2; Hoggins 2010, Figure 42).

use photinus_geometry::Vec3;

pub(super) const ABOUT: &str = "a ball, over its disc pi r^2";

pub(super) fn section(_: Vec3) -> f32 {
    std::f32::consts::PI
}
