//! A box divided into equal cells, and the lists of the primitives that reach into each.

use crate::bounds::{padded_bounds, size_f64};
use crate::fragment::{Polygon, margins};
use crate::options::{BuildError, BuildOptions, Clip, check};
use photinus_geometry::{Aabb, Primitives};
use rayon::prelude::*;
use std::ops::RangeInclusive;

/// Cells at most.
const MAX_CELLS: f64 = (1 << 24) as f64;
/// Cells that primitives reach by their bounds, at most for each: coarser cells are taken where there would be more.
const MAX_REFERENCES_PER_PRIM: u64 = 32;
/// References at most, which keeps their places within 32 bits.
const MAX_REFERENCES: u64 = 1 << 31;

/// Equal cells of a box.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Raster {
    /// The box: padded bounds of all primitives that can be hit.
    pub bounds: Aabb,
    /// Cells along each axis, at least one.
    pub cells: [usize; 3],
    /// Borders of the cells along each axis, one more than cells, ascending.
    pub borders: [Vec<f32>; 3],
    /// Cells for each scene unit along each axis; where a guess starts.
    pub per_unit: [f32; 3],
}

/// Primitives by cell.
pub(crate) struct Lists {
    /// First place of each cell's list in `refs`, and one more: their length.
    pub starts: Vec<u32>,
    /// Primitive ids, ascending within a cell.
    pub refs: Vec<u32>,
}

/// A primitive that can be hit, with its padded bounds.
type Prim = (u32, Aabb);

impl Raster {
    /// Divides the bounds of `primitives` into `density` cells for each, and lists what reaches into each cell.
    ///
    /// # Errors
    /// A density out of its range.
    pub fn new(primitives: &Primitives, options: &BuildOptions) -> Result<(Self, Lists), BuildError> {
        let density = options.density;
        check("the density", density, density > 0.0 && density <= 1000.0, "more than 0, at most 1000")?;
        let prims: Vec<Prim> = (0..primitives.len())
            .into_par_iter()
            .with_min_len(1024)
            .filter_map(|id| Some((id as u32, padded_bounds(primitives, id)?)))
            .collect();
        let bounds = prims.iter().fold(Aabb::EMPTY, |b, (_, c)| b.union(*c));
        let most = (prims.len() as u64 * MAX_REFERENCES_PER_PRIM).min(MAX_REFERENCES);
        let mut target = (density * prims.len() as f64).min(MAX_CELLS);
        let raster = loop {
            let raster = Self::of(bounds, target);
            if target < 1.0 || raster.reach(&prims) <= most {
                break raster;
            }
            target *= 0.5;
        };
        let lists = raster.lists(primitives, &prims, options.clip);
        Ok((raster, lists))
    }

    /// About `target` cells, as near to cubes as whole numbers of them allow.
    fn of(bounds: Aabb, target: f64) -> Self {
        let cells = if bounds.is_empty() { [1; 3] } else { resolution(size_f64(&bounds), target) };
        let borders = std::array::from_fn(|k| borders(bounds.min[k], bounds.max[k], cells[k]));
        let size = size_f64(&bounds);
        let per_unit = std::array::from_fn(|k| if size[k] > 0.0 { (cells[k] as f64 / size[k]) as f32 } else { 0.0 });
        Self { bounds, cells, borders, per_unit }
    }

    /// How many cells there are.
    pub fn cell_count(&self) -> usize {
        self.cells.iter().product()
    }

    /// The cell at these places along the axes.
    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.cells[1] + y) * self.cells[0] + x
    }

    /// Memory beside that of the cells.
    pub fn bytes(&self) -> u64 {
        self.borders.iter().map(|b| size_of_val(&b[..]) as u64).sum()
    }

    /// Cells along an axis that touch an interval within the bounds.
    fn range(&self, axis: usize, low: f64, high: f64) -> RangeInclusive<usize> {
        let borders = &self.borders[axis];
        let last = self.cells[axis] - 1;
        let first = borders[1..].partition_point(|b| f64::from(*b) < low).min(last);
        let end = borders[..=last].partition_point(|b| f64::from(*b) <= high);
        first..=end.saturating_sub(1).max(first)
    }

    /// Cells that the primitives touch by their bounds, all together.
    fn reach(&self, prims: &[Prim]) -> u64 {
        let of = |b: &Aabb| {
            let along = |k: usize| self.range(k, f64::from(b.min[k]), f64::from(b.max[k])).count() as u64;
            along(0) * along(1) * along(2)
        };
        prims.iter().fold(0u64, |sum, (_, b)| sum.saturating_add(of(b)))
    }

    /// Lists by counting first (Lagae and Dutre, section 3): how many references each cell has, then where they go.
    fn lists(&self, primitives: &Primitives, prims: &[Prim], clip: Clip) -> Lists {
        let mut starts = vec![0u32; self.cell_count() + 1];
        for prim in prims {
            self.reached(primitives, prim, clip, |cell| starts[cell] += 1);
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += std::mem::replace(start, sum);
        }
        let mut refs = vec![0; sum as usize];
        for prim in prims {
            self.reached(primitives, prim, clip, |cell| {
                refs[starts[cell] as usize] = prim.0;
                starts[cell] += 1;
            });
        }
        // Every start has moved to that of the next cell.
        starts.copy_within(..self.cell_count(), 1);
        starts[0] = 0;
        Lists { starts, refs }
    }

    /// Hands out the cells that a primitive reaches, those of low z, then low y, then low x first.
    fn reached(&self, primitives: &Primitives, (id, b): &Prim, clip: Clip, mut cell: impl FnMut(usize)) {
        let polygon = match clip {
            Clip::Box => None,
            Clip::Exact => Polygon::of(primitives, *id as usize),
        };
        let all: [_; 3] = std::array::from_fn(|k| self.range(k, f64::from(b.min[k]), f64::from(b.max[k])));
        let [all_x, all_y, all_z] = all;
        let Some(polygon) = polygon else {
            for z in all_z {
                for y in all_y.clone() {
                    for x in all_x.clone() {
                        cell(self.index([x, y, z]));
                    }
                }
            }
            return;
        };
        // Slice by slice, row by row: only what is left of the triangle there reaches further.
        let margins = margins(primitives, *id as usize);
        let slice = |of: &Polygon, k: usize, place: usize| {
            let (low, high) = (f64::from(self.borders[k][place]), f64::from(self.borders[k][place + 1]));
            of.between(k, low - margins[k], high + margins[k])
        };
        let along = |of: &Polygon, k: usize, all: &RangeInclusive<usize>| {
            let (low, high) = of.range(k);
            let range = self.range(k, low - margins[k], high + margins[k]);
            *range.start().max(all.start())..=*range.end().min(all.end())
        };
        for z in all_z {
            let slab = slice(&polygon, 2, z);
            if slab.is_empty() {
                continue;
            }
            for y in along(&slab, 1, &all_y) {
                let row = slice(&slab, 1, y);
                if row.is_empty() {
                    continue;
                }
                for x in along(&row, 0, &all_x) {
                    cell(self.index([x, y, z]));
                }
            }
        }
    }
}

/// Cells along each axis: the cube root of `target` over the volume, times the size; axes too thin for a second cell
/// have one, and the others share the target.
fn resolution(size: [f64; 3], target: f64) -> [usize; 3] {
    let mut cells = [0usize; 3];
    loop {
        let free: Vec<usize> = (0..3).filter(|k| cells[*k] == 0).collect();
        // In logarithms nothing is too large or too small.
        let log = |x: f64| libm::log2(x.max(f64::MIN_POSITIVE));
        let share = (log(target) - free.iter().map(|k| log(size[*k])).sum::<f64>()) / free.len() as f64;
        let along = |k: usize| libm::exp2(share + log(size[k]));
        let Some(thin) = free.iter().copied().find(|k| !(along(*k) >= 1.5)) else {
            for k in free {
                // Below what the smallest cell of all other axes leaves.
                cells[k] = (along(k) + 0.5).min(MAX_CELLS) as usize;
            }
            return cells;
        };
        cells[thin] = 1;
    }
}

/// Borders of `cells` equal parts, rounded once each, so that they ascend.
fn borders(low: f32, high: f32, cells: usize) -> Vec<f32> {
    let step = (f64::from(high) - f64::from(low)) / cells as f64;
    let mut out: Vec<f32> = (0..=cells).map(|i| (f64::from(low) + step * i as f64) as f32).collect();
    (out[0], out[cells]) = (low, high);
    out
}
