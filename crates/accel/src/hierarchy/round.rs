//! A ray prepared for tests against round volumes that lose no hit, and the choice of points that carry a fit.
//!
//! The ray-triangle test hits triangles displaced by up to 12 roundings (12 x 2^-24) of their distance to the ray's
//! start, per axis, and by some roundings of the triangle's size (see [`crate::bounds`]). The second part is in the
//! padding of the points that a volume is fitted around. The first is relative to the distance, of which no point of a
//! volume has more than its [reach](RoundRay::error): the volume grows by 16 roundings of that. Tests run in doubles,
//! whose own rounding is small against the four roundings to spare.

use super::volume::PaddedPoint;
use crate::bounds::SLAB_SLACK;
use crate::laboratory::can_hit;
use photinus_geometry::Ray;

/// A ray in doubles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundRay {
    /// Start.
    pub origin: [f64; 3],
    /// Direction, of any length.
    pub dir: [f64; 3],
    t_min: f64,
}

impl RoundRay {
    /// Prepares a ray; `None` where it can hit nothing.
    pub fn new(ray: &Ray) -> Option<Self> {
        can_hit(ray).then(|| Self {
            origin: ray.origin.to_array().map(f64::from),
            dir: ray.dir.to_array().map(f64::from),
            t_min: f64::from(ray.t_min),
        })
    }

    /// How far the ray's start is from a middle, by axis, and how much a volume of these extents around it has to
    /// grow along each axis.
    #[inline(always)]
    pub fn error(&self, center: [f64; 3], extent: impl Fn(usize) -> f64) -> ([f64; 3], f64) {
        let mut reach = 0.0;
        let offset = std::array::from_fn(|k| {
            let offset = self.origin[k] - center[k];
            reach = f64::max(reach, offset.abs() + extent(k));
            offset
        });
        (offset, reach * f64::from(SLAB_SLACK))
    }

    /// Where a ball is entered whose middle is nearest to the ray at parameter `foot`, `left` the square of half the
    /// way through it, in units of which the direction has `dir_sq`, squared.
    #[inline(always)]
    pub fn enter(&self, foot: f64, left: f64, dir_sq: f64, end: f32) -> Option<f32> {
        // Comparisons let through what is not a number.
        if left < 0.0 {
            return None;
        }
        let half = (left / dir_sq).sqrt();
        let slack = f64::from(SLAB_SLACK);
        let (enter, leave) = (foot - half, foot + half);
        let (enter, leave) = (enter - slack * enter.abs(), leave + slack * leave.abs());
        if enter > f64::from(end) || leave < self.t_min {
            return None;
        }
        // The maximum of a number and what is none is the number.
        Some(self.t_min.max(enter) as f32)
    }
}

/// Directions in whose extremes a volume rests: axes, edges and corners of a cube.
const DIRECTIONS: [[f64; 3]; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// The points' box: its middle and half its edges, none below `floor` of their largest, of the padding and of zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    /// Middle of the box.
    pub middle: [f64; 3],
    /// Half the edges; positive.
    pub size: [f64; 3],
    /// What no edge is below.
    pub floor: f64,
}

impl Frame {
    /// The frame of some points.
    pub fn of(points: &[PaddedPoint], flattest: f64) -> Self {
        let (mut low, mut high, mut pad) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], 0.0_f64);
        for p in points {
            pad = pad.max(p.pad);
            for k in 0..3 {
                low[k] = low[k].min(p.at[k]);
                high[k] = high[k].max(p.at[k]);
            }
        }
        let half: [f64; 3] = std::array::from_fn(|k| 0.5 * (high[k] - low[k]));
        let floor = (half[0].max(half[1]).max(half[2]) * flattest).max(16.0 * pad).max(f64::from(f32::MIN_POSITIVE));
        Self {
            middle: std::array::from_fn(|k| f64::midpoint(low[k], high[k])),
            size: half.map(|h| h.max(floor)),
            floor,
        }
    }

    /// The points in the frame's coordinates; of many, those that are extreme in one of 26 directions.
    pub fn carriers(&self, points: &[PaddedPoint]) -> Vec<[f64; 3]> {
        let local = |p: &PaddedPoint| std::array::from_fn(|k| (p.at[k] - self.middle[k]) / self.size[k]);
        if points.len() <= 2 * DIRECTIONS.len() {
            return points.iter().map(local).collect();
        }
        let mut extremes = [(f64::INFINITY, [0.0; 3], f64::NEG_INFINITY, [0.0; 3]); DIRECTIONS.len()];
        for p in points {
            let p: [f64; 3] = local(p);
            for (d, (low, lowest, high, highest)) in DIRECTIONS.iter().zip(&mut extremes) {
                let along = p[0] * d[0] + p[1] * d[1] + p[2] * d[2];
                if along < *low {
                    (*low, *lowest) = (along, p);
                }
                if along > *high {
                    (*high, *highest) = (along, p);
                }
            }
        }
        extremes.iter().flat_map(|e| [e.1, e.3]).collect()
    }
}
