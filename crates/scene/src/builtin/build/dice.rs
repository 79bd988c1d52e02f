//! Fixed random numbers for placing and varying things.

use photinus_num::{Sampler, StreamKind};

/// A stream of random numbers: the same numbers for the same (`what`, `index`) in every build.
pub struct Dice {
    sampler: Sampler,
}

impl Dice {
    /// Numbers for item `index` of the things that `what` stands for.
    pub fn new(what: u64, index: u32) -> Self {
        Self { sampler: Sampler::new(0x9407_1245, StreamKind::Scene, what, index) }
    }

    /// Uniform in `[low, high)`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.sampler.next_1d()
    }

    /// One of the choices.
    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        let i = (self.sampler.next_1d() * choices.len() as f32) as usize;
        choices[i.min(choices.len() - 1)]
    }
}

/// Parts of `total` over `count` takers, as even as whole numbers allow, the larger ones first.
pub fn shares(total: usize, count: usize) -> impl Iterator<Item = usize> {
    (0..count).map(move |i| total / count + usize::from(i < total % count))
}
