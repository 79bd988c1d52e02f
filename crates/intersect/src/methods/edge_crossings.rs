//! Edge crossings (Shimrat, "Algorithm 112: Position of Point Relative to Polygon", CACM 5(8), 1962; thesis, section
//! 4.1.4): the ray meets the plane first, then a line from the
//! point along the first projected axis is followed to infinity; it crosses the border of the triangle once from inside
//! and never or twice from outside.
//!
//! Prepared are the plane and, of each projected edge, its ends and its slope, so that a crossing is one subtraction, one
//! multiplication and one addition, computed for all three: 10 additions, 3 subtractions, 11 multiplications and 1
//! division decide. An end belongs to the edge above it, which counts a vertex once; points on an edge, which that rule
//! would give to one of two neighbours, are hits. The weights of a hit come from the words of `badouel-pivot`: 4
//! subtractions and 4 multiplications more.

use crate::method::{GivenRay, RtiMethod, TriangleHit, round_all};
use crate::plane::ExactTriangle;
use crate::restructured::Words;
use photinus_num::Scalar;

/// The method.
pub struct EdgeCrossings;

/// A projected edge, from its lower end (along the second axis) to its upper one.
#[derive(Clone, Copy, Debug)]
struct Edge<S> {
    low: [S; 2],
    high: [S; 2],
    /// Steps along the first axis for one along the second; zero for a level edge.
    slope: S,
}

/// Where a point lies to an edge.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// The line from the point crosses it.
    Before,
    /// The point is on it.
    On,
    /// Neither.
    Beside,
}

impl<S: Scalar> Edge<S> {
    fn none() -> Self {
        Self { low: [S::zero(); 2], high: [S::zero(); 2], slope: S::zero() }
    }

    /// `None` where the slope leaves the number system's range.
    fn new(p: [f64; 2], q: [f64; 2]) -> Option<Self> {
        let (low, high) = if (p[1], p[0]) <= (q[1], q[0]) { (p, q) } else { (q, p) };
        let level = low[1] == high[1];
        let slope = if level { 0.0 } else { (high[0] - low[0]) / (high[1] - low[1]) };
        let [slope] = round_all([slope])?;
        Some(Self { low: low.map(S::from_f64), high: high.map(S::from_f64), slope })
    }

    #[inline]
    fn place(&self, [x, y]: [S; 2]) -> Place {
        let crossing = self.low[0] + (y - self.low[1]) * self.slope;
        if !(y >= self.low[1] && y <= self.high[1]) {
            return Place::Beside;
        }
        let level = self.low[1] == self.high[1];
        // The slope rounds: the upper end is on the edge whatever the crossing says.
        let at_end = y == self.high[1] && x == self.high[0];
        let on = if level { x >= self.low[0] && x <= self.high[0] } else { x == crossing || at_end };
        match () {
            () if on => Place::On,
            () if y < self.high[1] && crossing > x => Place::Before,
            () => Place::Beside,
        }
    }
}

/// The edges, the plane, and what gives a hit its weights.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<S> {
    words: Words<S>,
    edges: [Edge<S>; 3],
}

impl<S: Scalar> Prepared<S> {
    fn edges(vertices: &[[S; 3]; 3], axes: [usize; 2]) -> Option<[Edge<S>; 3]> {
        let [a, b, c] = ExactTriangle::new(vertices)?.vertices.map(|v| axes.map(|axis| v[axis]));
        Some([Edge::new(a, b)?, Edge::new(b, c)?, Edge::new(c, a)?])
    }
}

impl<S: Scalar> RtiMethod<S> for EdgeCrossings {
    const NAME: &'static str = "edge-crossings";
    type Prepared = Prepared<S>;
    type Started = GivenRay<S>;

    fn prepare(vertices: [[S; 3]; 3]) -> Prepared<S> {
        let words = Words::with_pivot(&vertices);
        match Prepared::edges(&vertices, words.axes()) {
            Some(edges) => Prepared { words, edges },
            None => Prepared { words: Words::none(), edges: [Edge::none(); 3] },
        }
    }

    fn start(origin: [S; 3], dir: [S; 3]) -> Option<GivenRay<S>> {
        GivenRay::new(origin, dir)
    }

    #[inline]
    fn intersect(ray: &GivenRay<S>, triangle: &Prepared<S>, t_min: S, t_max: S) -> Option<TriangleHit<S>> {
        let t = triangle.words.meet(ray, t_min, t_max)?;
        let point = triangle.words.axes().map(|axis| ray.coordinate(axis, t));
        let places = triangle.edges.map(|edge| edge.place(point));
        let crossings = places.iter().filter(|place| **place == Place::Before).count();
        if crossings != 1 && !places.contains(&Place::On) {
            return None;
        }
        let [alpha, beta] = triangle.words.weights(point);
        TriangleHit::if_finite(t, alpha, beta)
    }
}
