//! Equirectangular environment pictures: directions to texture coordinates and back, and bilinear radiance.

use photinus_geometry::{Vec2, Vec3};
use photinus_scene::{Bitmap, BitmapPixels};
use std::f32::consts::PI;

use super::srgb8_to_linear;

/// Texture coordinates of a unit direction in the light's local frame: u = atan2(x, -z) / 2 pi in 0..1, v = acos(y) / pi
/// with v = 0 at the +y pole (row 0).
#[inline]
pub fn direction_to_equirect(d: Vec3) -> Vec2 {
    let u = libm::atan2f(d.x, -d.z) * (0.5 / PI);
    Vec2::new(if u < 0.0 { u + 1.0 } else { u }, libm::acosf(d.y.clamp(-1.0, 1.0)) * (1.0 / PI))
}

/// The unit direction of texture coordinates; the inverse of [`direction_to_equirect`].
#[inline]
pub fn equirect_to_direction(uv: Vec2) -> Vec3 {
    let (phi, theta) = (uv.x * 2.0 * PI, uv.y * PI);
    let sin_theta = libm::sinf(theta);
    Vec3::new(libm::sinf(phi) * sin_theta, libm::cosf(theta), -libm::cosf(phi) * sin_theta)
}

/// Radiance of the picture in a local unit direction, bilinear between pixel centres, wrapped around in u and held at
/// the poles; black where the picture has no pixels.
pub fn environment_radiance(bitmap: &Bitmap, d: Vec3) -> Vec3 {
    let pixels = match &bitmap.pixels {
        BitmapPixels::Rgba8 { data, .. } => data.len(),
        BitmapPixels::RgbaF32(data) => data.len(),
    };
    let (w, h) = (bitmap.width as i64, bitmap.height as i64);
    if w < 1 || h < 1 || pixels as i64 != w * h || !d.is_finite() {
        return Vec3::ZERO;
    }
    let uv = direction_to_equirect(d);
    let (x, y) = (uv.x * w as f32 - 0.5, uv.y * h as f32 - 0.5);
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (x - x0, y - y0);
    let at = |i: i64, j: i64| {
        let k = (j.clamp(0, h - 1) * w + i.rem_euclid(w)) as usize;
        match &bitmap.pixels {
            BitmapPixels::RgbaF32(data) => Vec3::new(data[k][0], data[k][1], data[k][2]),
            BitmapPixels::Rgba8 { data, srgb } => {
                let [r, g, b, _] = data[k];
                if *srgb {
                    Vec3::new(srgb8_to_linear(r), srgb8_to_linear(g), srgb8_to_linear(b))
                } else {
                    Vec3::new(f32::from(r), f32::from(g), f32::from(b)) / 255.0
                }
            }
        }
    };
    let (i, j) = (x0 as i64, y0 as i64);
    let top = at(i, j) * (1.0 - fx) + at(i + 1, j) * fx;
    let bottom = at(i, j + 1) * (1.0 - fx) + at(i + 1, j + 1) * fx;
    top * (1.0 - fy) + bottom * fy
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_and_coordinates_are_inverse() {
        for (d, u, v) in [
            (Vec3::Y, 0.5, 0.0),
            (-Vec3::Y, 0.5, 1.0),
            (Vec3::X, 0.25, 0.5),
            (-Vec3::Z, 0.0, 0.5),
            (-Vec3::X, 0.75, 0.5),
        ] {
            let uv = direction_to_equirect(d);
            assert!((uv.y - v).abs() < 1e-6, "{d}: {uv}");
            if d.y == 0.0 {
                assert!((uv.x - u).abs() < 1e-6, "{d}: {uv}");
            }
            assert!((equirect_to_direction(uv) - d).length() < 1e-5, "{d}");
        }
        for i in 0..50 {
            let d = Vec3::new((i * 37 % 50) as f32 - 25.0, (i * 13 % 50) as f32 - 24.5, i as f32 - 24.7).normalize();
            assert!((equirect_to_direction(direction_to_equirect(d)) - d).length() < 1e-5, "{d}");
        }
    }

    #[test]
    fn pixel_centres_are_exact_and_the_seam_wraps() {
        let data = (0..8).map(|i| [i as f32, 0.0, 0.0, 1.0]).collect();
        let bitmap = Bitmap { width: 4, height: 2, pixels: BitmapPixels::RgbaF32(data) };
        let at = |u, v| environment_radiance(&bitmap, equirect_to_direction(Vec2::new(u, v))).x;
        assert!((at(0.125, 0.25) - 0.0).abs() < 1e-4);
        assert!((at(0.625, 0.75) - 6.0).abs() < 1e-4);
        assert!((at(0.9999, 0.25) - 1.5).abs() < 0.01, "half of column 3, half of column 0: {}", at(0.9999, 0.25));
        assert_eq!(environment_radiance(&bitmap, Vec3::NAN), Vec3::ZERO);
    }
}
