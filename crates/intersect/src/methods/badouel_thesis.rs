//! The thesis's restructured Badouel test (Figure 30) with its rule as printed (Table 15): the axes are exchanged where
//! u1 is exactly zero.
//!
//! A u1 that is tiny but not zero makes the words D and E huge and alpha worthless: the method then names triangles
//! that the ray does not meet. `badouel-pivot` has the cure.

use crate::method::{GivenRay, RtiMethod, TriangleHit};
use crate::restructured::{Border, Words};
use photinus_num::Scalar;

/// The method.
pub struct BadouelThesis;

impl<S: Scalar> RtiMethod<S> for BadouelThesis {
    const NAME: &'static str = "badouel-thesis";
    type Prepared = Words<S>;
    type Started = GivenRay<S>;

    fn prepare(vertices: [[S; 3]; 3]) -> Words<S> {
        Words::new(&vertices, |u1, _| u1 == 0.0)
    }

    fn start(origin: [S; 3], dir: [S; 3]) -> Option<GivenRay<S>> {
        GivenRay::new(origin, dir)
    }

    #[inline]
    fn intersect(ray: &GivenRay<S>, triangle: &Words<S>, t_min: S, t_max: S) -> Option<TriangleHit<S>> {
        triangle.intersect(ray, t_min, t_max, Border::Closed)
    }
}
