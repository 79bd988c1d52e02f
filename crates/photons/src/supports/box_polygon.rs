//! The box along the axes over the exact area of the polygon that the tangent plane cuts out of it (Hoggins 2010, section
//! 6.2.2.4.2, the second of three choices; Figure 43).
//!
//! Measure: the largest of the distances along the axes. A plane through the middle cuts a parallelogram or a hexagon out
//! of a cube; its corners need not be found. Projected along the axis that the normal is nearest to, the polygon is the
//! part of a square within a strip, and with normal components a >= b >= c >= 0 of a cube of edge 1 its area is 1 / a
//! where a >= b + c, and (2 (ab + bc + ca) - a^2 - b^2 - c^2) / (4 abc) elsewhere: from 1 to the square root of two (Ball,
//! "Cube slicing in R^n", Proceedings of the AMS 97(3), 1986).

use super::{Shape, box_fixed};
use crate::Region;
use photinus_geometry::Vec3;

pub(super) const ABOUT: &str = "a box, over the polygon that the tangent plane cuts out";

pub(super) struct BoxPolygon;

impl Shape for BoxPolygon {
    const REACH_SQ: f32 = box_fixed::REACH_SQ;

    fn region(center: Vec3, radius: f32) -> Region {
        box_fixed::BoxFixed::region(center, radius)
    }

    #[inline]
    fn measure_sq(offset: Vec3, _: f32, _: Vec3) -> f32 {
        box_fixed::measure_sq(offset)
    }

    fn section(normal: Vec3) -> f32 {
        box_fixed::FACE * section(normal)
    }
}

/// Area that the plane through the middle of a cube of edge 1 across `normal` has within it, 1 to the root of two; 1 for a
/// normal that is none.
fn section(normal: Vec3) -> f32 {
    let mut n = normal.abs().to_array().map(f64::from);
    n.sort_unstable_by(f64::total_cmp);
    let [c, b, a] = n;
    let length = (a * a + b * b + c * c).sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return 1.0;
    }
    let [c, b, a] = [c / length, b / length, a / length];
    let area = if a >= b + c {
        1.0 / a
    } else {
        // c > a - b >= 0: no division by zero.
        (2.0 * (a * b + b * c + c * a) - (a * a + b * b + c * c)) / (4.0 * a * b * c)
    };
    area as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Frame;
    use photinus_num::{Sampler, StreamKind};

    const SEED: u64 = 20_610;

    /// The polygon itself: a large square of the plane, cut by the six faces one after the other.
    fn clipped(normal: Vec3) -> (f64, usize) {
        let frame = Frame::from_normal(normal);
        let corner = |s: f32, t: f32| ((frame.s * s + frame.t * t) * 4.0).to_array().map(f64::from);
        let mut polygon = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        for face in 0..6 {
            let (axis, sign) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
            let depth = |p: &[f64; 3]| 0.5 - sign * p[axis];
            let mut kept = Vec::new();
            for (i, p) in polygon.iter().enumerate() {
                let q = &polygon[(i + 1) % polygon.len()];
                let (at, next) = (depth(p), depth(q));
                if at >= 0.0 {
                    kept.push(*p);
                }
                if (at >= 0.0) != (next >= 0.0) {
                    let t = at / (at - next);
                    kept.push(std::array::from_fn(|k| p[k] + (q[k] - p[k]) * t));
                }
            }
            polygon = kept;
        }
        // The sum of cross products of the corners is twice the area.
        let mut twice = [0.0; 3];
        for (i, p) in polygon.iter().enumerate() {
            let q = &polygon[(i + 1) % polygon.len()];
            for k in 0..3 {
                let (u, v) = ((k + 1) % 3, (k + 2) % 3);
                twice[k] += p[u] * q[v] - p[v] * q[u];
            }
        }
        ((twice.iter().map(|c| c * c).sum::<f64>()).sqrt() / 2.0, polygon.len())
    }

    #[test]
    fn known_planes_have_their_areas() {
        let close = |normal: Vec3, expected: f32| {
            let area = section(normal);
            assert!((area - expected).abs() < 1e-6, "{normal}: {area} for {expected}");
        };
        for axis in [Vec3::X, Vec3::NEG_Y, Vec3::Z] {
            close(axis, 1.0);
        }
        // Through two opposite edges, and the regular hexagon: 3 sqrt(3) r^2 for half-size r.
        close(Vec3::new(1.0, 0.0, -1.0), std::f32::consts::SQRT_2);
        close(Vec3::new(-1.0, 1.0, 1.0), 0.75 * 3f32.sqrt());
        for none in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
            close(none, 1.0);
        }
    }

    #[test]
    fn the_area_is_that_of_the_clipped_polygon() {
        let mut sides = [0; 7];
        for i in 0..20_000 {
            let mut s = Sampler::new(SEED, StreamKind::Test, 1, i);
            let mut n = Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - 1.0;
            if i % 3 == 0 {
                // Nearly across an axis, or along two.
                n[(i % 9 / 3) as usize] *= 1e-6;
            }
            let Some(normal) = n.try_normalize() else { continue };
            let (expected, corners) = clipped(normal);
            sides[corners.min(6)] += 1;
            let area = f64::from(section(normal));
            assert!((area - expected).abs() < 2e-6, "seed {SEED}: {normal}: {area} for {expected}");
            assert!((1.0 - 1e-6..=2f64.sqrt() + 1e-6).contains(&area), "seed {SEED}: {normal}: {area}");
        }
        assert!(sides[4] > 1000 && sides[6] > 1000, "{sides:?}");
    }
}
