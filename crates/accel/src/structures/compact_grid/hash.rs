//! Row displacement: each row of cells is shifted until its cells with primitives fall into gaps of those before it.

use crate::grid::Lists;
use std::ops::Range;

/// Shifts tried for a row before it goes behind all others: so many, or its share of those below.
const MAX_TRIES: usize = 4096;
/// Shifts tried for all rows together, where there are few.
const ALL_TRIES: usize = 1 << 27;

/// Offsets of the lists of cells with primitives, by row and place in the row.
pub(super) struct Rows {
    /// Cells in a row.
    width: usize,
    /// Which cells have primitives, a bit each.
    filled: Vec<u64>,
    /// Place in `starts` of each row's first cell.
    shifts: Vec<u32>,
    /// Where lists start, and one more; in a gap, where the next one does.
    starts: Vec<u32>,
}

fn bit(bits: &[u64], i: usize) -> bool {
    bits[i / 64] >> (i % 64) & 1 == 1
}

fn set(bits: &mut [u64], i: usize) {
    bits[i / 64] |= 1 << (i % 64);
}

impl Rows {
    /// Hashes rows of `width` cells; returns the references in their new order, too.
    pub fn new(lists: &Lists, width: usize) -> (Self, Vec<u32>) {
        let cells = lists.starts.len() - 1;
        let list = |cell: usize| lists.starts[cell] as usize..lists.starts[cell + 1] as usize;
        let mut filled = vec![0u64; cells.div_ceil(64)];
        let rows: Vec<Vec<u32>> = (0..cells / width)
            .map(|row| (0..width).filter(|x| !list(row * width + x).is_empty()).map(|x| x as u32).collect())
            .collect();
        // Full rows first: the others are short enough for the gaps.
        let mut order: Vec<usize> = (0..rows.len()).filter(|row| !rows[*row].is_empty()).collect();
        order.sort_by_key(|row| std::cmp::Reverse(rows[*row].len()));
        let max_tries = MAX_TRIES.max(ALL_TRIES / order.len().max(1));
        let mut table = Table { owners: Vec::new(), gap: 0, max_tries };
        let mut shifts = vec![0; rows.len()];
        for row in order {
            shifts[row] = table.place(&rows[row], (row * width) as u32);
            for x in &rows[row] {
                set(&mut filled, row * width + *x as usize);
            }
        }
        let mut starts = Vec::with_capacity(table.owners.len() + 1);
        let mut refs = Vec::with_capacity(lists.refs.len());
        for owner in table.owners {
            starts.push(refs.len() as u32);
            if owner != FREE {
                refs.extend(&lists.refs[list(owner as usize)]);
            }
        }
        starts.push(refs.len() as u32);
        (Self { width, filled, shifts, starts }, refs)
    }

    /// Places of a cell's list in the references.
    #[inline(always)]
    pub fn list(&self, row: usize, x: usize) -> Range<usize> {
        if !bit(&self.filled, row * self.width + x) {
            return 0..0;
        }
        // Shifts may be negative, and wrap: the sum does not.
        let place = self.shifts[row].wrapping_add(x as u32) as usize;
        self.starts[place] as usize..self.starts[place + 1] as usize
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.filled[..]) + size_of_val(&self.shifts[..]) + size_of_val(&self.starts[..])
    }
}

/// The owner of a place without one.
const FREE: u32 = u32::MAX;

/// Places of the hash table with the cells that own them.
struct Table {
    owners: Vec<u32>,
    /// No place before this is free.
    gap: usize,
    /// Shifts tried for a row.
    max_tries: usize,
}

impl Table {
    /// Finds room for the cells of a row at `places` and returns its shift; `first` is the id of its first cell.
    fn place(&mut self, places: &[u32], first: u32) -> u32 {
        let lead = places[0];
        let fits = |at: usize| {
            places.iter().all(|x| self.owners.get(at + (x - lead) as usize).is_none_or(|owner| *owner == FREE))
        };
        let tries = self.gap..self.owners.len().min(self.gap + self.max_tries);
        let at = tries.into_iter().find(|at| fits(*at)).unwrap_or(self.owners.len());
        let end = at + (places[places.len() - 1] - lead) as usize + 1;
        if end > self.owners.len() {
            self.owners.resize(end, FREE);
        }
        for x in places {
            self.owners[at + (x - lead) as usize] = first + x;
        }
        while self.gap < self.owners.len() && self.owners[self.gap] != FREE {
            self.gap += 1;
        }
        (at as u32).wrapping_sub(lead)
    }
}
