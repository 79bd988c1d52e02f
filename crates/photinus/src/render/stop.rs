//! When a render stops. A clock is read between passes only: it decides how many passes run, never what one computes.

use crate::machine::cpu_seconds;
use crate::{Error, Result};
use serde::Serialize;
use std::time::Instant;

/// Conditions, of which the first that is met ends the render. At least one pass runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Seconds since `begun`. A pass begins only if it is expected to end by then.
    pub time_secs: Option<f64>,
    /// Seconds of processor time of this process, all threads together; likewise.
    pub cpu_secs: Option<f64>,
    /// Passes.
    pub passes: Option<u32>,
    /// Mean relative squared error of the pixels, estimated from the passes.
    pub target_error: Option<f64>,
    /// Where `time_secs` counts from.
    pub begun: Instant,
}

/// Passes where no condition is given.
pub const DEFAULT_PASSES: u32 = 32;

impl Default for Stop {
    fn default() -> Self {
        Self { time_secs: None, cpu_secs: None, passes: None, target_error: None, begun: Instant::now() }
    }
}

/// Why a render ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StopReason {
    /// As many passes as asked for.
    Passes,
    /// The next pass would have ended too late.
    Time,
    /// The next pass would have taken too much processor time.
    CpuTime,
    /// The error is small enough.
    TargetError,
    /// Somebody stopped it.
    Interrupted,
}

/// What is known after a pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spent {
    pub passes: u32,
    pub elapsed_secs: f64,
    pub cpu_secs: f64,
    /// What the latest pass took of each.
    pub pass_secs: f64,
    pub pass_cpu_secs: f64,
    pub error: Option<f64>,
}

impl Stop {
    pub(super) fn check(&self) -> Result<()> {
        let positive = |option, value: Option<f64>| match value {
            Some(x) if !(x > 0.0 && x.is_finite()) => Err(Error::setting(option, "it must be a number above 0")),
            _ => Ok(()),
        };
        positive("--time", self.time_secs)?;
        positive("--cpu-time", self.cpu_secs)?;
        positive("--target-error", self.target_error)?;
        if self.passes == Some(0) { Err(Error::setting("--passes", "it must be at least 1")) } else { Ok(()) }
    }

    /// The limit on passes: what was asked for, or the default where nothing was.
    pub fn pass_limit(&self) -> Option<u32> {
        let open = self.time_secs.is_none() && self.cpu_secs.is_none() && self.target_error.is_none();
        self.passes.or(open.then_some(DEFAULT_PASSES))
    }

    /// Seconds since `begun`, and of processor time.
    pub(super) fn clock(&self) -> (f64, f64) {
        (self.begun.elapsed().as_secs_f64(), cpu_seconds())
    }

    /// Whether the render is over.
    pub(super) fn reached(&self, spent: &Spent) -> Option<StopReason> {
        if self.pass_limit().is_some_and(|limit| spent.passes >= limit) {
            Some(StopReason::Passes)
        } else if self.target_error.zip(spent.error).is_some_and(|(target, error)| error <= target) {
            Some(StopReason::TargetError)
        } else if self.time_secs.is_some_and(|limit| spent.elapsed_secs + spent.pass_secs > limit) {
            Some(StopReason::Time)
        } else if self.cpu_secs.is_some_and(|limit| spent.cpu_secs + spent.pass_cpu_secs > limit) {
            Some(StopReason::CpuTime)
        } else {
            None
        }
    }

    /// How much of a render is done, 0 to 1, by the condition that is nearest: after `passes` passes, a begun one
    /// counted in part, and with an estimated error of `error`.
    pub fn fraction(&self, passes: f64, error: Option<f64>) -> f64 {
        let share = |limit: Option<f64>, used: f64| limit.map_or(0.0, |limit| used / limit);
        let (elapsed_secs, cpu_secs) = self.clock();
        // The error of a mean falls as the number of samples grows.
        let error = self.target_error.zip(error).map_or(0.0, |(target, error)| target / error);
        let shares = [
            share(self.pass_limit().map(f64::from), passes),
            share(self.time_secs, elapsed_secs),
            share(self.cpu_secs, cpu_secs),
            error,
        ];
        shares.into_iter().fold(0.0, f64::max).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPENT: Spent =
        Spent { passes: 8, elapsed_secs: 4.0, cpu_secs: 8.0, pass_secs: 0.5, pass_cpu_secs: 1.0, error: Some(0.02) };

    #[test]
    fn thirty_two_passes_where_nothing_is_said() {
        let stop = Stop::default();
        assert_eq!(stop.pass_limit(), Some(32));
        assert_eq!(stop.reached(&SPENT), None);
        assert_eq!(stop.reached(&Spent { passes: 32, ..SPENT }), Some(StopReason::Passes));
        assert_eq!(stop.fraction(8.0, None), 0.25);
        assert_eq!(Stop { time_secs: Some(1.0), ..stop }.pass_limit(), None);
    }

    #[test]
    fn the_first_condition_that_is_met_ends_it() {
        let stop = Stop { passes: Some(100), ..Stop::default() };
        let time = Stop { time_secs: Some(4.4), ..stop };
        assert_eq!(time.reached(&SPENT), Some(StopReason::Time), "the next pass would end at 4.5 s");
        assert_eq!(Stop { time_secs: Some(4.5), ..stop }.reached(&SPENT), None);
        assert_eq!(Stop { cpu_secs: Some(8.5), ..stop }.reached(&SPENT), Some(StopReason::CpuTime));
        assert_eq!(Stop { target_error: Some(0.02), ..stop }.reached(&SPENT), Some(StopReason::TargetError));
        assert_eq!(Stop { target_error: Some(0.01), ..stop }.reached(&SPENT), None);
        assert_eq!(Stop { target_error: Some(0.01), ..stop }.fraction(8.0, Some(0.02)), 0.5);
    }
}
