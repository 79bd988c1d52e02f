//! The geometry of the grid: which cell holds a point, and which cells a ball may touch.

use photinus_geometry::{Aabb, Vec3};

/// Cells along x that share one line of the cell table.
pub(crate) const SEGMENT_CELLS: u32 = 16;
/// Most cells along an axis: keeps a cell's place in f32 exact to 1/8 of a cell.
const MAX_CELLS: f64 = (1u32 << 20) as f64;
/// Least edge of a cell, scene units: photons closer than 1e-18 have a squared distance that underflows, so that
/// they may be found at any radius; that must be far less than a cell.
const MIN_EDGE: f64 = 1e-15;
/// Relative error of a place in cells, with a margin: one subtraction and one product of f32 make at most 2^-23.
const PLACE_SLACK: f32 = 1.0 / (1u32 << 21) as f32;
/// Relative error of a squared distance and of the radius in cells, with a margin: about 2^-22.
const RADIUS_SLACK: f32 = 1.0 / (1u32 << 19) as f32;
/// What underflow may add to a distance, in cells.
const UNDERFLOW_SLACK: f32 = 1.0 / 512.0;

/// A uniform grid over the photons' box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cells {
    min: Vec3,
    inv_edge: f32,
    /// Cells along each axis.
    count: [u32; 3],
    /// Segments along x.
    segments_x: u64,
}

/// Rows of cells that a ball may touch: see [`Cells::ball`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    u: Vec3,
    slack: Vec3,
    radius_sq: f32,
    y: [u32; 2],
    z: [u32; 2],
}

impl Cells {
    /// A grid of cells of `edge` (positive) over `bounds` (not empty), with fewer and larger cells where the box is
    /// more than 2^20 edges long; `None` where the box is so large that distances overflow.
    pub(crate) fn new(bounds: Aabb, edge: f32) -> Option<Self> {
        let size = bounds.size();
        if !(size.max_element() < 1e18) {
            return None;
        }
        let edge = f64::from(edge).max(MIN_EDGE).max(f64::from(size.max_element()) / (MAX_CELLS - 2.0));
        let inv_edge = (1.0 / edge) as f32;
        if !(inv_edge > 0.0 && inv_edge.is_finite()) {
            return None;
        }
        let count = (size * inv_edge).to_array().map(|u| u as u32 + 1);
        Some(Self { min: bounds.min, inv_edge, count, segments_x: u64::from(count[0].div_ceil(SEGMENT_CELLS)) })
    }

    /// Segments in all, empty ones included.
    pub(crate) fn segment_count(&self) -> u64 {
        self.segments_x * u64::from(self.count[1]) * u64::from(self.count[2])
    }

    /// Edge of a cell, scene units.
    pub(crate) fn edge(&self) -> f32 {
        1.0 / self.inv_edge
    }

    /// Place of a point in units of cells; monotone along each axis.
    #[inline]
    fn place(&self, p: Vec3) -> Vec3 {
        (p - self.min) * self.inv_edge
    }

    /// Index of the cell of a point inside the box, x fastest, rows padded to whole segments.
    #[inline]
    pub(crate) fn cell(&self, p: Vec3) -> u64 {
        let u = self.place(p);
        self.segment(u.y as u32, u.z as u32, u.x as u32 / SEGMENT_CELLS) * u64::from(SEGMENT_CELLS)
            + u64::from(u.x as u32 % SEGMENT_CELLS)
    }

    /// As [`Cells::cell`] for any point: outside the box, the nearest cell's.
    #[inline]
    pub(crate) fn nearest_cell(&self, p: Vec3) -> u64 {
        let u = self.place(p).to_array();
        // The cast takes NaN and what is below zero to zero.
        let [x, y, z] = std::array::from_fn(|axis| (u[axis] as u32).min(self.count[axis] - 1));
        self.segment(y, z, x / SEGMENT_CELLS) * u64::from(SEGMENT_CELLS) + u64::from(x % SEGMENT_CELLS)
    }

    /// Index of a segment: x fastest, then y, then z.
    #[inline]
    pub(crate) fn segment(&self, y: u32, z: u32, segment_x: u32) -> u64 {
        (u64::from(z) * u64::from(self.count[1]) + u64::from(y)) * self.segments_x + u64::from(segment_x)
    }

    /// Whether a ball of this radius is small enough to be worth cells.
    #[inline]
    pub(crate) fn is_countable(&self, radius: f32) -> bool {
        radius * self.inv_edge < MAX_CELLS as f32
    }

    /// The rows that the ball around `position` may touch; `None` where it touches no cell.
    #[inline]
    pub(crate) fn ball(&self, position: Vec3, radius: f32) -> Option<Ball> {
        let u = self.place(position);
        let count = Vec3::new(self.count[0] as f32, self.count[1] as f32, self.count[2] as f32);
        let slack = (u.abs() + count) * PLACE_SLACK;
        let radius = radius * self.inv_edge * (1.0 + RADIUS_SLACK) + UNDERFLOW_SLACK;
        let span = |axis: usize| self.span(axis, u[axis], radius + slack[axis]);
        let (_, y, z) = (span(0)?, span(1)?, span(2)?);
        Some(Ball { u, slack, radius_sq: radius * radius, y, z })
    }

    /// First and last cell of an axis within `half` cells of `u`; `None` where there is none or a bound is NaN.
    #[inline]
    fn span(&self, axis: usize, u: f32, half: f32) -> Option<[u32; 2]> {
        let (low, high) = (u - half, u + half);
        let count = self.count[axis];
        (high >= 0.0 && low < count as f32).then(|| [low as u32, (high as u32).min(count - 1)])
    }

    /// Calls `visit` with (y, z, first x, last x) of the cells that a ball may touch, a row at a time, ascending in z
    /// and then y.
    #[inline]
    pub(crate) fn rows(&self, ball: &Ball, mut visit: impl FnMut(u32, u32, [u32; 2])) {
        let outside = |cell: u32, u: f32, slack: f32| {
            let cell = cell as f32;
            ((cell - u).max(u - (cell + 1.0)) - slack).max(0.0)
        };
        for z in ball.z[0]..=ball.z[1] {
            let dz = outside(z, ball.u.z, ball.slack.z);
            let rest = ball.radius_sq - dz * dz;
            for y in ball.y[0]..=ball.y[1] {
                let dy = outside(y, ball.u.y, ball.slack.y);
                let chord_sq = rest - dy * dy;
                if chord_sq >= 0.0
                    && let Some(x) = self.span(0, ball.u.x, chord_sq.sqrt() + ball.slack.x)
                {
                    visit(y, z, x);
                }
            }
        }
    }
}

impl Ball {
    /// Rows that the ball's box touches.
    #[inline]
    pub(crate) fn row_count(&self) -> u64 {
        u64::from(self.y[1] - self.y[0] + 1) * u64::from(self.z[1] - self.z[0] + 1)
    }
}
