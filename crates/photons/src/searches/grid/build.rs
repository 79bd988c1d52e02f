//! Building the grid: box, keys, sort, blocks, table. Parallel, with the same bits on any number of threads.

use super::blocks::{Block, Boxes, LANES};
use super::cells::Cells;
use super::sort::{ITEMS_A_TASK, Item, Sorted, sort_by_key};
use super::table::CellTable;
use crate::{BuildOptions, Photon};
use photinus_geometry::Aabb;
use photinus_memory::HugeArray;
use rayon::prelude::*;

/// Arrays of as many bytes take huge pages: of small pages the processor knows about as much, and new ones for each map cost
/// a third of the build of a small one.
const HUGE: usize = 8 << 20;

/// What building gives.
pub(crate) struct Built {
    pub(crate) cells: Cells,
    pub(crate) table: CellTable,
    pub(crate) blocks: HugeArray<Block>,
    pub(crate) boxes: Boxes,
    /// The ids of each block's photons.
    pub(crate) ids: HugeArray<[u32; LANES]>,
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
    let count = items.len().div_ceil(LANES);
    let photons_of = |block: usize| items[block * LANES..].iter().take(LANES).map(|item| &staged[item.id() as usize]);
    let (blocks, ids) = HugeArray::pair(count, HUGE, |i| {
        let (mut block, mut ids) = (Block::EMPTY, [u32::MAX; LANES]);
        for (lane, [words @ .., id]) in photons_of(i).enumerate() {
            block.set(lane, *words);
            ids[lane] = *id;
        }
        (block, ids)
    });
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
