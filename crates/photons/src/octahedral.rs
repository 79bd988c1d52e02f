//! Unit vectors in two small integers: the octahedral map (Cigolle et al., "A Survey of Efficient Representations for
//! Independent Unit Vectors", JCGT 3(2), 2014, section 3.1).
//!
//! Both integers lie in `-max..=max`, so that the coordinate axes are exact.

use photinus_geometry::Vec3;

/// The integers of the direction of `v`, which need not be unit but must be finite and not zero.
#[inline]
pub(crate) fn encode(v: Vec3, max: i32) -> [i32; 2] {
    // Scaling by the largest component first keeps the sum of the three finite.
    let v = v / v.abs().max_element();
    let inv = 1.0 / (v.x.abs() + v.y.abs() + v.z.abs());
    let (mut x, mut y) = (v.x * inv, v.y * inv);
    if v.z < 0.0 {
        (x, y) = ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y));
    }
    let m = max as f32;
    [(x * m).round() as i32, (y * m).round() as i32]
}

/// A vector of the encoded direction, not unit: exact in f32 as long as `max` is below 2^22.
#[inline]
pub(crate) fn decode_scaled(xy: [i32; 2], max: i32) -> Vec3 {
    let [x, y] = xy.map(|i| i as f32);
    let z = (max as f32 - x.abs()) - y.abs();
    let fold = (-z).max(0.0);
    Vec3::new(x - fold.copysign(x), y - fold.copysign(y), z)
}

/// The unit vector encoded.
#[inline]
pub(crate) fn decode(xy: [i32; 2], max: i32) -> Vec3 {
    let v = decode_scaled(xy, max);
    v / v.length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_num::{Sampler, StreamKind};

    /// Largest angle in radians between a direction and its decoded self, over `count` random directions.
    fn worst_angle(max: i32, count: u32) -> f64 {
        let mut worst = 0f64;
        for i in 0..count {
            let mut s = Sampler::new(11, StreamKind::Test, 0, i);
            let [a, b] = s.next_2d();
            let z = 1.0 - 2.0 * a;
            let (sin, cos) = libm::sincosf(b * std::f32::consts::TAU);
            let r = (1.0 - z * z).max(0.0).sqrt();
            let v = Vec3::new(r * cos, r * sin, z);
            let d = decode(encode(v, max), max);
            assert!(v.dot(d) > 0.99, "{v} {d}");
            let [v, d] = [v, d].map(|v| v.to_array().map(f64::from));
            let cross: [f64; 3] =
                std::array::from_fn(|i| v[(i + 1) % 3] * d[(i + 2) % 3] - v[(i + 2) % 3] * d[(i + 1) % 3]);
            worst = worst.max(libm::asin(cross.iter().map(|c| c * c).sum::<f64>().sqrt()));
        }
        worst
    }

    #[test]
    fn angular_error_stays_below_the_documented_bound() {
        for (max, bound) in [(32767, 7e-5), (2047, 1.1e-3)] {
            let worst = worst_angle(max, 300_000);
            assert!(worst < bound, "seed 11, {max}: {worst} rad");
            assert!(worst > 0.8 * bound, "the bound is near, or the test saw little: {worst} rad");
        }
    }

    #[test]
    fn axes_are_exact_and_extreme_lengths_do_not_matter() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z] {
            for scale in [1.0, 1e-40, 1e-30, 3e38] {
                assert_eq!(decode(encode(axis * scale, 2047), 2047), axis, "{axis} * {scale}");
            }
        }
        let v = decode(encode(Vec3::splat(-3e38), 32767), 32767);
        assert!((v - Vec3::splat(-1.0 / 3f32.sqrt())).length() < 1e-4, "{v}");
    }

    #[test]
    fn every_code_decodes_to_a_finite_vector() {
        for x in -127..=127 {
            for y in -127..=127 {
                assert!(decode([x, y], 127).is_normalized());
            }
        }
    }
}
