//! Smooth noise that repeats, so that pictures made from it tile.

use photinus_num::{philox4x32, unit_f32};

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
        self.clouds_at(v, cells, octaves).at(u)
    }

    /// The same for many points of one height: what does not depend on u is worked out once.
    ///
    /// # Panics
    /// With more than [`MOST_OCTAVES`].
    #[inline]
    pub fn clouds_at(&self, v: f32, cells: [i32; 2], octaves: usize) -> Row<'_> {
        assert!(octaves <= MOST_OCTAVES, "{octaves} octaves");
        let mut row =
            Row { lattice: &self.lattice, octaves: [Octave::default(); MOST_OCTAVES], count: octaves, total: 0.0 };
        let (mut weight, mut period) = (1.0, cells);
        for (i, octave) in row.octaves[..octaves].iter_mut().enumerate() {
            let limited = period.map(|p| p.min(CELLS as i32));
            let shift = SHIFT * i;
            let (low, high, t) = cell_of(v * limited[1] as f32, limited[1], shift);
            *octave = Octave { low: low * CELLS, high: high * CELLS, t, period: limited[0], shift, weight };
            row.total += weight;
            weight *= 0.5;
            period = period.map(|p| p * 2);
        }
        row
    }
}

/// How far the lattice is shifted from one octave to the next.
const SHIFT: usize = 17;

/// Most octaves of a sum of noises.
const MOST_OCTAVES: usize = 6;

/// One octave at a height: the rows of the lattice below and above it, and the share of the way between them.
#[derive(Clone, Copy, Default)]
struct Octave {
    low: usize,
    high: usize,
    t: f32,
    period: i32,
    shift: usize,
    weight: f32,
}

/// Octaves of noise along one height of the unit square.
pub struct Row<'a> {
    lattice: &'a [f32; CELLS * CELLS],
    octaves: [Octave; MOST_OCTAVES],
    count: usize,
    total: f32,
}

impl Row<'_> {
    /// The value at `u`.
    #[inline]
    pub fn at(&self, u: f32) -> f32 {
        self.sum(self.octaves[..self.count].iter().map(|o| cell_of(u * o.period as f32, o.period, o.shift)))
    }

    /// The value in a column of a picture, for which `columns` were made.
    #[inline]
    pub fn at_column(&self, columns: &Columns, column: usize) -> f32 {
        let cells = &columns.cells[column * columns.octaves..][..columns.octaves];
        self.sum(cells.iter().map(|&(x0, x1, tx)| (usize::from(x0), usize::from(x1), tx)))
    }

    /// The sum of the octaves at these cells and shares of the ways between them.
    #[inline(always)]
    fn sum(&self, cells: impl Iterator<Item = (usize, usize, f32)>) -> f32 {
        let mut sum = 0.0;
        for (o, (x0, x1, tx)) in self.octaves[..self.count].iter().zip(cells) {
            // The mask says to the compiler what is true already: no index leaves the lattice.
            let value = |row: usize, x: usize| self.lattice[(row + x) & (CELLS * CELLS - 1)];
            let below = value(o.low, x0) * (1.0 - tx) + value(o.low, x1) * tx;
            let above = value(o.high, x0) * (1.0 - tx) + value(o.high, x1) * tx;
            sum += o.weight * (below * (1.0 - o.t) + above * o.t);
        }
        sum / self.total
    }
}

/// Where the columns of a picture lie in noises, the same at all heights: worked out once for a picture.
pub struct Columns {
    octaves: usize,
    cells: Vec<(u8, u8, f32)>,
}

impl Columns {
    /// For columns at these u and noises of so many octaves from so many cells across.
    pub fn new(us: impl Iterator<Item = f32>, cells: i32, octaves: usize) -> Self {
        let of_column = |u: f32| {
            (0..octaves).map(move |i| {
                let period = (cells << i).min(CELLS as i32);
                let (x0, x1, tx) = cell_of(u * period as f32, period, SHIFT * i);
                (x0 as u8, x1 as u8, tx)
            })
        };
        Self { octaves, cells: us.flat_map(of_column).collect() }
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
