//! Leaves, blades of grass and petals: single sheets for two-sided materials.

use super::{Join, Part, patch, place::sin_cos_degrees};
use photinus_geometry::Vec3;

/// The shape of a leaf that grows along +z from the origin with its face up (+y).
#[derive(Clone, Copy, Debug)]
pub struct LeafShape {
    /// From stalk to tip.
    pub length: f32,
    /// At its widest.
    pub width: f32,
    /// Where it is widest, as a share of the length, 0.2 to 0.8.
    pub widest: f32,
    /// How far the tip bends down, degrees.
    pub droop: f32,
    /// How far the halves rise from the midrib, degrees.
    pub fold: f32,
}

impl LeafShape {
    /// A point of the midrib at share `s` of the length: an arc that starts flat and ends turned by the droop.
    fn midrib(&self, s: f32) -> (Vec3, Vec3) {
        let (sin, cos) = sin_cos_degrees(self.droop * s);
        let up = Vec3::new(0.0, cos, sin);
        let bend = self.droop.to_radians();
        if bend.abs() < 1e-3 {
            return (Vec3::Z * (self.length * s), up);
        }
        let radius = self.length / bend;
        (Vec3::new(0.0, radius * (cos - 1.0), radius * sin), up)
    }

    /// Half the width at share `s`: rises like a sine to the widest place and falls like one to the tip.
    fn half_width(&self, s: f32) -> f32 {
        let phase = if s < self.widest { s / self.widest } else { 1.0 + (s - self.widest) / (1.0 - self.widest) };
        let (sin, _) = sin_cos_degrees(90.0 * phase);
        0.5 * self.width * sin.max(0.0)
    }

    fn margin(&self, s: f32, side: f32) -> Vec3 {
        let (middle, up) = self.midrib(s);
        let (sin, cos) = sin_cos_degrees(self.fold);
        middle + (Vec3::X * (side * cos) + up * sin) * self.half_width(s)
    }
}

/// A leaf of exactly `triangles` triangles (at least 4), folded along its midrib.
///
/// With r pieces of the midrib a leaf has 4 r - 4 triangles; up to three more are cut into its margin.
pub fn leaf(shape: LeafShape, triangles: usize) -> Part {
    let pieces = (triangles / 4).max(1) + 1;
    let extra = triangles.saturating_sub(4 * (pieces - 1));
    let mut part = Part::default();
    let share = |i: usize| i as f32 / pieces as f32;
    let rib: Vec<u32> = (0..=pieces)
        .map(|i| {
            let (p, up) = shape.midrib(share(i));
            part.vertex(p, up, [0.5, share(i)])
        })
        .collect();
    for (side, u, cuts) in [(1.0f32, 1.0, extra.div_ceil(2)), (-1.0, 0.0, extra / 2)] {
        let face = |part: &mut Part, a, b, c| {
            if side > 0.0 { part.triangle(a, b, c) } else { part.triangle(a, c, b) }
        };
        let edge = |part: &mut Part, s: f32| part.vertex(shape.margin(s, side), Vec3::Y, [u, s]);
        // Cuts go into the first pieces of the margin, one each; the margin has points at the ends of inner pieces.
        let mut before = edge(&mut part, share(1));
        face(&mut part, rib[0], rib[1], before);
        let mut cuts_left = cuts;
        for i in 1..pieces {
            if i + 1 == pieces {
                while cuts_left > 0 {
                    let last = edge(&mut part, share(i) + (0.5 + 0.25 * (cuts - cuts_left) as f32) / pieces as f32);
                    face(&mut part, rib[i], last, before);
                    before = last;
                    cuts_left -= 1;
                }
                face(&mut part, rib[i], rib[i + 1], before);
                break;
            }
            let next = edge(&mut part, share(i + 1));
            if cuts_left > 0 {
                let between = edge(&mut part, share(i) + 0.5 / pieces as f32);
                face(&mut part, rib[i], between, before);
                before = between;
                cuts_left -= 1;
            }
            face(&mut part, rib[i], next, before);
            face(&mut part, rib[i], rib[i + 1], next);
            before = next;
        }
    }
    part.smoothed()
}

/// A narrow blade of exactly `triangles` triangles (at least 1): a strip that tapers to its tip.
///
/// Its shading normals are those of the arc: a strip of few triangles zigzags about it, and the mean of its faces' normals
/// can lie behind one of them. They lie before the faces where the droop is less than 90 degrees a triangle.
pub fn blade(shape: LeafShape, triangles: usize) -> Part {
    let mut part = Part::default();
    let last = triangles + 1;
    for i in 0..=last {
        let s = i as f32 / last as f32;
        let (middle, up) = shape.midrib(s);
        let side = if i % 2 == 0 { -0.5 } else { 0.5 };
        let width = shape.width * if i == last { 0.0 } else { 1.0 - 0.75 * s * s };
        part.vertex(middle + Vec3::X * (side * width), up, [side + 0.5, s]);
    }
    for i in 0..triangles as u32 {
        if i % 2 == 0 { part.triangle(i, i + 2, i + 1) } else { part.triangle(i, i + 1, i + 2) }
    }
    part
}

/// A petal that grows along +z from the origin and curls up (+y) towards its pointed tip; 2 `nu` `nv` - `nu`
/// triangles, u across and v along it.
///
/// `rise`: by how much the tip stands above the base, as a share of the length; `cup`: how far its sides stand up,
/// as a share of the width.
pub fn petal(length: f32, width: f32, rise: f32, cup: f32, nu: usize, nv: usize) -> Part {
    patch(nu, nv, Join::Open, |u, v| {
        let side = 1.0 - 2.0 * u;
        let (sin, _) = sin_cos_degrees(180.0 * libm::powf(v, 0.8) * 0.86);
        let half = 0.5 * width * sin;
        let point = 0.16 * length * side * side * v * v;
        Vec3::new(side * half, length * rise * v * v + width * cup * side * side * sin, length * v - point)
    })
}

/// A floating lily pad: a disc of this radius with a notch towards +z and a rim that curls up; `nu` cells around and
/// `nv` from the middle, 2 `nu` `nv` - `nu` triangles.
pub fn lily_pad(radius: f32, nu: usize, nv: usize) -> Part {
    patch(nu, nv, Join::Open, |u, v| {
        let (sin, cos) = sin_cos_degrees(104.0 + 332.0 * u);
        let (wave, _) = sin_cos_degrees(360.0 * 5.0 * u);
        let v4 = v * v * v * v;
        let r = radius * v * (1.0 - 0.02 * v4);
        Vec3::new(r * cos, radius * (0.07 * v4 * v4 + 0.018 * wave * v4), r * sin)
    })
}
