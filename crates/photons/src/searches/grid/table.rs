//! The cell table: where the photons of a cell begin.
//!
//! Only occupied segments (rows of sixteen cells) have a line of starts, 64 bytes each. A directory finds the line of
//! a segment: a plain array where the grid is small, a hash table where the photons are few against the cells.
//! Memory: at most 64 + 24 bytes an occupied segment, of which there are no more than photons.

use super::cells::SEGMENT_CELLS;
use std::ops::Range;

const WIDTH: usize = SEGMENT_CELLS as usize;
/// Stands for a segment without photons.
const NONE: u32 = u32::MAX;

/// Starts of the photons of every cell.
#[derive(Debug)]
pub(crate) struct CellTable {
    /// One line an occupied segment in ascending order, and the number of photons after the last.
    starts: Vec<u32>,
    directory: Directory,
}

#[derive(Debug)]
enum Directory {
    /// The line of every segment.
    Dense(Vec<u32>),
    /// Open addressing with linear probing over a power of two of slots, at most half of them taken.
    Hashed { slots: Vec<(u64, u32)>, shift: u32 },
}

/// Fibonacci hashing: the high bits of the product with 2^64 over the golden ratio.
#[inline]
fn hash(segment: u64, shift: u32) -> usize {
    (segment.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> shift) as usize
}

impl CellTable {
    /// The table of photons whose cells are `cells`, ascending; the grid has `segment_count` segments.
    pub(crate) fn new(cells: impl ExactSizeIterator<Item = u64>, segment_count: u64) -> Self {
        let photons = cells.len();
        let mut starts: Vec<u32> = Vec::new();
        let mut segments: Vec<u64> = Vec::new();
        for (slot, cell) in cells.enumerate() {
            let segment = cell / u64::from(SEGMENT_CELLS);
            if segments.last() != Some(&segment) {
                starts.resize(segments.len() * WIDTH, slot as u32);
                segments.push(segment);
            }
            // Cells up to this one begin no later than here.
            let line = (segments.len() - 1) * WIDTH;
            let end = line + (cell % u64::from(SEGMENT_CELLS)) as usize + 1;
            if starts.len() < end {
                starts.resize(end, slot as u32);
            }
        }
        starts.resize(segments.len() * WIDTH + 1, photons as u32);
        let directory = if segment_count <= (photons as u64).max(1024) {
            let mut lines = vec![NONE; segment_count as usize];
            for (line, segment) in (0u32..).zip(&segments) {
                lines[*segment as usize] = line;
            }
            Directory::Dense(lines)
        } else {
            let bits = (segments.len() * 2).next_power_of_two().ilog2().max(1);
            let mut slots = vec![(0, NONE); 1 << bits];
            let shift = 64 - bits;
            for (line, segment) in (0u32..).zip(&segments) {
                let mut at = hash(*segment, shift);
                while slots[at].1 != NONE {
                    at = (at + 1) & (slots.len() - 1);
                }
                slots[at] = (*segment, line);
            }
            Directory::Hashed { slots, shift }
        };
        Self { starts, directory }
    }

    /// Occupied segments.
    pub(crate) fn len(&self) -> usize {
        self.starts.len() / WIDTH
    }

    /// Memory, bytes.
    pub(crate) fn bytes(&self) -> usize {
        let directory = match &self.directory {
            Directory::Dense(lines) => lines.capacity() * size_of::<u32>(),
            Directory::Hashed { slots, .. } => slots.capacity() * size_of::<(u64, u32)>(),
        };
        self.starts.capacity() * size_of::<u32>() + directory
    }

    #[inline]
    fn line(&self, segment: u64) -> Option<usize> {
        match &self.directory {
            Directory::Dense(lines) => match lines[segment as usize] {
                NONE => None,
                line => Some(line as usize),
            },
            Directory::Hashed { slots, shift } => {
                let mut at = hash(segment, *shift);
                loop {
                    match slots[at] {
                        (_, NONE) => return None,
                        (s, line) if s == segment => return Some(line as usize),
                        _ => at = (at + 1) & (slots.len() - 1),
                    }
                }
            }
        }
    }

    /// Photon slots of cells `first..=last` of a segment; empty where there are none.
    #[inline]
    pub(crate) fn slots(&self, segment: u64, first: u32, last: u32) -> Range<u32> {
        match self.line(segment) {
            None => 0..0,
            Some(line) => {
                let at = line * WIDTH;
                self.starts[at + first as usize]..self.starts[at + last as usize + 1]
            }
        }
    }
}
