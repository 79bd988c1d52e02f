//! Where photons are looked for.

use crate::inclusion::distance_sq;
use crate::photon::{FARTHEST, is_searchable};
use photinus_geometry::{Aabb, Vec3};

/// A part of space, closed, with a middle that distances are measured from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// A ball: the test of Hoggins 2010, Figure 35.
    Sphere {
        /// Its middle.
        center: Vec3,
        /// Its radius, scene units; zero holds the middle, infinity everything.
        radius: f32,
    },
    /// A box by its middle and half its size: one subtraction and one comparison an axis (Hoggins 2010, section
    /// 6.2.1.2).
    Cuboid {
        /// Its middle.
        center: Vec3,
        /// Half its size along each axis, scene units, zero or more.
        half: Vec3,
    },
    /// A box by its least and greatest corner: comparisons only, as the thesis's memory makes them (Hoggins 2010,
    /// Figure 37), here right for bounds of zero, too. Bounds may be infinite.
    Bounds {
        /// Least corner.
        min: Vec3,
        /// Greatest corner.
        max: Vec3,
    },
}

impl Region {
    /// The point that distances are measured from: of bounds their middle, or what is next to it of where photons can be,
    /// and zero along an axis that has none.
    pub fn middle(&self) -> Vec3 {
        match *self {
            Self::Sphere { center, .. } | Self::Cuboid { center, .. } => center,
            Self::Bounds { min, max } => {
                let middle = min * 0.5 + max * 0.5;
                Vec3::from(middle.to_array().map(|x| if x.is_finite() { x.clamp(-FARTHEST, FARTHEST) } else { 0.0 }))
            }
        }
    }

    /// Whether the region is one: no NaN, a middle that a photon could have, sizes that are not negative, and corners
    /// in order.
    pub fn is_valid(&self) -> bool {
        let is_valid = match *self {
            Self::Sphere { radius, .. } => radius >= 0.0,
            Self::Cuboid { half, .. } => half.cmpge(Vec3::ZERO).all(),
            Self::Bounds { min, max } => min.cmple(max).all(),
        };
        is_valid && is_searchable(self.middle())
    }

    /// The squared distance of a point from the middle, where the point lies in a valid region.
    #[inline]
    pub fn holds(&self, point: Vec3, middle: Vec3) -> Option<f32> {
        let d2 = distance_sq(point, middle);
        let is_in = match *self {
            Self::Sphere { radius, .. } => d2 <= radius * radius,
            Self::Cuboid { center, half } => (point - center).abs().cmple(half).all(),
            Self::Bounds { min, max } => (min.cmple(point) & point.cmple(max)).all(),
        };
        is_in.then_some(d2)
    }

    /// A squared distance from the middle, as [`Region::holds`] rounds it, beyond which no point of the region lies.
    pub(crate) fn radius_sq(&self) -> f32 {
        let farthest = match *self {
            Self::Sphere { radius, .. } => return radius * radius,
            Self::Cuboid { half, .. } => half,
            Self::Bounds { min, max } => (min - self.middle()).abs().max((max - self.middle()).abs()),
        };
        (farthest.x * farthest.x + farthest.y * farthest.y) + farthest.z * farthest.z
    }

    /// The least squared distance from `middle` that a point of both the region and the box can have, as
    /// [`Region::holds`] rounds it; infinite where surely no point is in both.
    ///
    /// Rounding is monotonic: the differences, squares and sums of a point of the box are at least those of the nearest.
    #[inline]
    pub(crate) fn reach(&self, bounds: &Aabb, middle: Vec3) -> f32 {
        let apart = (bounds.min - middle).max(middle - bounds.max).max(Vec3::ZERO);
        let d2 = (apart.x * apart.x + apart.y * apart.y) + apart.z * apart.z;
        let may_hold = match *self {
            Self::Sphere { radius, .. } => d2 <= radius * radius,
            Self::Cuboid { half, .. } => apart.cmple(half).all(),
            Self::Bounds { min, max } => (min.cmple(bounds.max) & bounds.min.cmple(max)).all(),
        };
        if may_hold { d2 } else { f32::INFINITY }
    }
}
