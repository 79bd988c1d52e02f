//! Seconds by phase: an observer that passes everything on and looks at the clocks when a phase begins.

use super::stats::Seconds;
use crate::machine::cpu_seconds;
use photinus_render::{Observer, Phase};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Listens to a render on behalf of another observer and keeps the times.
pub(super) struct Timeline<'o> {
    listener: &'o dyn Observer,
    state: Mutex<State>,
}

struct State {
    current: Option<(Phase, Instant, f64)>,
    spent: BTreeMap<&'static str, Seconds>,
}

impl<'o> Timeline<'o> {
    pub fn new(listener: &'o dyn Observer) -> Self {
        Self { listener, state: Mutex::new(State { current: None, spent: BTreeMap::new() }) }
    }

    /// Ends the current phase.
    pub fn end(&self) {
        self.change(None);
    }

    /// What a phase has taken so far; nothing before it has ended once.
    pub fn spent(&self, phase: Phase) -> Seconds {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.spent.get(phase.name()).copied().unwrap_or_default()
    }

    fn change(&self, next: Option<Phase>) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let (now, cpu) = (Instant::now(), cpu_seconds());
        if let Some((phase, began, cpu_before)) = state.current.take() {
            let spent = state.spent.entry(phase.name()).or_default();
            spent.wall_secs += (now - began).as_secs_f64();
            spent.cpu_secs += cpu - cpu_before;
        }
        state.current = next.map(|phase| (phase, now, cpu));
    }
}

impl Observer for Timeline<'_> {
    fn begin(&self, phase: Phase, pass: u32) {
        self.change(Some(phase));
        self.listener.begin(phase, pass);
    }

    fn progress(&self, done: u64, total: u64) {
        self.listener.progress(done, total);
    }

    fn cancelled(&self) -> bool {
        self.listener.cancelled()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_render::Silent;
    use std::time::Duration;

    #[test]
    fn phases_share_the_time_between_them() {
        let timeline = Timeline::new(&Silent);
        let begun = Instant::now();
        for pass in 0..2 {
            timeline.begin(Phase::PhotonPass, pass);
            std::thread::sleep(Duration::from_millis(3));
            timeline.begin(Phase::EyePass, pass);
            std::thread::sleep(Duration::from_millis(1));
        }
        timeline.end();
        let (photon, eye) = (timeline.spent(Phase::PhotonPass), timeline.spent(Phase::EyePass));
        assert!(photon.wall_secs >= 0.006 && eye.wall_secs >= 0.002);
        assert!(photon.wall_secs + eye.wall_secs <= begun.elapsed().as_secs_f64());
        assert_eq!(timeline.spent(Phase::MapBuild), Seconds::default());
    }
}
