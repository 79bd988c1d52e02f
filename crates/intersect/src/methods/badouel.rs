//! Badouel, "An Efficient Ray-Polygon Intersection" (Graphics Gems, 1990), as the thesis publishes it in Figure 28:
//! the ray meets the plane first, then the point is tested in the projection along the plane's dominant axis.
//!
//! Two branches solve `u0 = alpha u1 + beta u2`, `v0 = alpha v1 + beta v2` (equation 15), dividing by u1 or by v1.
//! Figure 28 changes to the second branch only where u1 is exactly zero, so that a tiny u1 ruins alpha; here the
//! larger of |u1| and |v1| is the pivot. A hit costs 9 additions, 4 subtractions, 14 multiplications and 1 division:
//! one multiplication more than Figure 30, which folds `recip_det` into its operands.

use crate::method::{RtiMethod, TriangleHit, cross, dominant_axis, dot, is_degenerate, is_traceable, sub};
use photinus_num::Scalar;

/// The method.
pub struct Badouel;

/// Plane, projection and the reciprocals that the branches need.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<S> {
    /// `a x + b y + c z + d = 0`; all zero for a degenerate triangle.
    plane: [S; 4],
    /// First projected axis: that of the pivot.
    i1: u8,
    /// Second projected axis.
    i2: u8,
    /// Projected vertex A.
    vertex: [S; 2],
    u1: S,
    v1: S,
    u2: S,
    recip_u1: S,
    recip_det: S,
}

/// The ray as it came.
#[derive(Clone, Copy, Debug)]
pub struct Started<S> {
    origin: [S; 3],
    dir: [S; 3],
}

impl<S: Scalar> RtiMethod<S> for Badouel {
    const NAME: &'static str = "badouel";
    type Prepared = Prepared<S>;
    type Started = Started<S>;

    fn prepare(vertices: [[S; 3]; 3]) -> Prepared<S> {
        // Prepared once and rounded once: in doubles.
        let exact = vertices.map(|v| v.map(S::to_f64));
        let [a, b, c] = exact;
        let (edge_b, edge_c) = (sub(b, a), sub(c, a));
        let normal = cross(edge_b, edge_c);
        let axis = dominant_axis(&normal);
        let (mut i1, mut i2) = ((axis + 1) % 3, (axis + 2) % 3);
        // Exchanging the axes exchanges the two branches of Figure 28, so that one is left.
        if edge_b[i1].abs() < edge_b[i2].abs() {
            std::mem::swap(&mut i1, &mut i2);
        }
        let (u1, v1, u2, v2) = (edge_b[i1], edge_b[i2], edge_c[i1], edge_c[i2]);
        let det = v2 * u1 - u2 * v1;
        let (recip_u1, recip_det) = (1.0 / u1, 1.0 / det);
        // The plane's scale is free; the largest component as one keeps every scene in range.
        let n = normal.map(|x| x / normal[axis]);
        let plane = [n[0], n[1], n[2], -dot(n, a)];
        let usable = plane.iter().chain(&[recip_u1, recip_det]).all(|x| S::from_f64(*x).is_finite());
        if is_degenerate(&vertices) || !usable {
            let zero = S::zero();
            return Prepared {
                plane: [zero; 4],
                i1: 0,
                i2: 1,
                vertex: [zero; 2],
                u1: zero,
                v1: zero,
                u2: zero,
                recip_u1: zero,
                recip_det: zero,
            };
        }
        Prepared {
            plane: plane.map(S::from_f64),
            i1: i1 as u8,
            i2: i2 as u8,
            vertex: [vertices[0][i1], vertices[0][i2]],
            u1: S::from_f64(u1),
            v1: S::from_f64(v1),
            u2: S::from_f64(u2),
            recip_u1: S::from_f64(recip_u1),
            recip_det: S::from_f64(recip_det),
        }
    }

    fn start(origin: [S; 3], dir: [S; 3]) -> Option<Started<S>> {
        is_traceable(&origin, &dir).then_some(Started { origin, dir })
    }

    #[inline]
    fn intersect(ray: &Started<S>, triangle: &Prepared<S>, t_min: S, t_max: S) -> Option<TriangleHit<S>> {
        let zero = S::zero();
        let [a, b, c, d] = triangle.plane;
        let along = dot([a, b, c], ray.dir);
        if along == zero {
            return None;
        }
        let t = -(dot([a, b, c], ray.origin) + d) / along;
        if !(t >= t_min && t <= t_max && t.is_finite()) {
            return None;
        }
        let point: [S; 3] = std::array::from_fn(|i| ray.dir[i] * t + ray.origin[i]);
        let u0 = point[usize::from(triangle.i1)] - triangle.vertex[0];
        let v0 = point[usize::from(triangle.i2)] - triangle.vertex[1];
        let beta = (v0 * triangle.u1 - u0 * triangle.v1) * triangle.recip_det;
        if !(beta >= zero && beta <= S::one()) {
            return None;
        }
        let alpha = (u0 - beta * triangle.u2) * triangle.recip_u1;
        (alpha >= zero && alpha + beta <= S::one()).then_some(TriangleHit { t, alpha, beta })
    }
}
