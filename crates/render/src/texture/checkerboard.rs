//! The checkerboard, averaged over the pixel's footprint in closed form.

use photinus_geometry::Vec2;

/// Integral from 0 to x of the square wave that is 1 where frac(x) < 1/2 and -1 elsewhere.
fn integral(x: f32) -> f32 {
    let f = x - x.floor();
    0.5 - (f - 0.5).abs()
}

/// The square wave's mean over an interval of `width` around x.
fn mean(x: f32, width: f32) -> f32 {
    // Below, single precision has no digits left for the difference; above, nothing is left of the wave.
    if width < 1e-4 * x.abs().max(1.0) {
        return if x - x.floor() <= 0.5 { 1.0 } else { -1.0 };
    }
    if width > 1e4 {
        return 0.0;
    }
    (integral(x + 0.5 * width) - integral(x - 0.5 * width)) / width
}

/// Share of the first colour, 0 to 1, in a box of side `footprint` around `uv`: the wave is the product of one in u and
/// one in v, and so is its mean. Coordinates that are not finite count as 0.
pub fn checkerboard_share(uv: Vec2, footprint: f32) -> f32 {
    let sane = |x: f32| if x.is_finite() { x } else { 0.0 };
    let width = footprint.max(0.0);
    0.5 + 0.5 * (mean(sane(uv.x), width) * mean(sane(uv.y), width))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_of_half_a_unit() {
        for (u, v, share) in [(0.1, 0.1, 1.0), (0.6, 0.1, 0.0), (0.1, 0.6, 0.0), (0.6, 0.6, 1.0), (-0.1, 0.1, 0.0)] {
            assert_eq!(checkerboard_share(Vec2::new(u, v), 0.0), share, "{u} {v}");
        }
    }

    #[test]
    fn the_closed_form_agrees_with_counting() {
        for (u, v, width) in [(0.3f32, 0.7f32, 0.2f32), (0.5, 0.5, 0.7), (0.25, 0.1, 1.3), (-3.4, 8.2, 0.05)] {
            const N: u32 = 400;
            let mut count = 0;
            for i in 0..N {
                for j in 0..N {
                    let at = |c: f32, k: u32| c + width * ((k as f32 + 0.5) / N as f32 - 0.5);
                    let p = Vec2::new(at(u, i), at(v, j));
                    count += u32::from(checkerboard_share(p, 0.0) > 0.5);
                }
            }
            let counted = count as f32 / (N * N) as f32;
            let share = checkerboard_share(Vec2::new(u, v), width);
            assert!((share - counted).abs() < 0.01, "{u} {v} {width}: {share} against {counted}");
        }
    }

    #[test]
    fn odd_coordinates_are_safe() {
        for x in [f32::NAN, f32::INFINITY, 1e30, -1e30] {
            for width in [0.0, 1.0, f32::NAN, f32::INFINITY, 1e30] {
                let share = checkerboard_share(Vec2::new(x, 0.2), width);
                assert!((0.0..=1.0).contains(&share), "{x} {width}: {share}");
            }
        }
    }
}
