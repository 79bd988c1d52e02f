//! Supports of an estimate: where its photons lie, how far each of them counts as being from the middle, and by which area
//! their flux is divided.
//!
//! Each measure of distance grows in proportion with the offset from the middle. So what a plane through the middle has
//! within a measure m is m^2 times what it has within 1, and a kernel's integral over it is that area times the same
//! share as over a disc: every kernel goes with every support, exactly.

mod ball;
mod box_fixed;
mod box_polygon;
mod box_trimmed;
mod disc;
mod ellipsoid;
mod list;

pub use list::{DEFAULT_SUPPORT, SUPPORTS, find_support};

use crate::supported::Supported;
use crate::{Kernel, Region, Search};
use photinus_geometry::Vec3;

/// What a member says of itself; all of a query of radius 1 unless told otherwise.
pub(crate) trait Shape: Send + Sync + 'static {
    /// The squared distance of a photon is at most so many times the square of its measure.
    const REACH_SQ: f32;

    /// What is searched for a query of this radius: it holds all of the support.
    fn region(center: Vec3, radius: f32) -> Region;

    /// The square of the measure of a photon of the region at `offset` from the middle, `distance_sq` being the squared
    /// length of that; `normal` is the query's, of unit length. The photon is in where this is at most the radius squared.
    fn measure_sq(offset: Vec3, distance_sq: f32, normal: Vec3) -> f32;

    /// The area, scene units squared, that flux is divided by where all photons count alike.
    fn section(normal: Vec3) -> f32;
}

/// A member of the family.
#[derive(Clone, Copy, Debug)]
pub struct Support {
    /// Command-line name.
    pub name: &'static str,
    /// One sentence for help and documentation.
    pub about: &'static str,
    /// Whether it finds what the ball finds, and divides by the same area.
    pub is_ball: bool,
    over: fn(Box<dyn Search>) -> Box<dyn Search>,
    section: fn(Vec3) -> f32,
}

impl Support {
    const fn of<S: Shape>(name: &'static str, about: &'static str) -> Self {
        Self { name, about, is_ball: false, over: |search| Box::new(Supported::<S>::new(search)), section: S::section }
    }

    /// The same photons as `search` holds, for estimates over this support: gathering, visiting and the nearest are by its
    /// measure, whose square takes the place of the squared distance; a query's radius is the largest measure. Questions
    /// about regions and about distances without a normal are answered as before. Over the ball it is `search` itself.
    pub fn over(&self, search: Box<dyn Search>) -> Box<dyn Search> {
        (self.over)(search)
    }

    /// Integral of the kernel's weight over what the support has of the plane through its middle across `normal` (unit),
    /// scene units squared, for a query of this radius: the sum of weight * flux divided by it estimates irradiance. Of
    /// `box-fixed` what that would be on a plane across an axis; so, too, for a normal that is none.
    pub fn area(&self, kernel: Kernel, normal: Vec3, radius: f32) -> f32 {
        kernel.share() * (self.section)(normal) * (radius * radius)
    }
}
