//! Arenberg, "Ray/Triangle Intersection with Barycentric Coordinates" (Ray Tracing News 1(11), 1988): a prepared matrix
//! takes the triangle to the one with vertices (0,0,0), (1,0,0) and (0,1,0), where z = 0 is the plane and x, y are the
//! weights.
//!
//! The ray's start and direction give t from the matrix's row z; the point, relative to A in the space of the scene,
//! then goes through rows x and y (thesis, section 4.1.9). A hit costs 12 additions, 3 subtractions, 15
//! multiplications and 1 division: A is subtracted from the start once, not from start and point. The row z is the
//! normal with its largest component made one instead of the unit triangle's, which leaves t as it is.

use crate::method::{GivenRay, RtiMethod, TriangleHit, cross, dot, round_all, sub};
use crate::plane::ExactTriangle;
use photinus_num::Scalar;

/// The method.
pub struct Arenberg;

/// The first vertex and the matrix that acts relative to it; zero for a degenerate triangle.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<S> {
    vertex: [S; 3],
    x: [S; 3],
    y: [S; 3],
    z: [S; 3],
}

impl<S: Scalar> Prepared<S> {
    fn try_new(vertices: &[[S; 3]; 3]) -> Option<Self> {
        let triangle = ExactTriangle::new(vertices)?;
        let (edge_b, edge_c) = (triangle.edges[0], triangle.edges[2].map(|x| -x));
        let n = triangle.unit_normal;
        // The inverse of the matrix of columns B - A, C - A and n.
        let det = dot(n, triangle.normal);
        let x = round_all(cross(edge_c, n).map(|w| w / det))?;
        let y = round_all(cross(n, edge_b).map(|w| w / det))?;
        Some(Self { vertex: vertices[0], x, y, z: round_all(n)? })
    }
}

impl<S: Scalar> RtiMethod<S> for Arenberg {
    const NAME: &'static str = "arenberg";
    type Prepared = Prepared<S>;
    type Started = GivenRay<S>;

    fn prepare(vertices: [[S; 3]; 3]) -> Prepared<S> {
        let zero = [S::zero(); 3];
        Prepared::try_new(&vertices).unwrap_or(Prepared { vertex: zero, x: zero, y: zero, z: zero })
    }

    fn start(origin: [S; 3], dir: [S; 3]) -> Option<GivenRay<S>> {
        GivenRay::new(origin, dir)
    }

    #[inline]
    fn intersect(ray: &GivenRay<S>, triangle: &Prepared<S>, t_min: S, t_max: S) -> Option<TriangleHit<S>> {
        let zero = S::zero();
        let along = dot(triangle.z, ray.dir);
        if along == zero {
            return None;
        }
        let from_vertex = sub(ray.origin, triangle.vertex);
        let t = -dot(triangle.z, from_vertex) / along;
        if !(t >= t_min && t <= t_max && t.is_finite()) {
            return None;
        }
        let point = GivenRay { origin: from_vertex, dir: ray.dir }.at(t);
        let alpha = dot(triangle.x, point);
        if !(alpha >= zero) {
            return None;
        }
        let beta = dot(triangle.y, point);
        (beta >= zero && alpha + beta <= S::one()).then_some(TriangleHit { t, alpha, beta })
    }
}
