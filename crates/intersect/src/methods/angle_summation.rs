//! Angle summation (Walden, "Fastest Point in Polygon Test", Ray Tracing News 5(3), 1992; thesis, section 4.1.2): the ray meets the plane first, then the angles under which the point sees
//! the three edges are summed; inside they make a full turn, outside less.
//!
//! An angle is the arc cosine of a dot product over two lengths, which near a half turn, that is near an edge, knows no
//! more than half of the digits. So a sum within [`tolerance`] of the turn counts: points outside are hits up to about
//! an eighth of it, in lengths of the edge, from the middle of an edge, and farther from the tip of a sliver. Closed
//! within the tolerance. Arc cosines go through doubles: no hardware. 22 additions, 9 subtractions, 30 multiplications,
//! 4 divisions, 3 square roots and 3 arc cosines decide (Table 11 has 9 multiplications and about 6 additions less: it
//! seems to leave out the squares of the lengths). The weights of a hit come from the words of `badouel-pivot`: 4
//! subtractions and 4 multiplications more.

use crate::method::{GivenRay, RtiMethod, TriangleHit, dot, sub};
use crate::restructured::Words;
use photinus_num::Scalar;
use std::f64::consts::TAU;

/// The method.
pub struct AngleSummation;

/// The plane with what gives a hit its weights, and the vertices.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<S> {
    words: Words<S>,
    vertices: [[S; 3]; 3],
}

/// How much the sum of angles may lack of a full turn, in radians: 4 square roots of the number system's epsilon (0.0014
/// in single precision). A cosine of -1 that is wrong by 3 epsilons is an angle wrong by 2.4 square roots.
pub fn tolerance<S: Scalar>() -> f64 {
    4.0 * S::epsilon().to_f64().sqrt()
}

/// The angle between two vectors of these lengths; not a number where a length is zero.
#[inline]
fn angle<S: Scalar>(a: [S; 3], b: [S; 3], length_a: S, length_b: S) -> S {
    let cosine = dot(a, b) / (length_a * length_b);
    let one = S::one();
    // Rounding may leave the domain of the arc cosine; what is not a number stays so.
    let cosine = if cosine > one { one } else { cosine };
    (if cosine < -one { -one } else { cosine }).acos()
}

impl<S: Scalar> RtiMethod<S> for AngleSummation {
    const NAME: &'static str = "angle-summation";
    type Prepared = Prepared<S>;
    type Started = GivenRay<S>;

    fn prepare(vertices: [[S; 3]; 3]) -> Prepared<S> {
        Prepared { words: Words::with_pivot(&vertices), vertices }
    }

    fn start(origin: [S; 3], dir: [S; 3]) -> Option<GivenRay<S>> {
        GivenRay::new(origin, dir)
    }

    #[inline]
    fn intersect(ray: &GivenRay<S>, triangle: &Prepared<S>, t_min: S, t_max: S) -> Option<TriangleHit<S>> {
        let t = triangle.words.meet(ray, t_min, t_max)?;
        let point = ray.at(t);
        let [a, b, c] = triangle.vertices.map(|v| sub(v, point));
        let [length_a, length_b, length_c] = [a, b, c].map(|v| dot(v, v).sqrt());
        let sum = angle(a, b, length_a, length_b) + angle(b, c, length_b, length_c) + angle(c, a, length_c, length_a);
        // A vertex sees no angle.
        let at_vertex = [a, b, c].iter().any(|v| v.iter().all(|x| *x == S::zero()));
        if !(sum >= S::from_f64(TAU - tolerance::<S>()) || at_vertex) {
            return None;
        }
        let [alpha, beta] = triangle.words.weights(triangle.words.axes().map(|axis| point[axis]));
        TriangleHit::if_finite(t, alpha, beta)
    }
}
