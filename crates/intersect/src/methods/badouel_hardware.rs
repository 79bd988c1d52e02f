//! `badouel-pivot` with the inclusion test of the thesis's pipeline (section 6.1.3.3.2): neither alpha nor beta has its
//! sign bit set, and `alpha + beta` is below one.
//!
//! In a logarithmic word both are single bits, and exactly one is not below one: the edge BC and its vertices are left
//! out. Two triangles that share an edge as their BC both leave it out, and a ray exactly through it passes between
//! them. That `alpha` and `beta` are at most one follows from the other tests.

use crate::method::{GivenRay, RtiMethod, TriangleHit};
use crate::restructured::{Border, Words};
use photinus_num::Scalar;

/// The method.
pub struct BadouelHardware;

impl<S: Scalar> RtiMethod<S> for BadouelHardware {
    const NAME: &'static str = "badouel-hardware";
    type Prepared = Words<S>;
    type Started = GivenRay<S>;

    fn prepare(vertices: [[S; 3]; 3]) -> Words<S> {
        Words::with_pivot(&vertices)
    }

    fn start(origin: [S; 3], dir: [S; 3]) -> Option<GivenRay<S>> {
        GivenRay::new(origin, dir)
    }

    #[inline]
    fn intersect(ray: &GivenRay<S>, triangle: &Words<S>, t_min: S, t_max: S) -> Option<TriangleHit<S>> {
        triangle.intersect(ray, t_min, t_max, Border::HalfOpen)
    }
}
