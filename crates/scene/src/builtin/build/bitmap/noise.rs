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

    /// The value at (x, y) in cells; repeats every `period` cells, at most 64.
    fn at(&self, x: f32, y: f32, period: [i64; 2]) -> f32 {
        let (fx, fy) = (x.floor(), y.floor());
        let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
        let (tx, ty) = (smooth(x - fx), smooth(y - fy));
        let wrap = |i: f32, period: i64| (i as i32).rem_euclid(period as i32) as usize;
        let (x0, x1) = (wrap(fx, period[0]), wrap(fx + 1.0, period[0]));
        let (y0, y1) = (CELLS * wrap(fy, period[1]), CELLS * wrap(fy + 1.0, period[1]));
        let low = self.lattice[y0 + x0] * (1.0 - tx) + self.lattice[y0 + x1] * tx;
        let high = self.lattice[y1 + x0] * (1.0 - tx) + self.lattice[y1 + x1] * tx;
        low * (1.0 - ty) + high * ty
    }

    /// Octaves of noise at (u, v) in the unit square, starting with these numbers of cells; about 0 to 1, mean 0.5.
    pub fn clouds(&self, u: f32, v: f32, cells: [i64; 2], octaves: u32) -> f32 {
        let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
        let mut period = cells;
        for octave in 0..octaves {
            let shift = octave as f32 * 17.0;
            let limited = period.map(|p| p.min(CELLS as i64));
            sum += weight * self.at(u * limited[0] as f32 + shift, v * limited[1] as f32 + shift, limited);
            total += weight;
            weight *= 0.5;
            period = period.map(|p| p * 2);
        }
        sum / total
    }
}
