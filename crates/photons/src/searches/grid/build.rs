//! Building the grid: box, keys, sort, blocks, table. Parallel, with the same bits on any number of threads.

use super::blocks::{BLOCKS_A_TASK, Block, Boxes, LANES};
use super::cells::Cells;
use super::sort::{ITEMS_A_TASK, Item, Sorted, sort_by_key};
use super::table::CellTable;
use crate::{BuildOptions, Photon};
use photinus_geometry::Aabb;
use rayon::prelude::*;

/// What building gives.
pub(crate) struct Built {
    pub(crate) cells: Cells,
    pub(crate) table: CellTable,
    pub(crate) blocks: Vec<Block>,
    pub(crate) boxes: Boxes,
    /// The ids of each block's photons.
    pub(crate) ids: Vec<[u32; LANES]>,
}

/// Photons in blocks, in the order of cells that suit the hint.
pub(crate) fn build(photons: Vec<Photon>, options: &BuildOptions) -> Built {
    let around = |photons: &[Photon]| Aabb::around(photons.iter().map(Photon::position));
    let bounds = photons.par_chunks(ITEMS_A_TASK).map(around).reduce(|| Aabb::EMPTY, Aabb::union);
    let radius = options.radius().unwrap_or_else(|| typical_radius(bounds, photons.len()));
    let cells = Cells::new(bounds, radius);
    if cells.key_bits() <= <u64 as Item>::KEY_BITS {
        arrange::<u64>(photons, cells)
    } else {
        arrange::<(u64, u32)>(photons, cells)
    }
}

fn arrange<I: Item>(photons: Vec<Photon>, cells: Cells) -> Built {
    let Sorted { staged, items } = sort_by_key::<I>(photons, cells.key_bits(), |p| cells.key(p.position()));
    let table = CellTable::new(&cells, &items);
    let fill = |items: &[I]| {
        let (mut block, mut ids) = (Block::EMPTY, [u32::MAX; LANES]);
        for (lane, item) in items.iter().enumerate() {
            let [words @ .., id] = staged[item.id() as usize];
            block.set(lane, words);
            ids[lane] = id;
        }
        (block, ids)
    };
    let (mut blocks, mut ids) = (Vec::new(), Vec::new());
    items.par_chunks(LANES).with_min_len(BLOCKS_A_TASK).map(fill).unzip_into_vecs(&mut blocks, &mut ids);
    let boxes = Boxes::new(&blocks);
    Built { cells, table, blocks, boxes, ids }
}

/// A radius that holds a few dozen photons where they lie evenly on the faces of their box.
fn typical_radius(bounds: Aabb, photons: usize) -> f32 {
    let area = 2.0 * bounds.half_area();
    let radius = (area * 32.0 / photons as f32).sqrt();
    // Photons on a line or at a point have no area.
    if radius > 0.0 && radius.is_finite() { radius } else { bounds.diagonal() / 256.0 }
}
