//! Which ways the photons of a block face: blocks of which none can pass a query's test of normals are not read.
//!
//! Both sides of a wall lie within one radius where walls are thin, and so do the walls of a corner. Directions are told apart
//! in thirty bins, five on each face of a cube: a square around the axis, and what is left of the face in quarters.

use super::blocks::{Block, LANES};
use crate::octahedral::decode_scaled;
use crate::photon::{NORMAL_MASK, NORMAL_MAX, normal_code};
use photinus_geometry::Vec3;
use std::sync::OnceLock;

/// Half the edge of the square around an axis, on a cube of half-edge 1.
const SQUARE: f32 = 0.25;
/// Bins on a face.
const FACE: usize = 5;
/// Bins.
const BINS: usize = 6 * FACE;
/// Bins of queries whose normal is none, or is not asked for.
pub(crate) const ALL: u32 = u32::MAX;
/// The cosine of 60 degrees, below which photons are left out, and the sine.
const LIMIT: [f32; 2] = [0.5, 0.866_025_4];
/// What a normal's length and rounding may add to a cosine, with a margin.
const SLACK: f32 = 1e-2;

/// A bit for each bin that photons of a block lie in.
pub(crate) fn of_block(block: &Block) -> u32 {
    let (mut bins, mut last, mut bit) = (0, None, 0);
    for lane in (0..LANES).take_while(|lane| !block.x[*lane].is_nan()) {
        // Photons of a plane share their normal.
        let word = block.surface[lane] & NORMAL_MASK;
        if last != Some(word) {
            (last, bit) = (Some(word), 1 << bin(decode_scaled(normal_code(word), NORMAL_MAX)));
        }
        bins |= bit;
    }
    bins
}

/// The bin of a direction of any length.
#[inline]
fn bin(v: Vec3) -> usize {
    let size = v.abs();
    let axis = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
    let [a, b] = [v[(axis + 1) % 3], v[(axis + 2) % 3]];
    let part = if a.abs().max(b.abs()) <= SQUARE * size[axis] {
        0
    } else if a.abs() >= b.abs() {
        1 + usize::from(a < 0.0)
    } else {
        3 + usize::from(b < 0.0)
    };
    (2 * axis + usize::from(v[axis] < 0.0)) * FACE + part
}

/// A bit for each bin that photons found by a query of this normal may lie in. The vector kernels repeat these operations.
pub(crate) fn of_query(normal: Vec3) -> u32 {
    if !is_unit(normal) {
        return ALL;
    }
    let cones = cones();
    (0..BINS).fold(0, |bins, i| {
        let cos = normal.x * cones.middles[0][i] + normal.y * cones.middles[1][i] + normal.z * cones.middles[2][i];
        bins | u32::from(cos >= cones.limits[i]) << i
    })
}

/// Whether bins can be told apart: normals of other lengths mean other angles.
#[inline]
pub(crate) fn is_unit(normal: Vec3) -> bool {
    (normal.length_squared() - 1.0).abs() <= SLACK
}

/// Cones that hold the bins, and two that hold nothing.
pub(crate) struct Cones {
    /// Their axes by component.
    pub(crate) middles: [[f32; 32]; 3],
    /// Cosines of 60 degrees and half their angles.
    pub(crate) limits: [f32; 32],
}

/// The cones of all bins.
#[inline]
pub(crate) fn cones() -> &'static Cones {
    static CONES: OnceLock<Cones> = OnceLock::new();
    CONES.get_or_init(|| {
        let mut cones = Cones { middles: [[0.0; 32]; 3], limits: [f32::INFINITY; 32] };
        for i in 0..BINS {
            let corners = corners(i);
            let middle = corners.iter().map(|corner| corner.normalize()).sum::<Vec3>().normalize();
            // Bins are convex, so that none of their directions is farther from the middle than the farthest corner.
            let cos = corners.iter().fold(1f32, |cos, corner| cos.min(corner.normalize().dot(middle)));
            let sin = (1.0 - cos * cos).sqrt();
            (0..3).for_each(|k| cones.middles[k][i] = middle[k]);
            cones.limits[i] = LIMIT[0] * cos - LIMIT[1] * sin - SLACK;
        }
        cones
    })
}

/// The corners of a bin on the cube.
fn corners(bin: usize) -> [Vec3; 4] {
    let (face, part) = (bin / FACE, bin % FACE);
    let axis = face / 2;
    let on_face = |a: f32, b: f32| {
        let mut corner = Vec3::ZERO;
        corner[axis] = if face % 2 == 0 { 1.0 } else { -1.0 };
        (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (a, b);
        corner
    };
    let sign = if part % 2 == 1 { 1.0 } else { -1.0 };
    let s = SQUARE;
    match part {
        0 => [on_face(s, s), on_face(s, -s), on_face(-s, s), on_face(-s, -s)],
        1 | 2 => [on_face(sign * s, s), on_face(sign * s, -s), on_face(sign, 1.0), on_face(sign, -1.0)],
        _ => [on_face(s, sign * s), on_face(-s, sign * s), on_face(1.0, sign), on_face(-1.0, sign)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inclusion::PreparedQuery;
    use crate::searches::grid::kernels::available;
    use crate::{GatherQuery, Kernel, Photon};
    use photinus_num::{Sampler, StreamKind};

    #[test]
    fn no_photon_that_passes_the_test_of_normals_is_lost_and_walls_that_turn_away_are() {
        let (mut passed, mut told_apart, mut turned) = (0, 0, 0);
        for i in 0..200_000 {
            let mut s = Sampler::new(31, StreamKind::Test, 0, i);
            let mut direction = || {
                let v = Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - 1.0;
                // Axes, and directions along the borders of bins, among them.
                let v = if i % 3 == 0 { (v * 4.0).round() } else { v };
                if v == Vec3::ZERO { Vec3::X } else { v.normalize() }
            };
            let (normal, other) = (direction(), direction());
            let photon = Photon::new(Vec3::ZERO, Vec3::ONE, Vec3::Z, other, 1, false).unwrap();
            let query = GatherQuery { position: Vec3::ZERO, radius: 1.0, normal, max_depth: 9 };
            let passes = PreparedQuery::new(&query, Kernel::Constant).accepts(photon.surface_word());
            let stored = decode_scaled(normal_code(photon.surface_word()), NORMAL_MAX);
            let may = of_query(normal) >> bin(stored) & 1 == 1;
            assert!(may || !passes, "seed 31, {i}: {normal} and {other}");
            passed += u32::from(passes);
            turned += u32::from(!passes);
            told_apart += u32::from(!may);
        }
        assert!(passed > 30_000 && told_apart > turned / 2, "{passed} {told_apart} {turned}");
        for (axis, other) in [(Vec3::X, Vec3::Y), (Vec3::Y, -Vec3::Y), (-Vec3::Z, Vec3::X)] {
            assert_eq!(of_query(axis) >> bin(other) & 1, 0, "{axis} and {other}");
        }
        for i in 0..10_000 {
            let mut s = Sampler::new(32, StreamKind::Test, 0, i);
            let v = Vec3::new(s.next_1d(), s.next_1d(), s.next_1d()) * 2.0 - 1.0;
            let normal = if i % 5 == 0 { v } else { v.normalize() };
            for kernels in available() {
                assert_eq!((kernels.facing)(normal), of_query(normal), "seed 32, {i}, {}", kernels.name);
            }
        }
        assert_eq!([Vec3::ZERO, Vec3::NAN, Vec3::splat(9.0)].map(of_query), [ALL; 3]);
    }
}
