//! The thesis's restructured Badouel test (Figure 30), the axes exchanged so that the larger of |u1| and |v1| is the
//! pivot: the words D and E stay small.
//!
//! The same ten words and the same operations as `badouel-thesis`; only preparation differs.

use crate::method::{GivenRay, RtiMethod, TriangleHit};
use crate::restructured::{Border, Words};
use photinus_num::Scalar;

/// The method.
pub struct BadouelPivot;

impl<S: Scalar> RtiMethod<S> for BadouelPivot {
    const NAME: &'static str = "badouel-pivot";
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
        triangle.intersect(ray, t_min, t_max, Border::Closed)
    }
}
