//! Whether rays' next nodes and leaves are asked of memory as soon as they are known, or when they are read.
//!
//! Asking early hides the time that memory takes, and costs as much as a tenth where caches have answered before: which is
//! the case depends on the mesh and on the rays. So a few batches try both for a while, and the tree keeps what came of it. What
//! is found does not depend on it.

use photinus_profile::ticks;
use std::sync::atomic::{AtomicU32, Ordering};

/// Rays after which a batch has taken up its pace, tries its own way, and the other; the rest goes the better way.
const UNTIL: [usize; 3] = [128, 256, 384];
/// Batches of fewer rays try nothing, and of others one of so many does.
const FEWEST: usize = 512;
const ONE_OF: u32 = 4;
/// Weight of a batch among those before it.
const WEIGHT: f32 = 1.0 / 8.0;

/// What earlier batches say.
#[derive(Debug)]
pub struct Habit {
    /// The time of a ray that asks early over that of one that does not, as the bits of a float.
    ratio: AtomicU32,
    /// Batches that were long enough to try.
    batches: AtomicU32,
}

impl Default for Habit {
    fn default() -> Self {
        Self { ratio: AtomicU32::new(1.0_f32.to_bits()), batches: AtomicU32::new(0) }
    }
}

impl Habit {
    fn ratio(&self) -> f32 {
        f32::from_bits(self.ratio.load(Ordering::Relaxed))
    }

    /// Takes note of what a batch measured; another that does so at the same time may be forgotten.
    fn note(&self, early: f32, late: f32) {
        // Whatever interrupts a batch weighs no more than a doubt.
        let measured = (early / late).clamp(0.5, 2.0);
        if measured.is_finite() {
            let ratio = self.ratio();
            self.ratio.store((ratio + (measured - ratio) * WEIGHT).to_bits(), Ordering::Relaxed);
        }
    }
}

/// What a batch does.
pub struct Pace<'a> {
    habit: &'a Habit,
    /// Whether to ask early now.
    pub is_early: bool,
    is_usually_early: bool,
    /// Rays taken up one by one: those of packets say nothing.
    pub rays: usize,
    /// The next of [`UNTIL`] to come.
    step: usize,
    /// When the last came, and after how many rays.
    begun: (u64, usize),
    /// Ticks a ray of the usual way.
    usual: f32,
}

impl<'a> Pace<'a> {
    /// The pace of a batch of so many rays.
    pub fn new(habit: &'a Habit, rays: usize) -> Self {
        let is_early = habit.ratio() <= 1.0;
        let tries = rays >= FEWEST && habit.batches.fetch_add(1, Ordering::Relaxed).is_multiple_of(ONE_OF);
        let step = if tries { 0 } else { UNTIL.len() };
        Self { habit, is_early, is_usually_early: is_early, rays: 0, step, begun: (0, 0), usual: 0.0 }
    }

    /// Goes on with the rays that have been taken up.
    #[inline(always)]
    pub fn step(&mut self) {
        if self.step < UNTIL.len() && self.rays >= UNTIL[self.step] {
            self.turn();
        }
    }

    #[inline(never)]
    fn turn(&mut self) {
        let (now, rays) = (ticks(), self.rays);
        let each = now.wrapping_sub(self.begun.0) as f32 / (rays - self.begun.1).max(1) as f32;
        match self.step {
            0 => {}
            1 => {
                self.usual = each;
                self.is_early = !self.is_usually_early;
            }
            _ => {
                let (early, late) = if self.is_early { (each, self.usual) } else { (self.usual, each) };
                self.habit.note(early, late);
                self.is_early = self.habit.ratio() <= 1.0;
            }
        }
        (self.step, self.begun) = (self.step + 1, (now, rays));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn habits_follow_what_is_measured_within_bounds() {
        let habit = Habit::default();
        for (early, late, expected) in [(3.0, 1.0, 2.0), (1.0, 9.0, 0.5), (1.0, 0.0, 2.0)] {
            (0..100).for_each(|_| habit.note(early, late));
            assert!((habit.ratio() - expected).abs() < 1e-3, "{early} over {late}: {}", habit.ratio());
        }
        habit.note(0.0, 0.0);
        assert!((habit.ratio() - 2.0).abs() < 1e-3);
    }

    #[test]
    fn one_of_four_long_batches_tries_the_other_way_and_then_goes_the_better() {
        for slow in [true, false] {
            let habit = Habit::default();
            let paces: Vec<Vec<bool>> = (0..8)
                .map(|_| {
                    let mut pace = Pace::new(&habit, 1024);
                    let ways = [0, 128, 256, 300, 384, 1024].map(|rays| {
                        pace.rays = rays;
                        pace.step();
                        // As if one way took longer.
                        if rays == 300 {
                            pace.usual = if slow { 1e30 } else { 0.0 };
                        }
                        pace.is_early
                    });
                    ways.to_vec()
                })
                .collect();
            assert_eq!(paces[0], [true, true, false, false, !slow, !slow]);
            assert!(paces[1..4].iter().all(|ways| *ways == [!slow; 6]), "{paces:?}");
            assert_eq!(paces[4][..4], [!slow, !slow, slow, slow]);
            assert!(Pace::new(&habit, 511).is_early != slow && habit.batches.load(Ordering::Relaxed) == 8);
        }
    }
}
