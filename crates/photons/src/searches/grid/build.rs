//! Building the grid: box, keys, sort, blocks, table. Parallel, with the same bits on any number of threads.

use super::blocks::{Block, Boxes, LANES};
use super::cells::Cells;
use super::sort::{ITEMS_A_TASK, Item, sort_by_key};
use super::table::CellTable;
use crate::{BuildOptions, Photon};
use photinus_geometry::Aabb;
use rayon::prelude::*;

/// Blocks that are worth a task of their own.
const BLOCKS_A_TASK: usize = 1 << 11;

/// What building gives.
pub(crate) struct Built {
    pub(crate) cells: Cells,
    pub(crate) table: CellTable,
    pub(crate) blocks: Vec<Block>,
    pub(crate) boxes: Boxes,
    /// The id of each slot's photon, padded to whole blocks.
    pub(crate) ids: Vec<u32>,
}

/// Photons in blocks, in the order of cells that suit the hint.
pub(crate) fn build(photons: &[Photon], options: &BuildOptions) -> Built {
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

fn arrange<I: Item>(photons: &[Photon], cells: Cells) -> Built {
    let item = |(id, photon): (usize, &Photon)| I::new(cells.key(photon.position()), id as u32);
    let items: Vec<I> = photons.par_iter().enumerate().with_min_len(ITEMS_A_TASK).map(item).collect();
    let items = sort_by_key(items, cells.key_bits());
    let table = CellTable::new(&cells, &items);
    let count = photons.len().div_ceil(LANES);
    let mut blocks = vec![Block::EMPTY; count];
    let mut ids = vec![u32::MAX; count * LANES];
    let chunks = blocks.par_iter_mut().zip(items.par_chunks(LANES)).zip(ids.par_chunks_mut(LANES));
    let bounds = chunks.with_min_len(BLOCKS_A_TASK).map(|((block, items), ids)| {
        for (id, item) in ids.iter_mut().zip(items) {
            *id = item.id();
        }
        if let Ok(ids) = <&[u32; LANES]>::try_from(&ids[..items.len()]) {
            // All sixteen reads before any write: they miss the caches, and so wait together.
            *block = Block::new(&ids.map(|id| photons[id as usize]));
        } else {
            for (lane, item) in items.iter().enumerate() {
                block.set(lane, &photons[item.id() as usize]);
            }
        }
        block.bounds()
    });
    let boxes = Boxes::new(bounds.collect());
    Built { cells, table, blocks, boxes, ids }
}

/// A radius that holds a few dozen photons where they lie evenly on the faces of their box.
fn typical_radius(bounds: Aabb, photons: usize) -> f32 {
    let area = 2.0 * bounds.half_area();
    let radius = (area * 32.0 / photons as f32).sqrt();
    // Photons on a line or at a point have no area.
    if radius > 0.0 && radius.is_finite() { radius } else { bounds.diagonal() / 256.0 }
}
