//! Smooth noise that repeats, so that pictures made from it tile.

use photinus_num::{philox4x32, unit_f32};
use std::ops::Range;

/// Cells of the lattice along each side; also the largest period.
const CELLS: usize = 64;

/// A field of smooth random values in 0..1.
pub struct Noise {
    lattice: Box<[f32; CELLS * CELLS]>,
}

impl Noise {
    /// The field of this number.
    pub fn new(number: u32) -> Self {
        let word = |i: usize| philox4x32([i as u32, number, 0, 0], [0x7153_0A11, 0xC0FF_EE05])[0];
        Self { lattice: Box::new(std::array::from_fn(|i| unit_f32(word(i)))) }
    }

    /// A random value for a cell.
    pub fn cell(&self, x: i64, y: i64) -> f32 {
        let wrap = |i: i64| i.rem_euclid(CELLS as i64) as usize;
        self.lattice[wrap(y) * CELLS + wrap(x)]
    }

    /// Octaves of noise at (u, v) in the unit square, starting with these numbers of cells; about 0 to 1, mean 0.5.
    pub fn clouds(&self, u: f32, v: f32, cells: [i32; 2], octaves: usize) -> f32 {
        let (mut sum, mut total) = (0.0, 0.0);
        for Octave { periods: [columns, rows], shift, weight } in Octave::several(cells, octaves) {
            let (x0, x1, tx) = cell_of(u * columns as f32, columns, shift);
            let (y0, y1, ty) = cell_of(v * rows as f32, rows, shift);
            // The mask says to the compiler what is true already: no index leaves the lattice.
            let value = |y: usize, x: usize| self.lattice[(y * CELLS + x) & (CELLS * CELLS - 1)];
            let below = value(y0, x0) * (1.0 - tx) + value(y0, x1) * tx;
            let above = value(y1, x0) * (1.0 - tx) + value(y1, x1) * tx;
            sum += weight * (below * (1.0 - ty) + above * ty);
            total += weight;
        }
        sum / total
    }

    /// The same for the columns of a picture, which lie at these u.
    pub fn sheet(&self, us: impl Iterator<Item = f32> + Clone, cells: [i32; 2], octaves: usize) -> Sheet {
        let width = us.clone().count();
        let layer = |Octave { periods: [columns, rows], shift, weight }| {
            let places: Vec<_> = us.clone().map(|u| cell_of(u * columns as f32, columns, shift)).collect();
            let line = |row: i32| {
                let values: &[f32] = &self.lattice[(row as usize + shift) % CELLS * CELLS..][..CELLS];
                places.iter().map(|&(x0, x1, tx)| values[x0] * (1.0 - tx) + values[x1] * tx)
            };
            Layer { lines: (0..rows).flat_map(line).collect(), rows, weight }
        };
        Sheet { width, layers: Octave::several(cells, octaves).map(layer).collect() }
    }
}

/// How far the lattice is shifted from one octave to the next.
const SHIFT: usize = 17;

/// One of several noises that are added: each has twice the cells of the one before and half its weight.
struct Octave {
    /// Cells across and up before it repeats.
    periods: [i32; 2],
    shift: usize,
    weight: f32,
}

impl Octave {
    fn several(cells: [i32; 2], count: usize) -> impl Iterator<Item = Self> {
        let limited = move |i: usize| cells.map(|cells| (cells << i).min(CELLS as i32));
        (0..count).map(move |i| Self { periods: limited(i), shift: SHIFT * i, weight: 1.0 / (1 << i) as f32 })
    }
}

/// Octaves of noise for the columns of a picture. A row of the lattice serves many rows of the picture: its values in
/// the columns are worked out once, and what is left for each height reads memory in order.
pub struct Sheet {
    width: usize,
    layers: Vec<Layer>,
}

/// One octave of a [`Sheet`].
struct Layer {
    /// Values in the columns, a line for each row of the lattice.
    lines: Vec<f32>,
    rows: i32,
    weight: f32,
}

impl Sheet {
    /// The noise along height `v`, in all columns.
    pub fn along(&self, v: f32) -> Vec<f32> {
        self.part_along(v, 0..self.width)
    }

    /// The noise along height `v`, in these columns.
    pub fn part_along(&self, v: f32, columns: Range<usize>) -> Vec<f32> {
        let mut sums = vec![0.0; columns.len()];
        for Layer { lines, rows, weight } in &self.layers {
            let (low, high, t) = cell_of(v * *rows as f32, *rows, 0);
            let line = |row: usize| &lines[row * self.width..][columns.clone()];
            for ((sum, below), above) in sums.iter_mut().zip(line(low)).zip(line(high)) {
                *sum += weight * (below * (1.0 - t) + above * t);
            }
        }
        let total: f32 = self.layers.iter().map(|layer| layer.weight).sum();
        sums.iter_mut().for_each(|sum| *sum /= total);
        sums
    }
}

/// The cell below `x`, the next one, and the smoothed share of the way between them.
#[inline]
fn cell_of(x: f32, period: i32, shift: usize) -> (usize, usize, f32) {
    // As `super::floor`, of which the integer is wanted too.
    let cut = x as i32;
    let floor = cut - i32::from(x < cut as f32);
    let t = x - floor as f32;
    let wrap = |i: i32| if (0..period).contains(&i) { i } else { i.rem_euclid(period) };
    let place = |i: i32| (wrap(i) as usize + shift) % CELLS;
    (place(floor), place(floor + 1), t * t * (3.0 - 2.0 * t))
}
