//! Smooth noise that repeats, so that pictures made from it tile.

use photinus_num::{philox4x32, unit_f32};

/// Cells of the lattice along each side; also the largest period.
const CELLS: usize = 64;

/// A field of smooth random values in 0..1.
pub struct Noise {
    lattice: Vec<f32>,
}

impl Noise {
    /// The field of this number.
    pub fn new(number: u32) -> Self {
        let word = |i: usize| philox4x32([i as u32, number, 0, 0], [0x7153_0A11, 0xC0FF_EE05])[0];
        Self { lattice: (0..CELLS * CELLS).map(|i| unit_f32(word(i))).collect() }
    }

    /// A random value for a cell.
    pub fn cell(&self, x: i64, y: i64) -> f32 {
        let wrap = |i: i64| i.rem_euclid(CELLS as i64) as usize;
        self.lattice[wrap(y) * CELLS + wrap(x)]
    }

    /// The value at (x, y) in cells, at most 64 of which repeat; `shift` picks another part of the lattice.
    fn at(&self, x: f32, y: f32, period: [i32; 2], shift: usize) -> f32 {
        let ((x0, x1, tx), (y0, y1, ty)) = (cell_of(x, period[0], shift), cell_of(y, period[1], shift));
        let (low, high) = (&self.lattice[y0 * CELLS..][..CELLS], &self.lattice[y1 * CELLS..][..CELLS]);
        let below = low[x0] * (1.0 - tx) + low[x1] * tx;
        let above = high[x0] * (1.0 - tx) + high[x1] * tx;
        below * (1.0 - ty) + above * ty
    }

    /// Octaves of noise at (u, v) in the unit square, starting with these numbers of cells; about 0 to 1, mean 0.5.
    pub fn clouds(&self, u: f32, v: f32, cells: [i32; 2], octaves: usize) -> f32 {
        let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
        let mut period = cells;
        for octave in 0..octaves {
            let limited = period.map(|p| p.min(CELLS as i32));
            sum += weight * self.at(u * limited[0] as f32, v * limited[1] as f32, limited, 17 * octave);
            total += weight;
            weight *= 0.5;
            period = period.map(|p| p * 2);
        }
        sum / total
    }
}

/// The cell below `x`, the next one, and the smoothed share of the way between them.
fn cell_of(x: f32, period: i32, shift: usize) -> (usize, usize, f32) {
    // The floor by conversion: the function is a slow call on machines without the instruction.
    let cut = x as i32;
    let floor = cut - i32::from(x < cut as f32);
    let t = x - floor as f32;
    let wrap = |i: i32| if (0..period).contains(&i) { i } else { i.rem_euclid(period) };
    let place = |i: i32| (wrap(i) as usize + shift) % CELLS;
    (place(floor), place(floor + 1), t * t * (3.0 - 2.0 * t))
}
