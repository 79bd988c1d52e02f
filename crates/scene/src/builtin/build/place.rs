//! Where a part stands: turns, scales and shifts, with the same bits on every machine.

use photinus_geometry::{Frame, Mat3, Vec3};

/// Sine and cosine of an angle in degrees; exact at whole quarter turns, so that upright boxes stay axis-aligned.
pub fn sin_cos_degrees(degrees: f32) -> (f32, f32) {
    let turned = degrees - 360.0 * (degrees / 360.0).floor();
    match turned {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => {
            let radians = turned.to_radians();
            (libm::sinf(radians), libm::cosf(radians))
        }
    }
}

/// An affine map from a part's own coordinates to those of what it is put into.
///
/// Calls chain from the outside in: `Place::at(a).yaw(b).at(c)` first shifts by c, then turns by b, then shifts by a.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    linear: Mat3,
    offset: Vec3,
}

impl Place {
    /// Where it is.
    pub const HERE: Self = Self { linear: Mat3::IDENTITY, offset: Vec3::ZERO };

    /// A shift.
    pub fn at(x: f32, y: f32, z: f32) -> Self {
        Self::HERE.shift(x, y, z)
    }

    /// A part at `origin` whose z axis points along `forward` and whose y axis as far along `up` as it can.
    pub fn facing(origin: Vec3, forward: Vec3, up: Vec3) -> Self {
        let z = forward / forward.length();
        let frame = Frame::from_normal_and_tangent(z, up);
        Self { linear: Mat3::from_cols(frame.s.cross(z), frame.s, z), offset: origin }
    }

    /// Shifts the part, along its own axes.
    pub fn shift(self, x: f32, y: f32, z: f32) -> Self {
        self.inside(Mat3::IDENTITY, Vec3::new(x, y, z))
    }

    /// Turns the part about its y axis, from z towards x, in degrees.
    pub fn yaw(self, degrees: f32) -> Self {
        let (s, c) = sin_cos_degrees(degrees);
        self.inside(Mat3::from_cols(Vec3::new(c, 0.0, -s), Vec3::Y, Vec3::new(s, 0.0, c)), Vec3::ZERO)
    }

    /// Turns the part about its x axis, from y towards z, in degrees.
    pub fn pitch(self, degrees: f32) -> Self {
        let (s, c) = sin_cos_degrees(degrees);
        self.inside(Mat3::from_cols(Vec3::X, Vec3::new(0.0, c, s), Vec3::new(0.0, -s, c)), Vec3::ZERO)
    }

    /// Turns the part about its z axis, from x towards y, in degrees.
    pub fn roll(self, degrees: f32) -> Self {
        let (s, c) = sin_cos_degrees(degrees);
        self.inside(Mat3::from_cols(Vec3::new(c, s, 0.0), Vec3::new(-s, c, 0.0), Vec3::Z), Vec3::ZERO)
    }

    /// Scales the part along its axes; no factor may be zero.
    pub fn scale(self, x: f32, y: f32, z: f32) -> Self {
        self.inside(Mat3::from_cols(Vec3::X * x, Vec3::Y * y, Vec3::Z * z), Vec3::ZERO)
    }

    fn inside(self, linear: Mat3, offset: Vec3) -> Self {
        Self { linear: self.linear * linear, offset: self.point(offset) }
    }

    /// This place inside another.
    pub fn within(self, outer: Self) -> Self {
        outer.inside(self.linear, self.offset)
    }

    /// Maps a point.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.linear * p + self.offset
    }

    /// Maps a direction.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.linear * v
    }

    /// Maps a unit normal to a unit normal: by the cofactors, which needs no inverse and keeps the side.
    pub fn normal(&self, n: Vec3) -> Vec3 {
        let [a, b, c] = [self.linear.x_axis, self.linear.y_axis, self.linear.z_axis];
        let turned = b.cross(c) * n.x + c.cross(a) * n.y + a.cross(b) * n.z;
        let turned = if self.mirrors() { -turned } else { turned };
        turned / turned.length()
    }

    /// Whether it turns left into right.
    pub fn mirrors(&self) -> bool {
        self.linear.x_axis.cross(self.linear.y_axis).dot(self.linear.z_axis) < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_chain_from_the_outside_in() {
        let p = Place::at(1.0, 2.0, 3.0).yaw(90.0).shift(0.0, 0.0, 5.0);
        assert_eq!(p.point(Vec3::ZERO), Vec3::new(6.0, 2.0, 3.0));
        assert_eq!(Place::HERE.pitch(90.0).point(Vec3::Y), Vec3::Z);
        assert_eq!(Place::HERE.roll(90.0).point(Vec3::X), Vec3::Y);
        let looking = Place::facing(Vec3::ONE, Vec3::X, Vec3::Y);
        assert!((looking.point(Vec3::Z) - Vec3::new(2.0, 1.0, 1.0)).length() < 1e-6);
        assert!((looking.point(Vec3::Y) - Vec3::new(1.0, 2.0, 1.0)).length() < 1e-6 && !looking.mirrors());
        let outer = Place::at(0.0, 10.0, 0.0).yaw(30.0);
        let inner = Place::at(4.0, 0.0, 0.0).roll(20.0);
        let v = Vec3::new(1.0, -2.0, 0.5);
        assert!((inner.within(outer).point(v) - outer.point(inner.point(v))).length() < 1e-5);
    }

    /// A normal stays perpendicular to a mapped tangent plane, on the side away from a mapped inner point.
    #[test]
    fn normals_follow_scales_and_mirrors() {
        let n = Vec3::new(0.6, 0.64, 0.48);
        let (t, b) = (Vec3::new(0.8, -0.48, -0.36), Vec3::new(0.0, 0.6, -0.8));
        for place in [Place::HERE.scale(2.0, 1.0, 0.5).yaw(20.0), Place::HERE.pitch(70.0).scale(-1.0, 3.0, 1.0)] {
            let m = place.normal(n);
            assert!((m.length() - 1.0).abs() < 1e-6);
            assert!(m.dot(place.vector(t)).abs() < 1e-5 && m.dot(place.vector(b)).abs() < 1e-5);
            assert!(m.dot(place.vector(n)) > 0.0);
        }
    }
}
