//! How often shadow rays reached each light from each group of points: counts, so that any order of adding gives the same.

use std::sync::atomic::{AtomicU64, Ordering};

/// Rays that were sent, and those of them that got through at least in part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Count {
    pub asked: u32,
    pub reached: u32,
}

impl std::ops::AddAssign for Count {
    fn add_assign(&mut self, other: Self) {
        self.asked = self.asked.saturating_add(other.asked);
        self.reached = self.reached.saturating_add(other.reached);
    }
}

/// Counts by group and item, and those that a pass is adding.
#[derive(Debug, Default)]
pub(super) struct Tally {
    known: Vec<Count>,
    /// Rays sent, above those that got through.
    now: Vec<AtomicU64>,
}

impl Tally {
    /// Begins with these counts.
    pub fn new(known: Vec<Count>) -> Self {
        let now = known.iter().map(|_| AtomicU64::new(0)).collect();
        Self { known, now }
    }

    /// Counts of finished passes, group by group.
    pub fn known(&self) -> &[Count] {
        &self.known
    }

    /// Adds a ray. A pass sends fewer than 2^32 for one entry.
    #[inline]
    pub fn add(&self, slot: usize, reached: bool) {
        self.now[slot].fetch_add(1 << 32 | u64::from(reached), Ordering::Relaxed);
    }

    /// The pass is over: its counts stay.
    pub fn keep(&mut self) {
        for (known, now) in self.known.iter_mut().zip(&mut self.now) {
            let now = std::mem::take(now.get_mut());
            *known += Count { asked: (now >> 32) as u32, reached: now as u32 };
        }
    }

    /// The pass was stopped: its counts go.
    pub fn forget(&mut self) {
        self.now.iter_mut().for_each(|now| *now.get_mut() = 0);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.known.len() * (size_of::<Count>() + size_of::<AtomicU64>())
    }
}
