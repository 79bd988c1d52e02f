//! Pluecker coordinates (Erickson, Ray Tracing News 10(3), 1997; Jones, Ray Tracing News 13(1), 2000): a line through
//! the points P and Q is the pair of its direction Q - P and its moment P x Q; the ray meets the triangle where it
//! passes all three edges on the same side.
//!
//! The permuted inner product of the ray (d, m) and an edge (e, n) is `d . n + m . e`: twice the signed volume between
//! the two lines, whose sign is the side. That is equation 21 of the thesis with the coordinates that its text defines,
//! `L1 L2 L4` the direction and `L6 -L5 L3` the moment. Equation 24 orders and signs them for another product
//! (`E0 F4 + E1 F5 + E2 F3 + E3 F2 + E4 F0 + E5 F1`) and prints three differences with wrong letters; the two are not
//! mixed here.
//!
//! Prepared are the three edges in full, so that two triangles get opposite words for the edge they share and never
//! disagree about its side; the thesis derives the third direction from the other two (equation 25), which rounds. The
//! sum of the three products is the ray's direction along the normal, which gives t and the weights: a hit costs 20
//! additions, 24 multiplications and 1 division, and a ray 3 subtractions and 6 multiplications once. Moments are taken
//! about the origin of coordinates: far from it they cancel.

use crate::method::{RtiMethod, TriangleHit, cross, dot, is_traceable, round_all, straddles};
use crate::plane::ExactTriangle;
use photinus_num::Scalar;

/// The method.
pub struct Pluecker;

/// A line: its direction and its moment about the origin of coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Line<S> {
    dir: [S; 3],
    moment: [S; 3],
}

impl<S: Scalar> Line<S> {
    /// The line through `p` along `dir`.
    pub fn along(p: [S; 3], dir: [S; 3]) -> Self {
        Self { dir, moment: cross(p, dir) }
    }

    /// The permuted inner product: zero where the lines meet, else its sign says on which side they pass.
    #[inline]
    pub fn side(&self, other: &Self) -> S {
        dot(self.dir, other.moment) + dot(self.moment, other.dir)
    }
}

/// The edges AB, BC and CA and the plane `normal . p + d = 0`; all zero for a degenerate triangle.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<S> {
    edges: [Line<S>; 3],
    normal: [S; 3],
    d: S,
}

impl<S: Scalar> Prepared<S> {
    fn try_new(vertices: &[[S; 3]; 3]) -> Option<Self> {
        let triangle = ExactTriangle::new(vertices)?;
        let [a, b, c] = triangle.vertices;
        let mut edges = [Line { dir: [S::zero(); 3], moment: [S::zero(); 3] }; 3];
        for ((edge, dir), (p, q)) in edges.iter_mut().zip(triangle.edges).zip([(a, b), (b, c), (c, a)]) {
            *edge = Line { dir: round_all(dir)?, moment: round_all(cross(p, q))? };
        }
        let n = triangle.normal;
        let [x, y, z, d] = round_all([n[0], n[1], n[2], -dot(n, a)])?;
        Some(Self { edges, normal: [x, y, z], d })
    }
}

/// The ray as a point and a line.
#[derive(Clone, Copy, Debug)]
pub struct Started<S> {
    origin: [S; 3],
    line: Line<S>,
}

impl<S: Scalar> RtiMethod<S> for Pluecker {
    const NAME: &'static str = "pluecker";
    type Prepared = Prepared<S>;
    type Started = Started<S>;

    fn prepare(vertices: [[S; 3]; 3]) -> Prepared<S> {
        let zero = S::zero();
        let nothing = Line { dir: [zero; 3], moment: [zero; 3] };
        Prepared::try_new(&vertices).unwrap_or(Prepared { edges: [nothing; 3], normal: [zero; 3], d: zero })
    }

    fn start(origin: [S; 3], dir: [S; 3]) -> Option<Started<S>> {
        is_traceable(&origin, &dir).then(|| Started { origin, line: Line::along(origin, dir) })
    }

    #[inline]
    fn intersect(ray: &Started<S>, triangle: &Prepared<S>, t_min: S, t_max: S) -> Option<TriangleHit<S>> {
        let sides = triangle.edges.map(|edge| ray.line.side(&edge));
        if straddles(sides, S::zero()) {
            return None;
        }
        let sum = sides[0] + sides[1] + sides[2];
        if sum == S::zero() {
            return None;
        }
        let inv_sum = S::one() / sum;
        let t = -(dot(triangle.normal, ray.origin) + triangle.d) * inv_sum;
        let [alpha, beta] = [sides[2] * inv_sum, sides[0] * inv_sum];
        if !(t >= t_min && t <= t_max && t.is_finite()) {
            return None;
        }
        TriangleHit::if_finite(t, alpha, beta)
    }
}
