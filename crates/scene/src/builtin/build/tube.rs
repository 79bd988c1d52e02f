//! Tubes along curves.

use super::{Part, place::sin_cos_degrees};
use photinus_geometry::{Frame, Vec3};

/// How a tube ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// Open, for ends that lie inside something else.
    Open,
    /// Flat lids.
    Flat,
    /// The last ring is joined to the first.
    Ring,
}

/// A round tube of `segments` sides around `path`, its radius a function of the share of points passed, 0 to 1.
/// A radius of 0 at an end makes a tip.
///
/// Rings keep their twist least (Wang et al., "Computation of Rotation Minimizing Frames", ACM TOG 27(1), 2008).
/// Triangles: 2 `segments` a piece (half of that at a tip), `segments` a lid.
pub fn tube(path: &[Vec3], segments: usize, ends: Ends, radius: impl Fn(f32) -> f32) -> Part {
    let n = path.len();
    let ring = ends == Ends::Ring;
    let direction = |i: usize| {
        let (a, b) = if ring { ((i + n - 1) % n, (i + 1) % n) } else { (i.saturating_sub(1), (i + 1).min(n - 1)) };
        let d = path[b] - path[a];
        d / d.length()
    };
    let mut frame = Frame::from_normal(direction(0));
    let radii: Vec<f32> = (0..n).map(|i| radius(i as f32 / (n - 1) as f32)).collect();
    let mut part = Part::default();
    let mut rings: Vec<u32> = Vec::with_capacity(n + 1);
    let mut length = 0.0;
    let count = if ring { n + 1 } else { n };
    let mut first_side = frame.s;
    for k in 0..count {
        let i = k % n;
        if k > 0 {
            length += (path[i] - path[(k - 1) % n]).length();
            frame = carried(frame, path[i] - path[(k - 1) % n], direction(i));
        }
        if k == 0 {
            first_side = frame.s;
        }
        if ring && k == n {
            // The way around turns the frame; the seam joins the rings as they are, so the first is repeated.
            frame = Frame::from_normal_and_tangent(direction(0), first_side);
        }
        let slope = {
            let (a, b) = (k.saturating_sub(1).min(n - 1), (k + 1).min(n - 1));
            let run = (path[b] - path[a]).length();
            if ring || run == 0.0 { 0.0 } else { (radii[b] - radii[a]) / run }
        };
        let tip = radii[i] == 0.0;
        for j in 0..=segments {
            let (sin, cos) = sin_cos_degrees((j % segments) as f32 * (360.0 / segments as f32));
            let side = frame.s * cos + frame.t * sin;
            let normal = side - frame.n * slope;
            let u = (j as f32 + if tip { 0.5 } else { 0.0 }) / segments as f32;
            let vertex = part.vertex(path[i] + side * radii[i], normal / normal.length(), [u, length]);
            if j == 0 {
                rings.push(vertex);
            }
        }
    }
    for k in 0..count - 1 {
        for j in 0..segments as u32 {
            let [a, d] = [rings[k] + j, rings[k + 1] + j];
            if radii[k % n] == 0.0 {
                part.triangle(a, d + 1, d);
            } else if radii[(k + 1) % n] == 0.0 {
                part.triangle(a, a + 1, d);
            } else {
                part.triangle(a, a + 1, d + 1);
                part.triangle(a, d + 1, d);
            }
        }
    }
    if ends == Ends::Flat {
        lid(&mut part, rings[0], segments, path[0], -direction(0), radii[0]);
        lid(&mut part, rings[n - 1], segments, path[n - 1], direction(n - 1), radii[n - 1]);
    }
    part
}

/// The frame moved along `step` to the direction `n`, by two reflections.
fn carried(frame: Frame, step: Vec3, n: Vec3) -> Frame {
    let c1 = step.dot(step);
    let reflect = |v: Vec3| v - step * (2.0 / c1 * step.dot(v));
    let (s, t) = (reflect(frame.s), reflect(frame.n));
    let v2 = n - t;
    let c2 = v2.dot(v2);
    let s = if c2 > 1e-12 { s - v2 * (2.0 / c2 * v2.dot(s)) } else { s };
    Frame::from_normal_and_tangent(n, s)
}

/// A flat lid over the ring that starts at vertex `ring`; nothing where the ring is a tip.
fn lid(part: &mut Part, ring: u32, segments: usize, middle: Vec3, normal: Vec3, radius: f32) {
    if radius == 0.0 {
        return;
    }
    let center = part.vertex(middle, normal, [0.5, 0.5]);
    let rim: Vec<u32> = (0..segments as u32)
        .map(|j| {
            let (sin, cos) = sin_cos_degrees(j as f32 * (360.0 / segments as f32));
            part.vertex(part.position(ring + j), normal, [0.5 + 0.5 * cos, 0.5 + 0.5 * sin])
        })
        .collect();
    for j in 0..segments {
        let (a, b) = (rim[j], rim[(j + 1) % segments]);
        let outward = (part.position(a) - middle).cross(part.position(b) - middle).dot(normal) > 0.0;
        if outward { part.triangle(center, a, b) } else { part.triangle(center, b, a) }
    }
}
