//! The walk of a ray through the cells of a grid, front to back (after Amanatides and Woo, "A Fast Voxel Traversal
//! Algorithm for Ray Tracing", Eurographics 1987).
//!
//! As there, the next cell lies across the border whose parameter is least. Two things differ, so that no hit is lost
//! to rounding. Parameters are computed from the borders, not added up. And along each axis a cell is open from a
//! little before its first border until a little after its last (see [`crate::planes`]), so that at a border two cells
//! are open: where the ray passes an edge or a corner of cells, all of those around it are visited. Each cell is visited
//! once, when the last of its three places opens.

use super::Raster;
use crate::laboratory::LeafVisit;
use crate::planes::{clip, earliest, latest};
use photinus_geometry::Ray;
use std::ops::{ControlFlow, Range};

/// Places along one axis, counted in the ray's direction, that are open at a time.
struct Track<'a> {
    borders: &'a [f32],
    cells: usize,
    origin: f32,
    dir: f32,
    backward: bool,
    /// Lowest and highest open place.
    low: usize,
    high: usize,
    /// Parameter at which the place above the highest opens; infinite where there is none.
    opens: f32,
    /// Parameter at which the lowest place closes; infinite for the last one.
    closes: f32,
}

impl<'a> Track<'a> {
    /// The places open at parameter `enter`.
    fn new(raster: &'a Raster, axis: usize, ray: &Ray, enter: f32) -> Self {
        let (origin, cells) = (ray.origin[axis], raster.cells[axis]);
        // A direction of minus zero is one of zero.
        let dir = if ray.dir[axis] == 0.0 { 0.0 } else { ray.dir[axis] };
        let backward = dir < 0.0;
        let mut out = Self {
            borders: &raster.borders[axis],
            cells,
            origin,
            dir,
            backward,
            low: 0,
            high: 0,
            opens: 0.0,
            closes: 0.0,
        };
        let start = (origin - raster.bounds.min[axis] + dir * enter) * raster.per_unit[axis];
        // What is not a number becomes zero; the loops put any guess right.
        let guess = (start as usize).min(cells - 1);
        let mut low = if backward { cells - 1 - guess } else { guess };
        while low > 0 && !(latest(out.param(low)) < enter) {
            low -= 1;
        }
        while low + 1 < cells && latest(out.param(low + 1)) < enter {
            low += 1;
        }
        let mut high = low;
        while high + 1 < cells && !(earliest(out.param(high + 1)) > enter) {
            high += 1;
        }
        (out.low, out.high) = (low, high);
        out.look_ahead();
        out.look_back();
        out
    }

    /// The parameter at which place `place` begins.
    #[inline(always)]
    fn param(&self, place: usize) -> f32 {
        let border = self.borders[if self.backward { self.cells - place } else { place }];
        (border - self.origin) / self.dir
    }

    #[inline(always)]
    fn look_ahead(&mut self) {
        self.opens = if self.high + 1 < self.cells { earliest(self.param(self.high + 1)) } else { f32::INFINITY };
    }

    #[inline(always)]
    fn look_back(&mut self) {
        self.closes = if self.low + 1 < self.cells { latest(self.param(self.low + 1)) } else { f32::INFINITY };
    }

    /// Closes what lies behind parameter `t`.
    #[inline(always)]
    fn close_until(&mut self, t: f32) {
        while self.closes < t {
            self.low += 1;
            self.look_back();
        }
    }

    /// The cell's index along the axis.
    #[inline(always)]
    fn cell(&self, place: usize) -> usize {
        if self.backward { self.cells - 1 - place } else { place }
    }
}

impl Raster {
    /// Calls `node` at every cell and `leaf` at every cell with primitives that the ray meets, whose places `list`
    /// gives, front to back, until that breaks.
    #[inline(always)]
    pub fn walk(
        &self,
        ray: &Ray,
        list: impl Fn([usize; 3]) -> Range<usize>,
        mut node: impl FnMut(),
        mut leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>,
    ) {
        let Some((enter, leave)) = clip(ray, &self.bounds) else { return };
        let mut tracks: [Track<'_>; 3] = std::array::from_fn(|axis| Track::new(self, axis, ray, enter));
        let mut end = leave;
        let mut open = [0, 1, 2].map(|k| (tracks[k].low, tracks[k].high));
        loop {
            for z in open[2].0..=open[2].1 {
                for y in open[1].0..=open[1].1 {
                    for x in open[0].0..=open[0].1 {
                        node();
                        let refs = list([tracks[0].cell(x), tracks[1].cell(y), tracks[2].cell(z)]);
                        if refs.is_empty() {
                            continue;
                        }
                        let ControlFlow::Continue(left) = leaf(LeafVisit { refs, exit: f32::NEG_INFINITY }) else {
                            return;
                        };
                        end = end.min(left);
                    }
                }
            }
            let [x, y, z] = [0, 1, 2].map(|k| tracks[k].opens);
            let (axis, t) = if x <= y && x <= z {
                (0, x)
            } else if y <= z {
                (1, y)
            } else {
                (2, z)
            };
            if !(t <= end) || tracks[axis].high + 1 >= tracks[axis].cells {
                return;
            }
            for track in &mut tracks {
                track.close_until(t);
            }
            tracks[axis].high += 1;
            tracks[axis].look_ahead();
            open = [0, 1, 2].map(|k| (tracks[k].low, tracks[k].high));
            open[axis].0 = tracks[axis].high;
        }
    }
}
