//! The thesis's restructured Badouel test (Figures 29 and 30): ten prepared words and no branch.
//!
//! With the projected vectors of equation 14, `u0 = alpha u1 + beta u2` and `v0 = alpha v1 + beta v2` give
//! `beta = v0 A - u0 B` and `alpha = u0 E - beta D` for the words `A = u1/det`, `B = v1/det`, `D = u2/u1` and
//! `E = 1/u1` with `det = v2 u1 - u2 v1` (Tables 15 and 16). Exchanging the two axes exchanges the two branches of
//! Figure 28; members of the family differ in when they do. Table 15 lists the exchanged vertex for `u1 = 0` but not
//! the exchanged indices, which belong to it.
//!
//! A test costs 8 additions, 4 subtractions, 12 multiplications and 1 division. Figure 30 computes the third coordinate
//! of the point as well, which no test reads: that would be 9 additions and 13 multiplications.

use crate::method::{GivenRay, TriangleHit, round_all};
use crate::plane::{ExactTriangle, Plane};
use photinus_num::Scalar;

/// Which points on a triangle's border belong to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Border {
    /// All of them.
    Closed,
    /// Those with `alpha + beta < 1`: the edge BC with its two vertices is left out.
    HalfOpen,
}

/// The words of one triangle.
#[derive(Clone, Copy, Debug)]
pub struct Words<S> {
    plane: Plane<S>,
    axes: [u8; 2],
    vertex: [S; 2],
    a: S,
    b: S,
    d: S,
    e: S,
}

impl<S: Scalar> Words<S> {
    /// The words of a triangle, its projected axes exchanged where `exchange(u1, v1)` says so.
    pub fn new(vertices: &[[S; 3]; 3], exchange: impl Fn(f64, f64) -> bool) -> Self {
        Self::try_new(vertices, exchange).unwrap_or_else(Self::none)
    }

    /// The words with the larger of |u1| and |v1| as the pivot.
    pub fn with_pivot(vertices: &[[S; 3]; 3]) -> Self {
        Self::new(vertices, |u1, v1| u1.abs() < v1.abs())
    }

    /// The words that no ray hits.
    pub(crate) fn none() -> Self {
        let zero = S::zero();
        Self { plane: Plane::none(), axes: [0, 1], vertex: [zero; 2], a: zero, b: zero, d: zero, e: zero }
    }

    fn try_new(vertices: &[[S; 3]; 3], exchange: impl Fn(f64, f64) -> bool) -> Option<Self> {
        let triangle = ExactTriangle::new(vertices)?;
        let edge_b = triangle.edges[0];
        let edge_c = triangle.edges[2].map(|x| -x);
        let [mut i1, mut i2] = triangle.projected_axes();
        if exchange(edge_b[i1], edge_b[i2]) {
            std::mem::swap(&mut i1, &mut i2);
        }
        let (u1, v1, u2, v2) = (edge_b[i1], edge_b[i2], edge_c[i1], edge_c[i2]);
        let det = v2 * u1 - u2 * v1;
        let [a, b, d, e] = round_all([u1 / det, v1 / det, u2 / u1, 1.0 / u1])?;
        let vertex = [vertices[0][i1], vertices[0][i2]];
        Some(Self { plane: Plane::of(&triangle)?, axes: [i1 as u8, i2 as u8], vertex, a, b, d, e })
    }

    /// The two axes that the projection keeps.
    #[inline]
    pub(crate) fn axes(&self) -> [usize; 2] {
        self.axes.map(usize::from)
    }

    /// Where the ray meets the triangle's plane.
    #[inline]
    pub(crate) fn meet(&self, ray: &GivenRay<S>, t_min: S, t_max: S) -> Option<S> {
        self.plane.meet(ray, t_min, t_max)
    }

    /// alpha and beta of the point with these coordinates along [`Words::axes`].
    #[inline]
    pub(crate) fn weights(&self, point: [S; 2]) -> [S; 2] {
        let (uv, vu) = (point[0] - self.vertex[0], point[1] - self.vertex[1]);
        let beta = vu * self.a - uv * self.b;
        [uv * self.e - beta * self.d, beta]
    }

    /// The intersection with `t_min <= t <= t_max`, if there is one.
    #[inline(always)]
    pub fn intersect(&self, ray: &GivenRay<S>, t_min: S, t_max: S, border: Border) -> Option<TriangleHit<S>> {
        let t = self.meet(ray, t_min, t_max)?;
        let [alpha, beta] = self.weights(self.axes().map(|axis| ray.coordinate(axis, t)));
        let sum = alpha + beta;
        let inside = alpha >= S::zero()
            && beta >= S::zero()
            && match border {
                Border::Closed => sum <= S::one(),
                Border::HalfOpen => sum < S::one(),
            };
        inside.then_some(TriangleHit { t, alpha, beta })
    }
}
