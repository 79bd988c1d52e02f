//! Lights without a surface of their own; area lights are shapes with an emission.

use super::texture::Bitmap;
use photinus_geometry::{Affine3A, Vec3};
use std::sync::Arc;

/// A light without geometry.
#[derive(Clone, Debug, PartialEq)]
pub enum Light {
    /// Shines alike in all directions.
    Point {
        /// Where.
        position: Vec3,
        /// Radiant intensity, W/sr, RGB.
        intensity: Vec3,
    },
    /// A cone of light.
    Spot {
        /// Where.
        position: Vec3,
        /// Unit axis of the cone.
        direction: Vec3,
        /// Radiant intensity on the axis, W/sr, RGB.
        intensity: Vec3,
        /// Half angle of the cone in radians; dark outside.
        cutoff_angle: f32,
        /// Half angle inside which the intensity is full, in radians; it falls linearly with the angle from here to
        /// the cutoff.
        beam_width: f32,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// Unit direction in which the light travels.
        direction: Vec3,
        /// Irradiance on a surface that faces the light, W/m², RGB.
        irradiance: Vec3,
    },
    /// Light from all around.
    Environment(EnvironmentLight),
}

/// Radiance that arrives from infinity.
#[derive(Clone, Debug, PartialEq)]
pub enum EnvironmentLight {
    /// The same from everywhere, W/m²/sr, RGB.
    Constant(Vec3),
    /// An equirectangular picture, latitude down from the local +y pole.
    ///
    /// As Mitsuba reads it: a local direction d has u = atan2(d.x, -d.z) / 2 pi (wrapped to 0..1) and
    /// v = acos(d.y) / pi. The first row of pixels lies at v = 0, the last at v = 1; the middle of column i at
    /// u = (i + 1/2) / columns.
    Image {
        /// Radiance, linear.
        bitmap: Arc<Bitmap>,
        /// Factor on the radiance.
        scale: f32,
        /// Local to world; only its rotation matters.
        to_world: Affine3A,
    },
}
