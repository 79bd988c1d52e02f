//! The uniform grid: equal cells, each with a list of the primitives that reach into it (Fujimoto, Tanaka, Iwata,
//! "ARTS: Accelerated Ray-Tracing System", IEEE CG&A 6(4), 1986; walked after Amanatides and Woo, 1987).
//!
//! A cell is the place and the length of its list: eight bytes. Of room for lists no more is taken than primitives
//! need, and where they reach more than 32 cells each, cells are made coarser.

use crate::grid::{Lists, Raster};
use crate::laboratory::{LeafVisit, Leaves};
use crate::list::laboratory;
use crate::options::{BuildError, BuildOptions};
use crate::structure::{Structure, StructureSummary};
use photinus_geometry::{Primitives, Ray};
use std::ops::{ControlFlow, Range};
use std::sync::Arc;

/// The name on the command line.
pub const NAME: &str = "uniform-grid";
/// One line for the help.
pub const SUMMARY: &str = "equal cells with lists, walked from border to border";
/// Where it was published.
pub const SOURCE: &str = "Amanatides, Woo, Eurographics 1987; Fujimoto, Tanaka, Iwata, IEEE CG&A 6(4), 1986";

/// The list of a cell.
#[derive(Clone, Copy, Debug)]
struct Cell {
    start: u32,
    count: u32,
}

struct UniformGrid {
    raster: Raster,
    cells: Vec<Cell>,
    refs: Vec<u32>,
}

/// See [`crate::build`].
pub fn build(primitives: Arc<Primitives>, options: &BuildOptions) -> Result<Box<dyn Structure>, BuildError> {
    let (raster, Lists { starts, refs }) = Raster::new(&primitives, options)?;
    let cells = starts.windows(2).map(|w| Cell { start: w[0], count: w[1] - w[0] }).collect();
    laboratory(UniformGrid { raster, cells, refs }, &primitives, options)
}

impl UniformGrid {
    #[inline(always)]
    fn list(&self, place: [usize; 3]) -> Range<usize> {
        let Cell { start, count } = self.cells[self.raster.index(place)];
        start as usize..start as usize + count as usize
    }
}

impl Leaves for UniformGrid {
    fn refs(&self) -> &[u32] {
        &self.refs
    }

    #[inline(always)]
    fn walk(&self, ray: &Ray, node: impl FnMut(), leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        self.raster.walk(ray, |place| self.list(place), node, leaf);
    }

    fn summary(&self) -> StructureSummary {
        let counts = self.cells.iter().map(|cell| cell.count);
        self.raster.summary(NAME, counts, size_of_val(&self.cells[..]) + size_of_val(&self.refs[..]))
    }
}
