//! Smooth curves through points.

use photinus_geometry::{Vec2, Vec3};
use std::ops::{Add, Mul, Sub};

/// A Catmull-Rom spline through `points`, each span cut into `per_span` pieces; the ends are kept exactly.
fn spline<V>(points: &[V], per_span: usize) -> Vec<V>
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<f32, Output = V>,
{
    let n = points.len();
    let mut out = Vec::with_capacity((n - 1) * per_span + 1);
    for i in 0..n - 1 {
        let (b, c) = (points[i], points[i + 1]);
        // The missing neighbours of the ends are mirrored.
        let a = if i > 0 { points[i - 1] } else { b + b - c };
        let d = if i + 2 < n { points[i + 2] } else { c + c - b };
        for k in 0..per_span {
            let t = k as f32 / per_span as f32;
            let (m0, m1) = ((c - a) * 0.5, (d - b) * 0.5);
            let t2 = t * t;
            let t3 = t2 * t;
            out.push(
                b * (2.0 * t3 - 3.0 * t2 + 1.0) + m0 * (t3 - 2.0 * t2 + t) + c * (3.0 * t2 - 2.0 * t3) + m1 * (t3 - t2),
            );
        }
    }
    out.push(points[n - 1]);
    out
}

/// A smooth curve in space through points.
pub fn curve(points: &[[f32; 3]], per_span: usize) -> Vec<Vec3> {
    spline(&points.iter().map(|&p| Vec3::from(p)).collect::<Vec<_>>(), per_span)
}

/// A smooth outline through (radius, height) points; radii below zero, which a tight bend may overshoot to, are cut.
pub fn profile(points: &[[f32; 2]], per_span: usize) -> Vec<[f32; 2]> {
    spline(&points.iter().map(|&p| Vec2::from(p)).collect::<Vec<_>>(), per_span)
        .iter()
        .map(|p| [p.x.max(0.0), p.y])
        .collect()
}
