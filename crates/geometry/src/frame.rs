//! Orthonormal frames around a normal.

use glam::Vec3;

/// A right-handed orthonormal basis; local z is the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x.
    pub s: Vec3,
    /// Local y.
    pub t: Vec3,
    /// Local z.
    pub n: Vec3,
}

impl Frame {
    /// Some frame around the unit vector `n`, continuous but for n.z = 0 (Duff et al., "Building an Orthonormal
    /// Basis, Revisited", JCGT 6(1), 2017).
    #[inline]
    pub fn from_normal(n: Vec3) -> Self {
        let sign = 1f32.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            s: Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            t: Vec3::new(b, sign + n.y * n.y * a, -n.y),
            n,
        }
    }

    /// The frame around the unit vector `n` whose x points along `tangent` as far as it can; any frame where
    /// `tangent` is parallel to `n`, zero or not finite.
    pub fn from_normal_and_tangent(n: Vec3, tangent: Vec3) -> Self {
        let s = tangent - n * n.dot(tangent);
        let length_sq = s.length_squared();
        if !(length_sq > 1e-12 * tangent.length_squared()) || !length_sq.is_finite() {
            return Self::from_normal(n);
        }
        let s = s / length_sq.sqrt();
        Self { s, t: n.cross(s), n }
    }

    /// World to local.
    #[inline]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.s.dot(v), self.t.dot(v), self.n.dot(v))
    }

    /// Local to world.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.s * v.x + self.t * v.y + self.n * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for n in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::Z, Vec3::new(0.6, -0.48, -0.64), Vec3::new(1e-20, 0.0, -1.0)] {
            for f in [Frame::from_normal(n), Frame::from_normal_and_tangent(n, Vec3::new(0.3, 2.0, -1.0))] {
                assert!(f.s.dot(f.t).abs() < 1e-6 && f.s.dot(f.n).abs() < 1e-6 && f.t.dot(f.n).abs() < 1e-6);
                assert!((f.s.cross(f.t) - f.n).length() < 1e-6, "{n}: {f:?}");
                let v = Vec3::new(0.1, -2.0, 0.7);
                assert!((f.to_world(f.to_local(v)) - v).length() < 1e-6);
            }
        }
    }

    #[test]
    fn useless_tangents_still_give_a_frame() {
        for tangent in [Vec3::ZERO, Vec3::Z, Vec3::NAN, Vec3::INFINITY] {
            let f = Frame::from_normal_and_tangent(Vec3::Z, tangent);
            assert!((f.s.cross(f.t) - Vec3::Z).length() < 1e-6);
        }
    }
}
