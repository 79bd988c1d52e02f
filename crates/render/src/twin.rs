//! Which queries run the instrumented twin: one window of queries in so many, spread over the whole render.

use photinus_num::{Sampler, StreamKind};
use std::ops::Range;

/// Queries of a window: enough for the kernels to work as they do on a whole batch, few enough that a render has
/// hundreds of windows and its means are those of all queries within a few percent.
pub(crate) const WINDOW: usize = 128;

/// What is asked in a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Queries {
    PhotonRays,
    EyeRays,
    Estimates,
    /// Estimates of many tiles that are made together.
    Pooled,
}

/// Cuts the queries of a batch into runs with and without the twin. The windows of a batch lie a fixed distance apart,
/// and where the first one starts is drawn for each batch: every query is as likely as any other to be counted.
#[derive(Clone, Debug)]
pub(crate) struct Twin {
    /// Queries from the start of a window to the next start; none: there are no windows.
    period: Option<usize>,
    /// Queries since the start of the last window.
    place: usize,
}

impl Twin {
    /// No query is counted.
    pub const OFF: Self = Self { period: None, place: 0 };

    /// One window in `every`, 0: none; for batch `batch` of pass `pass`. The very first batch of a render starts with a
    /// window, so that the smallest picture has one.
    pub fn new(every: u32, queries: Queries, pass: u32, batch: u32) -> Self {
        if every == 0 {
            return Self::OFF;
        }
        let period = WINDOW.saturating_mul(every as usize);
        let place = match (pass, batch) {
            (0, 0) => 0,
            _ => {
                let stream = (queries as u64) << 32 | u64::from(pass);
                let u = Sampler::new(0, StreamKind::Twin, stream, batch).next_1d();
                (f64::from(u) * period as f64) as usize
            }
        };
        Self { period: Some(period), place }
    }

    /// Whether the render is profiled at all.
    pub fn is_on(&self) -> bool {
        self.period.is_some()
    }

    /// The runs of the next `count` queries, and whether each is counted.
    pub fn runs(&mut self, count: usize) -> Runs<'_> {
        Runs { twin: self, next: 0, count }
    }

    /// The next of `left` queries that are treated alike.
    fn take(&mut self, left: usize) -> (usize, bool) {
        let Some(period) = self.period else { return (left, false) };
        if period == WINDOW {
            return (left, true);
        }
        let counted = self.place < WINDOW;
        let run = left.min(if counted { WINDOW - self.place } else { period - self.place });
        self.place = (self.place + run) % period;
        (run, counted)
    }
}

/// See [`Twin::runs`].
pub(crate) struct Runs<'t> {
    twin: &'t mut Twin,
    next: usize,
    count: usize,
}

impl Iterator for Runs<'_> {
    type Item = (Range<usize>, bool);

    fn next(&mut self) -> Option<Self::Item> {
        if self.next == self.count {
            return None;
        }
        let (run, counted) = self.twin.take(self.count - self.next);
        let range = self.next..self.next + run;
        self.next = range.end;
        Some((range, counted))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(twin: &mut Twin, counts: &[usize]) -> Vec<bool> {
        let mut out = Vec::new();
        for &count in counts {
            let before = out.len();
            for (range, counted) in twin.runs(count) {
                assert_eq!(range.start, out.len() - before, "runs follow one another");
                out.extend(range.map(|_| counted));
            }
            assert_eq!(out.len() - before, count, "runs cover the batch");
        }
        out
    }

    #[test]
    fn one_query_in_so_many_is_counted_wherever_the_batches_end() {
        for every in [1, 2, 64] {
            let counts = [1000, 1, 0, 77, 3000, WINDOW * every as usize, 5];
            let counts: Vec<usize> = counts.into_iter().cycle().take(700).collect();
            let mask = counted(&mut Twin::new(every, Queries::EyeRays, 0, 0), &counts);
            assert!(mask[0], "a render starts with a window");
            let share = mask.iter().filter(|c| **c).count() as f64 / mask.len() as f64;
            assert!((share * f64::from(every) - 1.0).abs() < 0.02, "{every}: {share}");
        }
        assert!(!counted(&mut Twin::new(0, Queries::EyeRays, 0, 0), &[5000]).contains(&true));
        assert!(!counted(&mut Twin::OFF.clone(), &[5000]).contains(&true));
    }

    #[test]
    fn every_place_of_a_batch_is_as_likely_as_any_other() {
        // 20000 batches of 1024 queries: the first and the last eighth are counted one time in 64 each, within four
        // standard errors of a binomial of 20000 x 128 / 64 windows' worth of whole windows (312: 0.057 each).
        let (mut first, mut last) = (0usize, 0usize);
        for batch in 1..=20_000 {
            let mask = counted(&mut Twin::new(64, Queries::Estimates, 3, batch), &[1024]);
            first += mask[..128].iter().filter(|c| **c).count();
            last += mask[896..].iter().filter(|c| **c).count();
        }
        for found in [first, last] {
            let share = found as f64 / (20_000.0 * 128.0) * 64.0;
            assert!((share - 1.0).abs() < 0.23, "{share}");
        }
    }
}
