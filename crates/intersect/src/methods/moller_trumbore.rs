//! Moller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (Journal of Graphics Tools 2(1), 1997):
//! Cramer's rule on `origin + t dir = A + alpha (B - A) + beta (C - A)`, without the plane of the triangle.
//!
//! The two edge vectors are prepared. A hit costs 9 additions, 9 subtractions, 27 multiplications and 1 division
//! (thesis, Table 11). Neighbours disagree about their shared edge by rounding: rays can slip through.

use crate::method::{GivenRay, RtiMethod, TriangleHit, cross, dot, is_degenerate, sub};
use photinus_num::Scalar;

/// The method.
pub struct MollerTrumbore;

/// A vertex and two edges; edges of a degenerate triangle are zero.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<S> {
    vertex: [S; 3],
    edge_b: [S; 3],
    edge_c: [S; 3],
}

impl<S: Scalar> RtiMethod<S> for MollerTrumbore {
    const NAME: &'static str = "moller-trumbore";
    type Prepared = Prepared<S>;
    type Started = GivenRay<S>;

    fn prepare(vertices: [[S; 3]; 3]) -> Prepared<S> {
        if is_degenerate(&vertices) {
            let zero = [S::zero(); 3];
            return Prepared { vertex: zero, edge_b: zero, edge_c: zero };
        }
        let [a, b, c] = vertices;
        Prepared { vertex: a, edge_b: sub(b, a), edge_c: sub(c, a) }
    }

    fn start(origin: [S; 3], dir: [S; 3]) -> Option<GivenRay<S>> {
        GivenRay::new(origin, dir)
    }

    #[inline]
    fn intersect(ray: &GivenRay<S>, triangle: &Prepared<S>, t_min: S, t_max: S) -> Option<TriangleHit<S>> {
        let (zero, one) = (S::zero(), S::one());
        let p = cross(ray.dir, triangle.edge_c);
        let det = dot(triangle.edge_b, p);
        if det == zero {
            return None;
        }
        let inv_det = one / det;
        let from_vertex = sub(ray.origin, triangle.vertex);
        let alpha = dot(from_vertex, p) * inv_det;
        if !(alpha >= zero && alpha <= one) {
            return None;
        }
        let q = cross(from_vertex, triangle.edge_b);
        let beta = dot(ray.dir, q) * inv_det;
        if !(beta >= zero && alpha + beta <= one) {
            return None;
        }
        let t = dot(triangle.edge_c, q) * inv_det;
        (t >= t_min && t <= t_max && t.is_finite()).then_some(TriangleHit { t, alpha, beta })
    }
}
