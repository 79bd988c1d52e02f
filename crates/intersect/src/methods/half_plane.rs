//! Half-plane test (Green, "Simple, Fast Triangle Intersection", Ray Tracing News 6(1), 1993; thesis, section 4.1.3): the ray meets the plane first, then the cross products of each edge with the vector from its start to the
//! point must have the normal's direction.
//!
//! The products are compared with the normal, one dot product each: 14 additions, 18 subtractions, 36 multiplications
//! and 1 division. Table 11 has 12 additions and 33 multiplications, which fits two dot products among the three
//! cross products; but where one of these is zero, on an edge's line outside of the edge, both dot products are zero
//! and a closed test would hit. The prepared edges are divided by what makes the dot products the weights.

use crate::method::{GivenRay, RtiMethod, TriangleHit, cross, dot, round_all, sub};
use crate::plane::{ExactTriangle, Plane};
use photinus_num::Scalar;

/// The method.
pub struct HalfPlane;

/// The plane, the vertices, and B - A, C - B and A - C over the normal's projection on the plane's.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<S> {
    plane: Plane<S>,
    vertices: [[S; 3]; 3],
    edges: [[S; 3]; 3],
}

impl<S: Scalar> Prepared<S> {
    fn try_new(vertices: &[[S; 3]; 3]) -> Option<Self> {
        let triangle = ExactTriangle::new(vertices)?;
        let scale = dot(triangle.unit_normal, triangle.normal);
        let mut edges = [[S::zero(); 3]; 3];
        for (edge, exact) in edges.iter_mut().zip(triangle.edges) {
            *edge = round_all(exact.map(|x| x / scale))?;
        }
        Some(Self { plane: Plane::of(&triangle)?, vertices: *vertices, edges })
    }

    /// The weight of the vertex across from edge `i`, at a point of the plane.
    #[inline]
    fn weight(&self, i: usize, point: [S; 3]) -> S {
        dot(cross(self.edges[i], sub(point, self.vertices[i])), self.plane.normal())
    }
}

impl<S: Scalar> RtiMethod<S> for HalfPlane {
    const NAME: &'static str = "half-plane";
    type Prepared = Prepared<S>;
    type Started = GivenRay<S>;

    fn prepare(vertices: [[S; 3]; 3]) -> Prepared<S> {
        let none = [[S::zero(); 3]; 3];
        Prepared::try_new(&vertices).unwrap_or(Prepared { plane: Plane::none(), vertices: none, edges: none })
    }

    fn start(origin: [S; 3], dir: [S; 3]) -> Option<GivenRay<S>> {
        GivenRay::new(origin, dir)
    }

    #[inline]
    fn intersect(ray: &GivenRay<S>, triangle: &Prepared<S>, t_min: S, t_max: S) -> Option<TriangleHit<S>> {
        let zero = S::zero();
        let t = triangle.plane.meet(ray, t_min, t_max)?;
        let point = ray.at(t);
        let beta = triangle.weight(0, point);
        if !(beta >= zero) {
            return None;
        }
        let alpha = triangle.weight(2, point);
        if !(alpha >= zero && triangle.weight(1, point) >= zero) {
            return None;
        }
        TriangleHit::if_finite(t, alpha, beta)
    }
}
