//! From a ball to the blocks that it reaches: cells, then boxes.

use super::Grid;
use super::blocks::LANES;
use super::cells::{Cells, Reached};
use super::facing::ALL;
use photinus_geometry::Vec3;
use std::ops::Range;

/// What one query hands to the next, so that neighbours share work; results do not depend on it.
pub(crate) struct Scratch {
    /// The half cell and the radius (fine cells) that `ranges` are for.
    half_cell: Vec3,
    radius: f32,
    /// The normal that `facing` is for.
    normal: Vec3,
    facing: u32,
    /// Blocks of the cells around, as ascending ranges that do not overlap.
    ranges: Vec<Range<u32>>,
    /// Blocks in reach of the query.
    pub(crate) hits: Vec<u32>,
}

impl Scratch {
    pub(crate) fn new() -> Self {
        Self {
            half_cell: Vec3::NAN,
            radius: -1.0,
            normal: Vec3::NAN,
            facing: ALL,
            ranges: Vec::with_capacity(16),
            hits: Vec::with_capacity(64),
        }
    }
}

impl Grid {
    /// As [`Self::find_blocks`], without blocks whose photons are all turned too far from a normal.
    #[inline]
    pub(crate) fn find_facing(&self, position: Vec3, normal: Vec3, radius: f32, r2: f32, scratch: &mut Scratch) {
        // Neighbours on a plane share theirs.
        if normal != scratch.normal {
            (scratch.normal, scratch.facing) = (normal, (self.kernels.facing)(normal));
        }
        self.find_ways(position, radius, r2, scratch.facing, scratch);
    }

    /// Fills `scratch.hits` with the blocks that hold every photon within a radius of a position, ascending.
    #[inline]
    pub(crate) fn find_blocks(&self, position: Vec3, radius: f32, r2: f32, scratch: &mut Scratch) {
        self.find_ways(position, radius, r2, ALL, scratch);
    }

    #[inline]
    fn find_ways(&self, position: Vec3, radius: f32, r2: f32, facing: u32, scratch: &mut Scratch) {
        scratch.hits.clear();
        if !(r2 >= 0.0) {
            return;
        }
        let half_cell = Cells::half_cell(self.cells.place(position));
        let radius = self.cells.radius(radius);
        // Cells for a far larger ball would do, and make more work than finding fewer.
        let fits = radius <= scratch.radius && scratch.radius <= 2.0 * radius;
        if half_cell != scratch.half_cell || !fits {
            (scratch.half_cell, scratch.radius) = (half_cell, radius);
            self.collect_ranges(scratch);
        }
        (self.kernels.cull)(&self.boxes, &scratch.ranges, position, r2, facing, &mut scratch.hits);
    }

    /// The blocks of the cells that balls of `scratch.radius` around `scratch.half_cell` may touch.
    fn collect_ranges(&self, scratch: &mut Scratch) {
        let ranges = &mut scratch.ranges;
        ranges.clear();
        let everything = match self.cells.reached(scratch.half_cell, scratch.radius) {
            Reached::Nothing => return,
            Reached::Cells(reached) => !self.table.collect(&self.cells, reached, ranges),
            Reached::Everything => true,
        };
        if everything {
            ranges.push(0..self.blocks.len() as u32);
            return;
        }
        ranges.sort_unstable_by_key(|slots| slots.start);
        // Slots to blocks: a block may hold photons of several cells.
        let lanes = LANES as u32;
        let mut end = 0;
        ranges.retain_mut(|slots| {
            let blocks = (slots.start / lanes).max(end)..slots.end.div_ceil(lanes);
            end = end.max(blocks.end);
            *slots = blocks;
            slots.start < slots.end
        });
    }
}
