//! Which directions of the sky the visible surfaces see: what is blocked from everywhere is hardly worth a sample.

use photinus_geometry::Vec3;
use std::f32::consts::TAU;

const COLUMNS: usize = 32;
const ROWS: usize = 16;

/// How often rays from visible surfaces reach the sky, by direction, in bins of equal solid angle, and how often they end
/// on surfaces that emit.
#[derive(Clone, Debug)]
pub(crate) struct SkyView {
    escapes: Vec<u32>,
    rays: u32,
    lamps: u32,
}

impl SkyView {
    /// Bins of equal solid angle.
    pub const BINS: usize = COLUMNS * ROWS;

    /// Nothing seen yet.
    pub fn new() -> Self {
        Self { escapes: vec![0; Self::BINS], rays: 0, lamps: 0 }
    }

    /// Counts a ray, cosine-distributed from a surface, that did or did not reach the sky along `dir`.
    pub fn add(&mut self, dir: Vec3, escaped: bool) {
        self.rays += 1;
        if escaped {
            self.escapes[Self::bin(dir)] += 1;
        }
    }

    /// Counts a ray that ended on a surface that emits.
    pub fn add_lamp(&mut self) {
        self.rays += 1;
        self.lamps += 1;
    }

    /// Whether lamps cover so much of the view that chance finds them about as well as a shadow ray does: more than one ray
    /// in twenty ends there.
    pub fn lamps_are_wide(&self) -> bool {
        20 * u64::from(self.lamps) > u64::from(self.rays)
    }

    /// Share of the rays that reached the sky, at least 2 %: a window may be missed by all of them.
    pub fn openness(&self) -> f64 {
        let escaped: u32 = self.escapes.iter().sum();
        (f64::from(escaped) / f64::from(self.rays.max(1))).max(0.02)
    }

    /// Whether any ray reached a bin of the sky.
    pub fn reaches(&self, bin: usize) -> bool {
        self.escapes[bin] > 0
    }

    /// Factor on the chance of a bin: one tenth of the mean even where nothing is seen, so that what the look missed is
    /// found all the same.
    pub fn factor(&self, bin: usize) -> f32 {
        let mean = self.escapes.iter().sum::<u32>() as f32 / Self::BINS as f32;
        if mean == 0.0 { 1.0 } else { 0.1 + self.escapes[bin] as f32 / mean }
    }

    /// Bin of a unit direction.
    pub fn bin(dir: Vec3) -> usize {
        let phi = libm::atan2f(dir.z, dir.x) / TAU;
        let phi = if phi < 0.0 { phi + 1.0 } else { phi };
        let row = ((1.0 - dir.y) * 0.5 * ROWS as f32) as usize;
        let column = (phi * COLUMNS as f32) as usize;
        row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)
    }

    /// A direction uniform over a bin.
    pub fn direction(bin: usize, u: [f32; 2]) -> Vec3 {
        let (row, column) = (bin / COLUMNS, bin % COLUMNS);
        let y = (1.0 - 2.0 * (row as f32 + u[1]) / ROWS as f32).clamp(-1.0, 1.0);
        let r = (1.0 - y * y).max(0.0).sqrt();
        let phi = (column as f32 + u[0]) / COLUMNS as f32 * TAU;
        Vec3::new(r * libm::cosf(phi), y, r * libm::sinf(phi))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_fall_into_their_bins() {
        for bin in 0..SkyView::BINS {
            for u in [[0.01, 0.01], [0.5, 0.5], [0.99, 0.02], [0.02, 0.99]] {
                let dir = SkyView::direction(bin, u);
                assert!((dir.length() - 1.0).abs() < 1e-5);
                assert_eq!(SkyView::bin(dir), bin, "{u:?}");
            }
        }
    }

    #[test]
    fn unseen_directions_keep_a_chance() {
        let mut view = SkyView::new();
        assert_eq!(view.factor(3), 1.0);
        for _ in 0..100 {
            view.add(SkyView::direction(7, [0.5, 0.5]), true);
            view.add(Vec3::Y, false);
        }
        assert!(view.factor(7) > 100.0 && view.factor(8) == 0.1);
        assert_eq!(view.openness(), 0.5);
    }
}
