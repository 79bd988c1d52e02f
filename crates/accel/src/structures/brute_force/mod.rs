//! Every primitive for every ray: the oracle that all other members are tested against, and the thesis's "brute
//! force" mode.
//!
//! With `woop` triangles are tested sixteen at a time by vector kernels, which give the bits of the plain way, one
//! primitive after the other. That is what all other methods get, and `woop` too where the kernel asked for is the
//! scalar one: the oracle's oracle.

mod blocked;
mod dispatch;
mod kernels;
mod layout;
mod plain;
mod sieve;
mod walk;

use crate::options::{BuildError, BuildOptions, Kernel};
use crate::structure::{Structure, StructureSummary};
use blocked::Blocked;
use photinus_geometry::{Primitives, Ray, Vec3};
use photinus_intersect::methods::woop::Woop;
use photinus_intersect::{RtiMethod, TriangleHit};
use photinus_num::Scalar;
use plain::Plain;
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "brute-force";
/// One line for the help.
pub const SUMMARY: &str = "every primitive for every ray; the oracle";
/// Where it was published.
pub const SOURCE: &str = "none";

/// The triangles of `primitives`, prepared for a method over any scalar.
pub fn prepare<S: Scalar, M: RtiMethod<S>>(primitives: &Primitives) -> Vec<M::Prepared> {
    let scalars = |v: Vec3| v.to_array().map(|x| S::from_f64(f64::from(x)));
    (0..primitives.triangle_count()).map(|i| M::prepare(primitives.triangle(i).map(scalars))).collect()
}

/// The nearest triangle that a ray hits, by a method over any scalar, ties going to the lowest id: the oracle for
/// number systems, and the counterpart of a hardware unit that sees every triangle.
pub fn closest_triangle<S: Scalar, M: RtiMethod<S>>(
    triangles: &[M::Prepared],
    ray: &Ray,
) -> Option<(u32, TriangleHit<S>)> {
    let scalar = |x: f32| S::from_f64(f64::from(x));
    let started = M::start(ray.origin.to_array().map(scalar), ray.dir.to_array().map(scalar))?;
    let mut best: Option<(u32, TriangleHit<S>)> = None;
    for (id, triangle) in triangles.iter().enumerate() {
        let t_max = best.as_ref().map_or(scalar(ray.t_max), |b| b.1.t);
        if let Some(hit) = M::intersect(&started, triangle, scalar(ray.t_min), t_max)
            && best.as_ref().is_none_or(|b| hit.t < b.1.t)
        {
            best = Some((id as u32, hit));
        }
    }
    best
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    if options.method == <Woop as RtiMethod<f32>>::NAME && options.kernel != Kernel::Scalar {
        return Ok(Box::new(Blocked::new(&primitives, options.kernel)));
    }
    Ok(Box::new(Plain::new(&primitives, options)?))
}

/// One leaf of `count` primitives in so much memory.
fn one_leaf(count: usize, bytes: u64) -> StructureSummary {
    StructureSummary {
        name: NAME,
        leaves: u64::from(count > 0),
        empty_leaves: u64::from(count == 0),
        references: count as u64,
        prims_per_leaf: count as f64,
        bytes,
        ..StructureSummary::default()
    }
}

#[cfg(test)]
mod tests;
