//! Surfaces of revolution about the y axis.

use super::{Part, place::sin_cos_degrees};
use photinus_geometry::Vec3;

/// Neighbouring faces whose normals differ by more than the angle of this cosine (50 degrees) meet in a crease.
const CREASE_COSINE: f32 = 0.642_787_6;

/// Turns a (radius, height) outline about the y axis in `segments` steps. Going up the outline, the outside is away
/// from the axis. u runs around, v along the outline by length.
///
/// A piece of the outline makes 2 `segments` triangles, or `segments` where one of its ends is on the axis.
pub fn revolve(outline: &[[f32; 2]], segments: usize) -> Part {
    let normals: Vec<[f32; 2]> = outline
        .windows(2)
        .map(|w| {
            let (dr, dy) = (w[1][0] - w[0][0], w[1][1] - w[0][1]);
            let length = (dr * dr + dy * dy).sqrt();
            [dy / length, -dr / length]
        })
        .collect();
    let mut along = vec![0.0f32];
    for w in outline.windows(2) {
        let (dr, dy) = (w[1][0] - w[0][0], w[1][1] - w[0][1]);
        along.push(along[along.len() - 1] + (dr * dr + dy * dy).sqrt());
    }
    let total = along[along.len() - 1];
    // The outline's normal at one end of a piece: shared with the neighbour unless a crease is between.
    let end_normal = |piece: usize, neighbour: Option<usize>| {
        let n = normals[piece];
        let Some(m) = neighbour.and_then(|k| normals.get(k)) else { return n };
        if n[0] * m[0] + n[1] * m[1] < CREASE_COSINE {
            return n;
        }
        let s = [n[0] + m[0], n[1] + m[1]];
        let length = (s[0] * s[0] + s[1] * s[1]).sqrt();
        [s[0] / length, s[1] / length]
    };
    let closed = outline[0] == outline[outline.len() - 1];
    let last = normals.len() - 1;

    let mut part = Part::default();
    for (k, w) in outline.windows(2).enumerate() {
        let below = if k > 0 { Some(k - 1) } else { closed.then_some(last) };
        let above = if k < last { Some(k + 1) } else { closed.then_some(0) };
        let rims = [(w[0], end_normal(k, below), along[k]), (w[1], end_normal(k, above), along[k + 1])];
        let mut rows = [[0u32; 2]; 2];
        for (row, ([r, y], [nr, ny], s)) in rows.iter_mut().zip(rims) {
            // On the axis the mean of all normals points along it.
            let (nr, ny) = if r == 0.0 { (0.0, ny.signum()) } else { (nr, ny) };
            for i in 0..=segments {
                let (sin, cos) = sin_cos_degrees((i % segments) as f32 * (360.0 / segments as f32));
                let half = if r == 0.0 { 0.5 } else { 0.0 };
                let u = (i as f32 + half) / segments as f32;
                let v =
                    part.vertex(Vec3::new(r * cos, y, -r * sin), Vec3::new(nr * cos, ny, -nr * sin), [u, s / total]);
                if i == 0 {
                    row[0] = v;
                }
                row[1] = v;
            }
        }
        for i in 0..segments as u32 {
            let [a, d] = [rows[0][0] + i, rows[1][0] + i];
            if w[0][0] == 0.0 {
                part.triangle(a, d + 1, d);
            } else if w[1][0] == 0.0 {
                part.triangle(a, a + 1, d);
            } else {
                part.triangle(a, a + 1, d + 1);
                part.triangle(a, d + 1, d);
            }
        }
    }
    part
}

/// The outline of a vessel: `outer` from the rim of its foot to its lip, closed below, with walls of this thickness.
///
/// The inside follows the outside down to the height `floor`; both ends are on the axis, so that the body is closed.
pub fn hollow(outer: &[[f32; 2]], thickness: f32, floor: f32) -> Vec<[f32; 2]> {
    let (foot, lip) = (outer[0], outer[outer.len() - 1]);
    let mut out = vec![[0.0, foot[1]]];
    out.extend_from_slice(outer);
    out.push([lip[0] - 0.5 * thickness, lip[1] + 0.4 * thickness]);
    // A little above the floor, so that the last piece of the wall is no sliver.
    let inner = outer.iter().rev().filter(|p| p[1] > floor + 0.5 * thickness && p[0] > 1.5 * thickness);
    out.extend(inner.map(|p| [p[0] - thickness, p[1]]));
    let bottom = out[out.len() - 1];
    out.push([0.6 * bottom[0], floor]);
    out.push([0.0, floor]);
    out
}

/// The outline of a ball of this radius with its middle at this height, in `rows` pieces.
pub fn ball(radius: f32, middle: f32, rows: usize) -> Vec<[f32; 2]> {
    (0..=rows)
        .map(|j| {
            let (sin, cos) = sin_cos_degrees(180.0 * j as f32 / rows as f32);
            [radius * sin, middle - radius * cos]
        })
        .collect()
}
