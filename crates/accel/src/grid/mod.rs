//! What the grids share: a box divided into equal cells, which of them a primitive reaches, and the walk of a ray.

mod raster;
mod walk;

pub(crate) use raster::{Lists, Raster};

use crate::bounds::{half_area_f64, size_f64};
use crate::structure::StructureSummary;

impl Raster {
    /// A grid of cells with so many primitives each, those of low z, then low y, then low x first, in so many bytes.
    ///
    /// There are no interior nodes: walks count cells. The cost is that of the tests of a ray through the bounds, cells
    /// being met by chance as their area says.
    pub fn summary(&self, name: &'static str, counts: impl Iterator<Item = u32>, bytes: usize) -> StructureSummary {
        let mut out = StructureSummary { name, bytes: bytes as u64 + self.bytes(), ..StructureSummary::default() };
        for count in counts {
            *if count > 0 { &mut out.leaves } else { &mut out.empty_leaves } += 1;
            out.references += u64::from(count);
        }
        let size = size_f64(&self.bounds);
        let cell: [f64; 3] = std::array::from_fn(|k| size[k] / self.cells[k] as f64);
        if half_area_f64(size) > 0.0 {
            out.sah_cost = out.references as f64 * half_area_f64(cell) / half_area_f64(size);
        }
        out.prims_per_leaf = if out.leaves == 0 { 0.0 } else { out.references as f64 / out.leaves as f64 };
        out
    }
}

#[cfg(test)]
mod tests;
