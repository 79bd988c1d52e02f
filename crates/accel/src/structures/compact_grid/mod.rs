//! The compact grid (Lagae and Dutre, "Compact, Fast and Robust Grids for Ray Tracing", EGSR 2008): cells know only
//! where their lists start, as one list follows the other, and lists are made by counting first.
//!
//! In its hashed form (section 4 of the paper) even that is kept for cells with primitives only: one bit for each cell
//! says whether it has any, and rows of cells are pushed into each other's gaps. Lists then lie in the order of the hash
//! table, whose gaps repeat the offset that follows, so that here, too, a list ends where the next one starts.

mod hash;

use crate::grid::Raster;
use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions, GridCells};
use crate::structure::{Structure, StructureSummary};
use hash::Rows;
use photinus_geometry::{Primitives, Ray};
use std::ops::{ControlFlow, Range};
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "compact-grid";
/// One line for the help.
pub const SUMMARY: &str = "a grid of one offset a cell, or of hashed rows (--grid-cells hashed)";
/// Where it was published.
pub const SOURCE: &str = "Lagae, Dutre, Compact, Fast and Robust Grids for Ray Tracing, EGSR 2008";

/// How a cell finds its list.
enum Cells {
    /// Offset of every cell's list, and one more.
    Array(Vec<u32>),
    /// Offsets by hash.
    Hashed(Rows),
}

struct CompactGrid {
    raster: Raster,
    cells: Cells,
    refs: Vec<u32>,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    laboratory(CompactGrid::new(&primitives, options)?, &primitives, options)
}

impl CompactGrid {
    fn new(primitives: &Primitives, options: &BuildOptions) -> Result<Self, BuildError> {
        let (raster, lists) = Raster::new(primitives, options)?;
        Ok(match options.grid_cells {
            GridCells::Array => Self { raster, cells: Cells::Array(lists.starts), refs: lists.refs },
            GridCells::Hashed => {
                let (rows, refs) = Rows::new(&lists, raster.cells[0]);
                Self { raster, cells: Cells::Hashed(rows), refs }
            }
        })
    }

    #[inline(always)]
    fn array_list(&self, starts: &[u32], place: [usize; 3]) -> Range<usize> {
        let cell = self.raster.index(place);
        starts[cell] as usize..starts[cell + 1] as usize
    }

    #[inline(always)]
    fn hashed_list(&self, rows: &Rows, [x, y, z]: [usize; 3]) -> Range<usize> {
        rows.list(z * self.raster.cells[1] + y, x)
    }
}

impl Leaves for CompactGrid {
    fn refs(&self) -> &[u32] {
        &self.refs
    }

    #[inline(always)]
    fn walk(&self, ray: &Ray, node: impl FnMut(), leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        match &self.cells {
            Cells::Array(starts) => self.raster.walk(ray, |place| self.array_list(starts, place), node, leaf),
            Cells::Hashed(rows) => self.raster.walk(ray, |place| self.hashed_list(rows, place), node, leaf),
        }
    }

    fn summary(&self) -> StructureSummary {
        let (counts, bytes): (Vec<u32>, usize) = match &self.cells {
            Cells::Array(starts) => (starts.windows(2).map(|w| w[1] - w[0]).collect(), size_of_val(&starts[..])),
            Cells::Hashed(rows) => {
                let [nx, ny, nz] = self.raster.cells;
                let row = |row| (0..nx).map(move |x| rows.list(row, x).len() as u32);
                ((0..ny * nz).flat_map(row).collect(), rows.bytes())
            }
        };
        self.raster.summary(NAME, counts.into_iter(), bytes + size_of_val(&self.refs[..]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::Clip;
    use photinus_geometry::Vec3;
    use photinus_num::{Sampler, StreamKind};

    fn soup(count: u32) -> Primitives {
        let mut out = Primitives::default();
        for i in 0..count {
            let mut s = Sampler::new(71, StreamKind::Test, 0, i);
            let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
            let (a, b, c) = (vec3(), vec3(), vec3());
            out.positions.extend([a, a + 0.02 * b, a + 0.02 * c]);
            out.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        out
    }

    #[test]
    fn hashed_cells_hold_what_those_of_the_array_hold() {
        for (count, density) in [(0, 1.0), (1, 1.0), (300, 0.1), (2000, 8.0)] {
            let primitives = soup(count);
            let grid = |grid_cells| {
                let options = BuildOptions { grid_cells, density, clip: Clip::Exact, ..BuildOptions::default() };
                CompactGrid::new(&primitives, &options).unwrap()
            };
            let (array, hashed) = (grid(GridCells::Array), grid(GridCells::Hashed));
            let (Cells::Array(starts), Cells::Hashed(rows)) = (&array.cells, &hashed.cells) else {
                panic!("other cells")
            };
            let [nx, ny, nz] = array.raster.cells;
            for place in (0..nx * ny * nz).map(|i| [i % nx, i / nx % ny, i / nx / ny]) {
                let (a, b) = (array.array_list(starts, place), hashed.hashed_list(rows, place));
                assert_eq!(array.refs[a], hashed.refs[b], "cell {place:?} of {count} triangles");
            }
            assert_eq!(array.refs.len(), hashed.refs.len());
            let (array, hashed) = (array.summary(), hashed.summary());
            assert!(count < 2000 || hashed.bytes < array.bytes, "{hashed:?}, {array:?}");
            assert_eq!((array.leaves, array.empty_leaves), (hashed.leaves, hashed.empty_leaves));
        }
    }
}
