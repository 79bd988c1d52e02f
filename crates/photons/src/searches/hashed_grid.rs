//! A grid whose cells are found by hashing, so that empty space costs nothing: Teschner, Heidelberger, Mueller,
//! Pomeranets, Gross, "Optimized Spatial Hashing for Collision Detection of Deformable Objects", VMV 2003, with cells told
//! apart by their places instead of left to collide.

use crate::Photon;
use crate::index::{Index, Indexed, Scan};
use crate::space::usual_radius;
use photinus_geometry::{Aabb, Vec3};

pub(crate) const ABOUT: &str = "hashed grid, cells of about a gather radius";

/// Bits of a cell's place along an axis.
const PLACE_BITS: u32 = 21;
/// Last place along an axis.
const LAST: i64 = (1 << PLACE_BITS) - 1;

/// A cell that holds photons.
struct Cell {
    key: u64,
    first: u32,
    count: u32,
    /// The box of its photons.
    bounds: Aabb,
}

/// The grid.
pub(crate) struct HashedGrid {
    origin: Vec3,
    size: f64,
    cells: Vec<Cell>,
    /// Open addressing: one more than a cell's index, or zero; a power of two long.
    table: Vec<u32>,
}

impl HashedGrid {
    /// The search over some photons, for balls of about this radius; by default of the size that holds some dozens.
    pub(crate) fn build(photons: &[Photon], radius: Option<f32>) -> Indexed<Self> {
        let bounds = Aabb::around(photons.iter().map(Photon::position));
        let size = f64::from(radius.unwrap_or_else(|| usual_radius(&bounds, photons.len())));
        // Cells that places can tell apart.
        let size = size.max(f64::from(bounds.size().max_element()) / LAST as f64).max(f64::from(f32::MIN_POSITIVE));
        let mut grid = Self { origin: bounds.min, size, cells: Vec::new(), table: Vec::new() };
        let mut keyed: Vec<(u64, u32)> =
            (0..).zip(photons).map(|(id, photon)| (key(grid.place(photon.position())), id)).collect();
        keyed.sort_unstable();
        for run in keyed.chunk_by(|a, b| a.0 == b.0) {
            let first = grid.cells.last().map_or(0, |cell| cell.first + cell.count);
            let bounds = Aabb::around(run.iter().map(|(_, id)| photons[*id as usize].position()));
            grid.cells.push(Cell { key: run[0].0, first, count: run.len() as u32, bounds });
        }
        grid.table = vec![0; (2 * grid.cells.len()).next_power_of_two()];
        for (i, cell) in (1..).zip(&grid.cells) {
            let mut slot = grid.slot(cell.key);
            while grid.table[slot] != 0 {
                slot = (slot + 1) % grid.table.len();
            }
            grid.table[slot] = i;
        }
        Indexed::new(photons, (grid, keyed.into_iter().map(|(_, id)| id).collect()))
    }

    /// The cell that a point lies in; beyond the grid the next.
    #[inline]
    fn place(&self, p: Vec3) -> [i64; 3] {
        std::array::from_fn(|axis| {
            let at = (f64::from(p[axis]) - f64::from(self.origin[axis])) / self.size;
            // A float beyond all whole numbers becomes the last.
            (at.floor() as i64).clamp(0, LAST)
        })
    }

    /// Where the search for a key in the table begins.
    #[inline]
    fn slot(&self, key: u64) -> usize {
        // Multiplication by the golden ratio (Knuth, The Art of Computer Programming 3, section 6.4).
        (key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32) as usize & (self.table.len() - 1)
    }

    /// The cell of a key, if it holds photons.
    #[inline]
    fn find(&self, key: u64) -> Option<&Cell> {
        let mut slot = self.slot(key);
        loop {
            let cell = &self.cells[self.table[slot].checked_sub(1)? as usize];
            if cell.key == key {
                return Some(cell);
            }
            slot = (slot + 1) % self.table.len();
        }
    }
}

/// One number for a place.
#[inline]
fn key(place: [i64; 3]) -> u64 {
    place.iter().fold(0, |key, at| key << PLACE_BITS | *at as u64)
}

/// The place of a key.
#[inline]
fn place_of(key: u64) -> [i64; 3] {
    std::array::from_fn(|axis| (key >> (PLACE_BITS * (2 - axis as u32))) as i64 & LAST)
}

/// Tests a cell's photons.
#[inline]
fn visit(cell: &Cell, scan: &mut impl Scan) {
    if !scan.is_out_of_reach(scan.reach(&cell.bounds)) {
        scan.run(cell.first as usize..(cell.first + cell.count) as usize);
    }
}

impl Index for HashedGrid {
    const NAME: &'static str = "hashed-grid";

    fn search(&self, scan: &mut impl Scan) {
        let middle = self.place(scan.middle());
        // Shells of cells around the middle's. In shell n nothing is nearer than n - 1 cells; a squared distance in floats
        // may be smaller by a few roundings, or of the least floats.
        for shell in 0.. {
            let least = self.size * (shell - 1).max(0) as f64;
            if least * least * (1.0 - 1e-6) - 1e-44 > f64::from(scan.limit()) {
                return;
            }
            let [low, high] = [middle.map(|at| (at - shell).max(0)), middle.map(|at| (at + shell).min(LAST))];
            let side = (2 * shell + 1) as usize;
            if side.pow(3) > 4 * self.cells.len() {
                // Far fewer cells hold photons than the shells so far have: all that are left, in no order.
                for cell in &self.cells {
                    let place = place_of(cell.key);
                    if (0..3).any(|axis| (place[axis] - middle[axis]).abs() >= shell) {
                        visit(cell, scan);
                    }
                }
                return;
            }
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    let is_face = (x - middle[0]).abs() == shell || (y - middle[1]).abs() == shell;
                    let step = if is_face || shell == 0 { 1 } else { 2 * shell };
                    let mut z = if is_face { low[2] } else { middle[2] - shell };
                    while z <= high[2] {
                        if z >= low[2]
                            && let Some(cell) = self.find(key([x, y, z]))
                        {
                            visit(cell, scan);
                        }
                        z += step;
                    }
                }
            }
        }
    }

    fn bytes(&self) -> usize {
        self.cells.capacity() * size_of::<Cell>() + self.table.capacity() * size_of::<u32>()
    }
}
