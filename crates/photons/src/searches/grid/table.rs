//! The cell table: which photons are a cell's.
//!
//! A hash table over the occupied cells only, so that the extent of the scene costs nothing. Memory: 16 bytes a slot
//! and two to four slots an occupied cell, of which there are no more than photons.

use super::cells::{CellBox, Cells};
use std::ops::Range;

/// An occupied cell: its index and its photons' slots.
#[derive(Clone, Copy, Debug)]
struct Entry {
    cell: u64,
    first: u32,
    end: u32,
}

/// No cell has this index.
const FREE: Entry = Entry { cell: u64::MAX, first: 0, end: 0 };

/// Open addressing with linear probing over a power of two of entries, at most half of them taken.
#[derive(Debug)]
pub(crate) struct CellTable {
    entries: Vec<Entry>,
    shift: u32,
    cell_count: usize,
    photon_count: usize,
}

impl CellTable {
    /// The table of photons with these Morton keys, ascending.
    pub(crate) fn new(cells: &Cells, keys: impl ExactSizeIterator<Item = u64> + Clone) -> Self {
        let photon_count = keys.len();
        let mut last = None;
        let is_first = |key: u64| !last.replace(key).is_some_and(|last| Cells::same_cell(last, key));
        let cell_count = keys.clone().map(is_first).filter(|first| *first).count();
        let bits = (cell_count * 2).next_power_of_two().ilog2().max(1);
        let mut table = Self { entries: vec![FREE; 1 << bits], shift: 64 - bits, cell_count, photon_count };
        let mut run: Option<(u64, u32)> = None;
        for (slot, key) in (0u32..).zip(keys) {
            match run {
                Some((of, _)) if Cells::same_cell(of, key) => {}
                _ => {
                    if let Some((of, first)) = run {
                        table.insert(Entry { cell: cells.cell_of_key(of), first, end: slot });
                    }
                    run = Some((key, slot));
                }
            }
        }
        if let Some((of, first)) = run {
            table.insert(Entry { cell: cells.cell_of_key(of), first, end: photon_count as u32 });
        }
        table
    }

    /// Fibonacci hashing: the high bits of the product with 2^64 over the golden ratio.
    #[inline]
    fn home(&self, cell: u64) -> usize {
        (cell.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> self.shift) as usize
    }

    fn insert(&mut self, entry: Entry) {
        let mut at = self.home(entry.cell);
        while self.entries[at].cell != FREE.cell {
            at = (at + 1) & (self.entries.len() - 1);
        }
        self.entries[at] = entry;
    }

    /// Slots of a cell's photons; empty where there are none.
    #[inline]
    fn slots(&self, cell: u64) -> Range<u32> {
        let mut at = self.home(cell);
        loop {
            let entry = self.entries[at];
            if entry.cell == cell || entry.cell == FREE.cell {
                return entry.first..entry.end;
            }
            at = (at + 1) & (self.entries.len() - 1);
        }
    }

    /// Photons of an occupied cell, on the mean.
    pub(crate) fn photons_a_cell(&self) -> f32 {
        self.photon_count as f32 / self.cell_count.max(1) as f32
    }

    /// Memory, bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.entries.capacity() * size_of::<Entry>()
    }

    /// Appends the slots of the occupied cells of a box; `false`, with nothing appended, where the box has more cells
    /// than are occupied.
    #[inline]
    pub(crate) fn collect(&self, cells: &Cells, [x, y, z]: CellBox, slots: &mut Vec<Range<u32>>) -> bool {
        let length = |[first, last]: [u32; 2]| f64::from(last - first + 1);
        let count = length(x) * length(y) * length(z);
        if count > 8.0 && count > self.cell_count as f64 {
            return false;
        }
        for z in z[0]..=z[1] {
            for y in y[0]..=y[1] {
                for x in x[0]..=x[1] {
                    let range = self.slots(cells.cell([x, y, z]));
                    if !range.is_empty() {
                        slots.push(range);
                    }
                }
            }
        }
        true
    }
}
