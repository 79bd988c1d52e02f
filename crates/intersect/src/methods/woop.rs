//! Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection" (Journal of Computer Graphics Techniques 2(1),
//! 2013): the triangle is moved and sheared so that the ray runs along an axis; three edge functions, whose signs are
//! exact, say whether the axis passes inside. No ray slips between triangles that share an edge.
//!
//! Two parts. The *filter* translates, shears and rejects in the scalar's own arithmetic; 18 subtractions and 12
//! multiplications. What it leaves, mostly hits, is *finished* in doubles, where products of two floats are exact:
//! the paper's double evaluation of edge functions that are zero, extended to all that follows, so that t and the
//! weights of slivers stay as good as the sheared vertices, nothing underflows or overflows, and any implementation of
//! the filter gives the same bits.

use crate::doubles::Doubles;
use crate::method::{RtiMethod, TriangleHit, dominant_axis, is_degenerate, is_traceable, straddles};
use photinus_num::Scalar;

/// The method.
pub struct Woop;

/// The vertices, NaN for a degenerate triangle.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<S> {
    vertices: [[S; 3]; 3],
}

/// The ray's shear (section 3.1 of the paper, without its exchange of axes: both faces are hit).
#[derive(Clone, Copy, Debug)]
pub struct Started<S> {
    /// Start of the ray.
    pub origin: [S; 3],
    /// The two other axes and the axis of the largest component of the direction.
    pub axes: [usize; 3],
    /// Components of the direction along the first two axes, divided by that along the third.
    pub shear: [S; 2],
    /// Component of the direction along the third axis.
    pub dir_z: S,
}

impl<S: Scalar> Started<S> {
    /// Translates and shears a vertex; z keeps the direction's scale.
    #[inline]
    fn shear(&self, v: &[S; 3]) -> [S; 3] {
        let [kx, ky, kz] = self.axes;
        let z = v[kz] - self.origin[kz];
        [v[kx] - self.origin[kx] - self.shear[0] * z, v[ky] - self.origin[ky] - self.shear[1] * z, z]
    }
}

impl Started<f32> {
    /// The sheared vertices, as [`finish`] takes them, of the triangle whose coordinates `at(vertex, axis)` gives.
    #[inline(always)]
    pub fn sheared(&self, at: impl Fn(usize, usize) -> f32) -> [[f32; 3]; 3] {
        let [kx, ky, kz] = self.axes;
        let vertex = |v: usize| {
            let z = at(v, kz) - self.origin[kz];
            let x = at(v, kx) - self.origin[kx] - self.shear[0] * z;
            let y = at(v, ky) - self.origin[ky] - self.shear[1] * z;
            [x, y, z]
        };
        [vertex(0), vertex(1), vertex(2)]
    }
}

#[inline]
fn edge_functions<S: Scalar>([a, b, c]: &[[S; 3]; 3]) -> [S; 3] {
    [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]]
}

/// The second half of the method: sheared vertices in doubles (from floats: exact) to a hit.
///
/// `dir_z` is [`Started::dir_z`], never zero. The result is the hit of the sheared triangle, t and the weights rounded by
/// a few 2^-53; t may lie outside the ray's interval, and is the same to the bit where the second and the third vertex change
/// places. Over any scalar so that its operations can be counted.
#[inline]
pub fn finish<S: Scalar>(sheared: &[[S; 3]; 3], dir_z: S) -> Option<TriangleHit<S>> {
    let [u, v, w] = edge_functions(sheared);
    if straddles([u, v, w], S::zero()) {
        return None;
    }
    let det = u + (v + w);
    let inv = S::one() / (det * dir_z);
    let inv_det = inv * dir_z;
    // Seen from the side, not a number, or, where vertices were doubles from the start, beyond what doubles hold.
    if !(inv_det.abs() > S::zero() && inv_det.is_finite()) {
        return None;
    }
    let t = (u * sheared[0][2] + (v * sheared[1][2] + w * sheared[2][2])) * inv;
    Some(TriangleHit { t, alpha: v * inv_det, beta: w * inv_det })
}

/// What [`finish_lanes`] gives, by lane.
pub struct LaneHits<D> {
    /// Which lanes are hits; of the others the rest means nothing.
    pub hits: u8,
    /// Ray parameters.
    pub t: D,
    /// Weights of second vertices.
    pub alpha: D,
    /// Weights of third vertices.
    pub beta: D,
}

/// [`finish`] for several triangles at a time, each with a ray of its own: coordinates by vertex and axis. No branch depends
/// on what a lane holds.
#[inline(always)]
pub fn finish_lanes<D: Doubles>(sheared: &[[D; 3]; 3], dir_z: D) -> LaneHits<D> {
    let [a, b, c] = sheared;
    let zero = dir_z.all(0.0);
    let u = c[0] * b[1] - c[1] * b[0];
    let v = a[0] * c[1] - a[1] * c[0];
    let w = b[0] * a[1] - b[1] * a[0];
    let below = u.lt(zero) | v.lt(zero) | w.lt(zero);
    let above = zero.lt(u) | zero.lt(v) | zero.lt(w);
    let det = u + (v + w);
    let inv = dir_z.all(1.0) / (det * dir_z);
    let inv_det = inv * dir_z;
    let (least, most) = (zero.all(f64::NEG_INFINITY), zero.all(f64::INFINITY));
    let is_solid = zero.lt(inv_det) & inv_det.lt(most) | inv_det.lt(zero) & least.lt(inv_det);
    let t = (u * a[2] + (v * b[2] + w * c[2])) * inv;
    LaneHits { hits: is_solid & !(below & above), t, alpha: v * inv_det, beta: w * inv_det }
}

impl<S: Scalar> RtiMethod<S> for Woop {
    const NAME: &'static str = "woop";
    type Prepared = Prepared<S>;
    type Started = Started<S>;

    fn prepare(vertices: [[S; 3]; 3]) -> Prepared<S> {
        if is_degenerate(&vertices) {
            return Prepared { vertices: [[S::from_f64(f64::NAN); 3]; 3] };
        }
        Prepared { vertices }
    }

    #[inline]
    fn start(origin: [S; 3], dir: [S; 3]) -> Option<Started<S>> {
        if !is_traceable(&origin, &dir) {
            return None;
        }
        let kz = dominant_axis(&dir);
        let (kx, ky) = ((kz + 1) % 3, (kz + 2) % 3);
        let shear = [dir[kx] / dir[kz], dir[ky] / dir[kz]];
        Some(Started { origin, axes: [kx, ky, kz], shear, dir_z: dir[kz] })
    }

    #[inline]
    fn intersect(ray: &Started<S>, triangle: &Prepared<S>, t_min: S, t_max: S) -> Option<TriangleHit<S>> {
        let sheared = triangle.vertices.map(|v| ray.shear(&v));
        // Rounding is monotonic, so a sign is right wherever the products differ, and zero where they do not.
        if straddles(edge_functions(&sheared), S::zero()) {
            return None;
        }
        let hit = finish(&sheared.map(|v| v.map(S::to_f64)), ray.dir_z.to_f64())?;
        let t = S::from_f64(hit.t);
        (t >= t_min && t <= t_max && t.is_finite()).then_some(TriangleHit {
            t,
            alpha: S::from_f64(hit.alpha),
            beta: S::from_f64(hit.beta),
        })
    }
}
