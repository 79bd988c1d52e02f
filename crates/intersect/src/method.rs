//! What every ray-triangle method answers.

use photinus_num::Scalar;

/// Where a ray meets a triangle: the point is `A + alpha (B - A) + beta (C - A)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit<S> {
    /// Ray parameter.
    pub t: S,
    /// Weight of the second vertex.
    pub alpha: S,
    /// Weight of the third vertex.
    pub beta: S,
}

impl<S: Scalar> TriangleHit<S> {
    /// The hit, unless a weight overflowed.
    #[inline]
    pub(crate) fn if_finite(t: S, alpha: S, beta: S) -> Option<Self> {
        (alpha.is_finite() && beta.is_finite()).then_some(Self { t, alpha, beta })
    }
}

/// A ray-triangle intersection test (thesis: RTI).
///
/// All methods but `badouel-hardware` are closed: points on edges and vertices are hits. So are `t = t_min` and
/// `t = t_max` in all. Degenerate triangles ([`is_degenerate`]), triangles whose prepared words leave the number
/// system's range, and rays that are not finite or have no direction never hit. Both faces are hit.
pub trait RtiMethod<S: Scalar> {
    /// The name on the command line.
    const NAME: &'static str;

    /// What is computed once for a triangle.
    type Prepared: Copy;

    /// What is computed once for a ray.
    type Started: Copy;

    /// Prepares the triangle of vertices A, B, C.
    fn prepare(vertices: [[S; 3]; 3]) -> Self::Prepared;

    /// Starts a ray; `dir` need not be of unit length. `None`: the ray can hit nothing.
    fn start(origin: [S; 3], dir: [S; 3]) -> Option<Self::Started>;

    /// The intersection with `t_min <= t <= t_max`, if there is one.
    fn intersect(ray: &Self::Started, triangle: &Self::Prepared, t_min: S, t_max: S) -> Option<TriangleHit<S>>;
}

/// Whether a triangle spans no area: the cross product of its edges, in doubles, is exactly zero or not finite.
pub fn is_degenerate<S: Scalar>(vertices: &[[S; 3]; 3]) -> bool {
    let [a, b, c] = vertices.map(|v| v.map(S::to_f64));
    let n = cross(sub(b, a), sub(c, a));
    !n.iter().all(|x| x.is_finite()) || n == [0.0; 3]
}

/// A ray as it came: what methods that compute nothing for a ray start with.
#[derive(Clone, Copy, Debug)]
pub struct GivenRay<S> {
    /// Start of the ray.
    pub origin: [S; 3],
    /// Direction, of any length but zero.
    pub dir: [S; 3],
}

impl<S: Scalar> GivenRay<S> {
    /// The ray; `None` where it can hit nothing.
    pub fn new(origin: [S; 3], dir: [S; 3]) -> Option<Self> {
        is_traceable(&origin, &dir).then_some(Self { origin, dir })
    }

    /// The coordinate along `axis` of the point at `t`.
    #[inline]
    pub fn coordinate(&self, axis: usize, t: S) -> S {
        self.dir[axis] * t + self.origin[axis]
    }

    /// The point at `t`.
    #[inline]
    pub fn at(&self, t: S) -> [S; 3] {
        std::array::from_fn(|axis| self.coordinate(axis, t))
    }
}

/// Whether a ray can hit anything: finite, with a direction.
#[inline]
pub(crate) fn is_traceable<S: Scalar>(origin: &[S; 3], dir: &[S; 3]) -> bool {
    let finite = |v: &[S; 3]| v[0].is_finite() & v[1].is_finite() & v[2].is_finite();
    let zero = S::zero();
    finite(origin) & finite(dir) & ((dir[0] != zero) | (dir[1] != zero) | (dir[2] != zero))
}

pub(crate) fn sub<S: Scalar>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn dot<S: Scalar>(a: [S; 3], b: [S; 3]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross<S: Scalar>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Words in the number system; `None` where one of them leaves its range.
pub(crate) fn round_all<S: Scalar, const N: usize>(words: [f64; N]) -> Option<[S; N]> {
    let rounded = words.map(S::from_f64);
    rounded.iter().all(|word| word.is_finite()).then_some(rounded)
}

/// Whether values of these signs lie on both sides of zero; NaN lies on neither.
#[inline]
pub(crate) fn straddles<S: PartialOrd>(values: [S; 3], zero: S) -> bool {
    values.iter().any(|x| *x < zero) && values.iter().any(|x| *x > zero)
}

/// The axis of the largest magnitude, the lowest of equals.
#[inline]
pub(crate) fn dominant_axis<S: Scalar>(v: &[S; 3]) -> usize {
    let [x, y, z] = v.map(S::abs);
    if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    }
}
