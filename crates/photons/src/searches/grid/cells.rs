//! The geometry of the grid: which cell holds a point, the order of the cells, and which cells a ball may touch.
//!
//! Cells are a little more than two gather radii wide, so that a ball meets two along each axis. Each is cut into
//! 8 x 8 x 8 fine cells. Photons are in the Morton order (Morton 1966) of their cells and, inside a cell, in the Hilbert
//! order (Hilbert 1891) of the fine cells: neighbours in memory are neighbours in space.

use photinus_geometry::{Aabb, Vec3};

/// Fine cells along the edge of a cell, as a power of two.
const FINE_LEVELS: u32 = 3;
const FINE: f32 = (1u32 << FINE_LEVELS) as f32;
/// Fine cells of a cell.
const FINE_CELLS: usize = 1 << (3 * FINE_LEVELS);
/// Edge of a cell in gather radii: two, and room for rounding.
const EDGE_IN_RADII: f32 = 2.02;
/// Bits of a fine cell along an axis: its place is exact to a quarter of a fine cell, and three fit a key.
const AXIS_BITS: u32 = 21;
/// Bits of a quarter of a fine cell along an axis in a key of queries: three and three bits more fit one.
const NEIGHBOURHOOD_BITS: u32 = 20;
/// Least edge of a fine cell, scene units: photons closer than 1e-18 have a squared distance that underflows, so that
/// they may be found at any radius; that must be far less than a fine cell.
const MIN_FINE_EDGE: f64 = 1e-15;
/// Relative error of a place in fine cells, with a margin: one subtraction and one product of f32 make 2^-23.
const PLACE_SLACK: f32 = 1.0 / (1u32 << 21) as f32;
/// Relative error of a squared distance and of the radius in fine cells, with a margin: about 2^-22.
const RADIUS_SLACK: f32 = 1.0 / (1u32 << 19) as f32;
/// What underflow may add to a distance, in fine cells.
const UNDERFLOW_SLACK: f32 = 1.0 / 512.0;
/// A ball of more fine cells than this is not worth cells; f32 counts so far without gaps.
const MAX_RADIUS: f32 = (1u32 << 22) as f32;

/// A uniform grid over the photons' box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cells {
    min: Vec3,
    max: Vec3,
    /// Fine cells a scene unit.
    inv_edge: f32,
    /// Fine cells along each axis.
    fine_count: Vec3,
    /// Cells along each axis.
    count: [u32; 3],
}

/// Cells from the first to the last along each axis.
pub(crate) type CellBox = [[u32; 2]; 3];

impl Cells {
    /// A grid for gather radii of `radius` (positive) over the box of the photons, with larger cells where the box is
    /// more than 2^21 fine cells long.
    pub(crate) fn new(bounds: Aabb, radius: f32) -> Self {
        let bounds = if bounds.is_empty() { Aabb { min: Vec3::ZERO, max: Vec3::ZERO } } else { bounds };
        let size = bounds.size();
        let edge = f64::from(radius) * f64::from(EDGE_IN_RADII / FINE);
        let edge = edge.max(MIN_FINE_EDGE).max(f64::from(size.max_element()) / f64::from((1 << AXIS_BITS) - 2));
        let inv_edge = (1.0 / edge) as f32;
        let fine_count = (size * inv_edge).floor() + 1.0;
        let count = fine_count.to_array().map(|fine| ((fine as u32 - 1) >> FINE_LEVELS) + 1);
        Self { min: bounds.min, max: bounds.max, inv_edge, fine_count, count }
    }

    /// Place of a point in units of fine cells; monotone along each axis.
    #[inline]
    pub(crate) fn place(&self, p: Vec3) -> Vec3 {
        (p - self.min) * self.inv_edge
    }

    /// Bits of a key.
    pub(crate) fn key_bits(&self) -> u32 {
        let bits = self.fine_count.to_array().map(|fine| 32 - (fine as u32 - 1).leading_zeros());
        // The order inside a cell needs all bits of its fine cells.
        3 * bits.into_iter().max().unwrap_or(0).max(FINE_LEVELS)
    }

    /// Key of the fine cell of a point inside the box.
    #[inline]
    pub(crate) fn key(&self, p: Vec3) -> u64 {
        let [x, y, z] = self.place(p).to_array().map(|u| spread(u as u64));
        let morton = x | y << 1 | z << 2;
        let fine = morton & (FINE_CELLS as u64 - 1);
        morton - fine + u64::from(HILBERT[fine as usize])
    }

    /// Bits of a key for the order of queries.
    pub(crate) fn order_bits(&self) -> u32 {
        self.key_bits() - 3 * (FINE_LEVELS - 1)
    }

    /// A key for the order of queries: the Morton key of the half cell, or of the nearest one.
    #[inline]
    pub(crate) fn order(&self, p: Vec3) -> u64 {
        // Casts take NaN and what is below zero to zero.
        let place = self.place(p).min(self.fine_count - 1.0) * (2.0 / FINE);
        let [x, y, z] = place.to_array().map(|u| spread(u as u64));
        x | y << 1 | z << 2
    }

    /// A key that sorts queries by their neighbourhoods: by fine cells in Morton order, in each by the half-axis that their
    /// normals are nearest to, then by quarters of the fine cell.
    #[inline]
    pub(crate) fn neighbourhood(&self, position: Vec3, normal: Vec3) -> u64 {
        let [x, y, z] = self.quarters(position).map(spread);
        let morton = x | y << 1 | z << 2;
        (morton >> 6) << 9 | half_axis(normal) << 6 | morton & 63
    }

    /// The same numbers for queries of the same fine cell and half-axis only.
    #[inline]
    pub(crate) fn fine_cell(&self, position: Vec3, normal: Vec3) -> u64 {
        let [x, y, z] = self.quarters(position).map(|u| u >> 2);
        (x | y << NEIGHBOURHOOD_BITS | z << (2 * NEIGHBOURHOOD_BITS)) << 3 | half_axis(normal)
    }

    /// Where a point lies in quarters of fine cells; points far outside the box are in the same place.
    #[inline]
    fn quarters(&self, position: Vec3) -> [u64; 3] {
        // Casts take NaN and what is below zero to zero.
        self.place(position).to_array().map(|u| u64::from((u * 4.0) as u32).min((1 << NEIGHBOURHOOD_BITS) - 1))
    }

    /// Index of the cell of a key.
    #[inline]
    pub(crate) fn cell_of_key(&self, key: u64) -> u64 {
        let key = key >> (3 * FINE_LEVELS);
        self.cell([compact(key), compact(key >> 1), compact(key >> 2)])
    }

    /// Whether two keys are of one cell.
    #[inline]
    pub(crate) fn same_cell(a: u64, b: u64) -> bool {
        (a ^ b) >> (3 * FINE_LEVELS) == 0
    }

    /// Index of the cell of these coordinates.
    #[inline]
    pub(crate) fn cell(&self, [x, y, z]: [u32; 3]) -> u64 {
        (u64::from(z) * u64::from(self.count[1]) + u64::from(y)) * u64::from(self.count[0]) + u64::from(x)
    }

    /// The lower corner, in fine cells, of the half cell (half as long as a cell) around a place: balls of equal
    /// radius around places of one half cell are given the same cells.
    #[inline]
    pub(crate) fn half_cell(place: Vec3) -> Vec3 {
        // Casts where `floor` would be a call for each component on the oldest processors. Beyond the range of i32 they
        // stay at its ends, which are out of reach of any cell, too.
        let half_cells = place * (2.0 / FINE);
        let down = |u: f32| {
            let toward_zero = u as i32 as f32;
            if toward_zero > u { toward_zero - 1.0 } else { toward_zero }
        };
        Vec3::new(down(half_cells.x), down(half_cells.y), down(half_cells.z)) * (FINE / 2.0)
    }

    /// A radius in fine cells, with a margin for rounding.
    #[inline]
    pub(crate) fn radius(&self, radius: f32) -> f32 {
        radius * self.inv_edge * (1.0 + RADIUS_SLACK) + UNDERFLOW_SLACK
    }

    /// The cells that balls of `radius` fine cells around the places of a half cell may touch.
    #[inline]
    pub(crate) fn reached(&self, half_cell: Vec3, radius: f32) -> Reached {
        if !(radius < MAX_RADIUS) {
            return Reached::Everything;
        }
        let slack = (half_cell.abs() + self.fine_count + FINE) * PLACE_SLACK + radius;
        let low = (half_cell - slack) * (1.0 / FINE);
        let high = (half_cell + (FINE / 2.0) + slack) * (1.0 / FINE);
        let mut cells = [[0; 2]; 3];
        for axis in 0..3 {
            let count = self.count[axis];
            // A place that overflowed gives NaN or infinity, and is farther away than the radius.
            if !(high[axis] >= 0.0 && low[axis] < count as f32) {
                return Reached::Nothing;
            }
            cells[axis] = [low[axis] as u32, (high[axis] as u32).min(count - 1)];
        }
        Reached::Cells(cells)
    }

    /// A radius around `position` that holds about `k` photons on an even surface, `photons_a_cell` in every cell
    /// that it crosses; from outside the box it reaches in.
    pub(crate) fn reach(&self, position: Vec3, k: usize, photons_a_cell: f32) -> f32 {
        let cells = (1.3 * k as f32 / (std::f32::consts::PI * photons_a_cell)).sqrt();
        let to_box = (position - position.clamp(self.min, self.max)).length();
        (cells * FINE / self.inv_edge + to_box).max(f32::MIN_POSITIVE)
    }
}

/// The half-axis that a normal is nearest to: twice the axis, one more below.
#[inline]
fn half_axis(normal: Vec3) -> u64 {
    let size = normal.abs();
    // Without branches: normals of neighbouring queries may differ.
    let is_x = (size.x > size.y) & (size.x > size.z);
    let is_z = !is_x & (size.z >= size.y);
    let axis = u64::from(!is_x) + u64::from(is_z);
    let below = u64::from(normal.cmplt(Vec3::ZERO).bitmask());
    2 * axis + (below >> axis & 1)
}

/// What [`Cells::reached`] found.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Reached {
    /// No cell.
    Nothing,
    /// These cells.
    Cells(CellBox),
    /// More cells than are worth counting.
    Everything,
}

/// Place on the Hilbert curve through a cell, by the Morton index of the fine cell: the transform of Skilling,
/// "Programming the Hilbert curve" (AIP Conference Proceedings 707, 2004).
static HILBERT: [u16; FINE_CELLS] = hilbert_table();

const fn hilbert_table() -> [u16; FINE_CELLS] {
    let mut table = [0; FINE_CELLS];
    let mut morton = 0;
    while morton < FINE_CELLS {
        table[morton] = hilbert_index(morton);
        morton += 1;
    }
    table
}

const fn hilbert_index(morton: usize) -> u16 {
    let mut x = [0usize; 3];
    let mut bit = 0;
    while bit < 3 * FINE_LEVELS {
        x[bit as usize % 3] |= (morton >> bit & 1) << (bit / 3);
        bit += 1;
    }
    // Undo the excess work of the lower levels, from the highest bit down.
    let mut level = FINE_LEVELS - 1;
    while level > 0 {
        let below = (1 << level) - 1;
        let mut axis = 0;
        while axis < 3 {
            if x[axis] >> level & 1 == 1 {
                x[0] ^= below;
            } else {
                let swap = (x[0] ^ x[axis]) & below;
                x[0] ^= swap;
                x[axis] ^= swap;
            }
            axis += 1;
        }
        level -= 1;
    }
    // Gray encode.
    x[1] ^= x[0];
    x[2] ^= x[1];
    let mut flip = 0;
    level = FINE_LEVELS - 1;
    while level > 0 {
        if x[2] >> level & 1 == 1 {
            flip ^= (1 << level) - 1;
        }
        level -= 1;
    }
    // The index takes a bit of each axis in turn, the first axis highest.
    let mut index = 0;
    level = FINE_LEVELS;
    while level > 0 {
        level -= 1;
        let mut axis = 0;
        while axis < 3 {
            index = index << 1 | (x[axis] ^ flip) >> level & 1;
            axis += 1;
        }
    }
    index as u16
}

/// The low 21 bits of `v`, each followed by two zeros.
#[inline]
fn spread(v: u64) -> u64 {
    let v = v & 0x1F_FFFF;
    let v = (v | v << 32) & 0x001F_0000_0000_FFFF;
    let v = (v | v << 16) & 0x001F_0000_FF00_00FF;
    let v = (v | v << 8) & 0x100F_00F0_0F00_F00F;
    let v = (v | v << 4) & 0x10C3_0C30_C30C_30C3;
    (v | v << 2) & 0x1249_2492_4924_9249
}

/// Every third bit of `v` from the lowest: undoes [`spread`].
#[inline]
fn compact(v: u64) -> u32 {
    let v = v & 0x1249_2492_4924_9249;
    let v = (v | v >> 2) & 0x10C3_0C30_C30C_30C3;
    let v = (v | v >> 4) & 0x100F_00F0_0F00_F00F;
    let v = (v | v >> 8) & 0x001F_0000_FF00_00FF;
    let v = (v | v >> 16) & 0x001F_0000_0000_FFFF;
    ((v | v >> 32) & 0x1F_FFFF) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each fine cell once, and every step along the curve goes to one of the six next to it.
    #[test]
    fn the_curve_visits_all_fine_cells_in_unit_steps() {
        let mut places = [[u32::MAX; 3]; FINE_CELLS];
        for morton in 0..FINE_CELLS as u64 {
            places[usize::from(HILBERT[morton as usize])] =
                [compact(morton), compact(morton >> 1), compact(morton >> 2)];
        }
        assert!(places.iter().flatten().all(|c| *c < 1 << FINE_LEVELS));
        for pair in places.windows(2) {
            let steps: u32 = (0..3).map(|axis| pair[0][axis].abs_diff(pair[1][axis])).sum();
            assert_eq!(steps, 1, "{pair:?}");
        }
    }

    #[test]
    fn bits_are_spread_as_the_loop_says() {
        for v in [0u64, 1, 2, 0x1F_FFFF, 0x15_5555, 0x0A_BCDE, 0x10_0001] {
            let slow = (0..21).fold(0u64, |sum, bit| sum | (v >> bit & 1) << (3 * bit));
            assert_eq!(spread(v), slow);
            assert_eq!(u64::from(compact(slow | slow << 1)), v);
        }
    }
}
