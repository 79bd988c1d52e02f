//! The plane of a triangle and the ray-plane test that most methods begin with.

use crate::method::{GivenRay, cross, dominant_axis, dot, is_degenerate, round_all, sub};
use photinus_num::Scalar;

/// A triangle with an area, in doubles: what preparation computes from, so that each word is rounded once.
pub(crate) struct ExactTriangle {
    /// A, B, C.
    pub vertices: [[f64; 3]; 3],
    /// B - A, C - B, A - C.
    pub edges: [[f64; 3]; 3],
    /// (B - A) x (C - A).
    pub normal: [f64; 3],
    /// Axis of the normal's largest component.
    pub axis: usize,
    /// The normal, its component along `axis` made one: the plane's scale is free, and this one keeps every scene in
    /// range.
    pub unit_normal: [f64; 3],
}

impl ExactTriangle {
    /// `None` for a degenerate triangle.
    pub fn new<S: Scalar>(vertices: &[[S; 3]; 3]) -> Option<Self> {
        if is_degenerate(vertices) {
            return None;
        }
        let vertices = vertices.map(|v| v.map(S::to_f64));
        let [a, b, c] = vertices;
        let normal = cross(sub(b, a), sub(c, a));
        let axis = dominant_axis(&normal);
        let unit_normal = normal.map(|x| x / normal[axis]);
        Some(Self { vertices, edges: [sub(b, a), sub(c, b), sub(a, c)], normal, axis, unit_normal })
    }

    /// The two axes that the projection along `axis` keeps, in cyclic order.
    pub fn projected_axes(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }
}

/// `a x + b y + c z + d = 0` (thesis, equation 3).
#[derive(Clone, Copy, Debug)]
pub struct Plane<S> {
    normal: [S; 3],
    d: S,
}

impl<S: Scalar> Plane<S> {
    /// The plane that no ray meets.
    pub(crate) fn none() -> Self {
        Self { normal: [S::zero(); 3], d: S::zero() }
    }

    /// The plane of a triangle; `None` where it leaves the number system's range.
    pub(crate) fn of(triangle: &ExactTriangle) -> Option<Self> {
        let n = triangle.unit_normal;
        let [a, b, c, d] = round_all([n[0], n[1], n[2], -dot(n, triangle.vertices[0])])?;
        Some(Self { normal: [a, b, c], d })
    }

    /// Its normal, of which the largest component is one.
    #[inline]
    pub(crate) fn normal(&self) -> [S; 3] {
        self.normal
    }

    /// Where the ray meets it (thesis, equation 4), with `t_min <= t <= t_max`: 5 additions, 6 multiplications and 1
    /// division. A ray along the plane does not meet it.
    #[inline]
    pub fn meet(&self, ray: &GivenRay<S>, t_min: S, t_max: S) -> Option<S> {
        let along = dot(self.normal, ray.dir);
        if along == S::zero() {
            return None;
        }
        let t = -(dot(self.normal, ray.origin) + self.d) / along;
        (t >= t_min && t <= t_max && t.is_finite()).then_some(t)
    }
}
