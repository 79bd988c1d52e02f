//! Sums of the nearest photons where all weigh the same: exact, so that the order in which they are made does not matter.
//!
//! A flux has ten bits but for its octave. Sums in f64 are exact as long as the octaves of 2^n photons span 43 - n; those
//! in whole numbers, of which vectors hold twice as many, as long as [`Octaves::fit`] says. Both are rounded to f32 once,
//! and so are the same. Photons that neighbours share are summed as whole numbers where they fit, else in f64 in the
//! order in which a query alone sums them.

use super::blocks::{Block, LANES};
use super::kernels::Selected;
use crate::Gathered;
use crate::flux::{PLACED_UNITS, octave, placed_mantissas, raw_scale, whole_unit};
use photinus_geometry::Vec3;

/// Flux in f64 by lane.
#[derive(Default)]
pub(super) struct EvenSums {
    flux: [[f64; LANES]; 3],
    count: u32,
}

impl EvenSums {
    /// Adds a flux, where it is found: mantissas in their places, and raw scale.
    #[inline(always)]
    pub(super) fn add(&mut self, lane: usize, is_found: bool, mantissas: [f32; 3], scale: f32) {
        for (sum, mantissa) in self.flux.iter_mut().zip(mantissas) {
            // The product is exact: ten bits.
            sum[lane] += if is_found { f64::from(mantissa * scale) } else { 0.0 };
        }
        self.count += u32::from(is_found);
    }

    /// The sums, rounded.
    #[inline(always)]
    pub(super) fn gathered(self) -> Gathered {
        let units = PLACED_UNITS.to_array();
        let rounded = std::array::from_fn(|c| (self.flux[c].iter().sum::<f64>() * f64::from(units[c])) as f32);
        Gathered { flux: Vec3::from_array(rounded), count: self.count }
    }
}

/// Sums the photons that were found up to a squared distance.
#[inline(always)]
pub(super) fn gather_selected(blocks: &[Block], selected: &[Selected], r2: f32) -> Gathered {
    let mut sums = EvenSums::default();
    for Selected { block, lanes, distances_sq } in selected {
        let block = &blocks[*block as usize];
        for lane in 0..LANES {
            let is_found = (lanes >> lane & 1 != 0) & (distances_sq[lane] <= r2);
            let word = block.flux[lane];
            sums.add(lane, is_found, placed_mantissas(word).to_array(), raw_scale(word));
        }
    }
    sums.gathered()
}

/// Between which octaves the fluxes of photons lie.
#[derive(Clone, Copy, Debug)]
pub(super) struct Octaves {
    pub(super) least: u32,
    pub(super) most: u32,
}

impl Octaves {
    /// Those of no photons, and of black ones.
    pub(super) const NONE: Self = Self { least: u32::MAX, most: 0 };

    /// With one more flux.
    #[inline(always)]
    pub(super) fn with(self, word: u32) -> Self {
        let octave = octave(word);
        // Black is of none.
        Self { least: if octave > 0 { self.least.min(octave) } else { self.least }, most: self.most.max(octave) }
    }

    /// Whether sums of so many are below 2^32 in units of the least.
    #[inline(always)]
    pub(super) fn fit(self, count: usize) -> bool {
        let span = self.most.saturating_sub(self.least);
        // Of the least octave fluxes are up to 255 times 2 or 3 units.
        span < 32 && (count as u64).saturating_mul(255 * 3) <= u64::from(u32::MAX) >> span
    }
}

/// Sums in units of an octave, rounded.
#[inline(always)]
pub(super) fn rounded(sums: [u32; 3], least: u32, count: u32) -> Gathered {
    let unit = whole_unit(least);
    Gathered { flux: Vec3::from_array(sums.map(|sum| (f64::from(sum) * unit) as f32)), count }
}
