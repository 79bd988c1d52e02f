//! The sieve before the ray-triangle test: whether a ray's line passes the box of a triangle, seen along the ray's
//! dominant axis.
//!
//! `woop` shears the vertices so that the ray becomes the third axis: x' = (x - ox) - s (z - oz), and y' alike. Where
//! all three x' are above zero, or all below, there is no hit: with the exact edge functions U, V, W of the sheared
//! triangle, U x'a + V x'b + W x'c = 0, so that they have mixed signs or are all zero, both of which
//! [`photinus_intersect::methods::woop::finish`] refuses, and it evaluates their signs exactly. So a hit has one vertex
//! with x - s z <= ox - s oz and one with x - s z >= ox - s oz, and the box, of which the triangle is a part, too:
//!
//! * lower x - s (upper z) <= ox - s oz <= upper x - s (lower z) for s >= 0, and with the two z exchanged for s < 0.
//!
//! Two products, two differences and two comparisons for each of the two axes; a whole test takes 42 operations. The
//! right numbers depend on the ray alone.
//!
//! *Rounding.* All are taken relative to the middle of the triangles. Let u = 2^-24, and |s| <= 1 as z is the dominant
//! axis. The sign of a computed x' is that of a number off by u |x - ox| + (2 u + u^2) |s (z - oz)| at most, each
//! distance being no more than that of the vertex from the middle plus that of the ray's start from there; the left
//! side above is off by u |x| + (2 u + u^2) |z| for the corner used, and bounds and thresholds are rounded once: u of
//! their size. Boxes are padded by 16 u of the distance of their triangle, thresholds by 16 u of that of the ray's
//! start ([`SLAB_SLACK`]), where four are needed of each. The smallest normal number covers what rounds in the last
//! places there are. Nothing overflows up to [`MOST`]: triangles beyond have endless boxes, rays beyond have endless
//! thresholds. Comparisons are written so that what is not a number passes.

use super::layout::{LANES, MOST};
use crate::bounds::SLAB_SLACK;
use photinus_intersect::methods::woop::Started;

/// What the sieve needs of a ray, for both of the test's first two axes.
#[derive(Clone, Copy, Debug)]
pub struct Sieve {
    /// Where the lower bounds of the axis start, in floats from the start of [`super::layout::Boxes`]; the upper ones
    /// follow. At most 4 x 16.
    pub side: [usize; 2],
    /// The same for bounds along the third axis that the lower bounds are sheared with. At most 5 x 16.
    pub with_lower: [usize; 2],
    /// The same for those that the upper bounds are sheared with.
    pub with_upper: [usize; 2],
    /// The ray's shears.
    pub shear: [f32; 2],
    /// Sheared lower bounds above this are out.
    pub most: [f32; 2],
    /// Sheared upper bounds below this are out.
    pub least: [f32; 2],
}

impl Sieve {
    /// The sieve of a ray among triangles around `middle`.
    pub fn new(ray: &Started<f32>, middle: &[f64; 3]) -> Self {
        let start = |axis: usize| f64::from(ray.origin[axis]) - middle[axis];
        // Below three always; kernels read memory by them.
        let [kx, ky, kz] = ray.axes.map(|k| k % 3);
        let mut out = Self {
            side: [2 * kx * LANES, 2 * ky * LANES],
            with_lower: [0; 2],
            with_upper: [0; 2],
            shear: ray.shear,
            most: [f32::INFINITY; 2],
            least: [f32::NEG_INFINITY; 2],
        };
        for (i, axis) in [kx, ky].into_iter().enumerate() {
            let (lower, upper) = (2 * kz * LANES, (2 * kz + 1) * LANES);
            let forward = ray.shear[i] >= 0.0;
            (out.with_lower[i], out.with_upper[i]) = if forward { (upper, lower) } else { (lower, upper) };
            let away = start(axis).abs() + start(kz).abs();
            if away <= MOST {
                let at = start(axis) - f64::from(ray.shear[i]) * start(kz);
                let slack = away * f64::from(SLAB_SLACK) + f64::from(f32::MIN_POSITIVE);
                (out.most[i], out.least[i]) = ((at + slack) as f32, (at - slack) as f32);
            }
        }
        out
    }
}
