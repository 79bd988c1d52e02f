//! The cell table: which photons are a cell's.
//!
//! A hash table over the occupied cells only, so that the extent of the scene costs nothing. Memory: 16.5 bytes a slot
//! and two to four slots an occupied cell, of which there are no more than photons.

use super::cells::{CellBox, Cells};
use super::sort::{ITEMS_A_TASK, Item};
use rayon::prelude::*;
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

/// Bits of the filter for each slot, as a power of two.
const FILTER_BITS: u32 = 2;

/// Open addressing with linear probing over a power of two of entries, at most half of them taken.
#[derive(Debug)]
pub(crate) struct CellTable {
    entries: Vec<Entry>,
    shift: u32,
    /// Four bits a slot, set where a cell's hash falls there: most cells around a query are
    /// empty, and this much of the table stays near.
    filter: Vec<u64>,
    cell_count: usize,
    photon_count: usize,
}

impl CellTable {
    /// The table of photons whose items are `items`, ascending.
    pub(crate) fn new<I: Item>(cells: &Cells, items: &[I]) -> Self {
        // The slots where a cell begins, piece by piece.
        let begins = |slot: usize| slot == 0 || !Cells::same_cell(items[slot - 1].key(), items[slot].key());
        let piece = |piece: usize| {
            let slots = piece * ITEMS_A_TASK..items.len().min((piece + 1) * ITEMS_A_TASK);
            slots.filter(|slot| begins(*slot)).map(|slot| slot as u32).collect::<Vec<_>>()
        };
        let pieces = items.len().div_ceil(ITEMS_A_TASK);
        let firsts: Vec<u32> = (0..pieces).into_par_iter().map(piece).collect::<Vec<_>>().concat();
        let bits = (firsts.len() * 2).next_power_of_two().ilog2().max(1);
        let mut table = Self {
            entries: vec![FREE; 1 << bits],
            shift: 64 - bits,
            filter: vec![0; (1usize << (bits + FILTER_BITS)).div_ceil(64)],
            cell_count: firsts.len(),
            photon_count: items.len(),
        };
        let ends = firsts.iter().skip(1).copied().chain([items.len() as u32]);
        for (&first, end) in firsts.iter().zip(ends) {
            table.insert(Entry { cell: cells.cell_of_key(items[first as usize].key()), first, end });
        }
        table
    }

    /// Fibonacci hashing: the high bits of the product with 2^64 over the golden ratio.
    #[inline]
    fn hash(cell: u64) -> u64 {
        cell.wrapping_mul(0x9E37_79B9_7F4A_7C15)
    }

    /// Word and bit of the filter.
    #[inline]
    fn filter_bit(&self, hash: u64) -> (usize, u64) {
        let bit = hash >> (self.shift - FILTER_BITS);
        ((bit >> 6) as usize, 1 << (bit & 63))
    }

    fn insert(&mut self, entry: Entry) {
        let hash = Self::hash(entry.cell);
        let (word, bit) = self.filter_bit(hash);
        self.filter[word] |= bit;
        let mut at = (hash >> self.shift) as usize;
        while self.entries[at].cell != FREE.cell {
            at = (at + 1) & (self.entries.len() - 1);
        }
        self.entries[at] = entry;
    }

    /// Slots of a cell's photons; empty where there are none.
    #[inline]
    fn slots(&self, cell: u64) -> Range<u32> {
        let hash = Self::hash(cell);
        let (word, bit) = self.filter_bit(hash);
        if self.filter[word] & bit == 0 {
            return 0..0;
        }
        let mut at = (hash >> self.shift) as usize;
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
        self.entries.capacity() * size_of::<Entry>() + self.filter.capacity() * size_of::<u64>()
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
