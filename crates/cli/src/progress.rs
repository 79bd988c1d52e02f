//! What is seen of a render while it runs: a bar with phase, rate and remaining time on a terminal, one plain line a
//! phase otherwise, nothing when it is to be quiet.

use crate::report;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use photinus::render::{Phase, Plan, Stop};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Length of the bar: thousandths of the render.
const STEPS: f64 = 1000.0;
/// Phases of a pass, and the share of it that each is taken for until one has been measured.
const PHASES: [(Phase, f64); 6] = [
    (Phase::PhotonPass, 0.3),
    (Phase::MapBuild, 0.1),
    (Phase::ShadowPhotons, 0.0),
    (Phase::Irradiance, 0.0),
    (Phase::IrradianceCache, 0.0),
    (Phase::EyePass, 0.6),
];

/// Shows a render's progress on standard error.
pub struct Progress {
    display: Display,
    stop: Stop,
    state: Mutex<State>,
    /// Thousandths of the current phase that have been shown: most reports end here, without a lock.
    shown: AtomicU64,
}

enum Display {
    Quiet,
    /// One line a phase.
    Lines,
    Bar(ProgressBar),
}

struct State {
    render_began: Instant,
    phase: Option<(Phase, Instant)>,
    pass: u32,
    /// Estimated error after the latest pass.
    error: Option<f64>,
    /// Photons and eye samples of a pass, for rates; 0 before they are known.
    photons: f64,
    samples: f64,
    /// Seconds of the latest of each of [`PHASES`].
    seconds: [Option<f64>; 6],
}

impl Progress {
    /// A display for this terminal, or none of it.
    pub fn new(quiet: bool, stop: Stop) -> Self {
        let display = if quiet {
            Display::Quiet
        } else if std::io::stderr().is_terminal() {
            let target = ProgressDrawTarget::stderr_with_hz(8);
            let bar = ProgressBar::with_draw_target(Some(STEPS as u64), target);
            let style = ProgressStyle::with_template("[{bar:30}] {percent:>3} %  {wide_msg}");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> "));
            bar.enable_steady_tick(Duration::from_millis(250));
            Display::Bar(bar)
        } else {
            Display::Lines
        };
        let state = State {
            render_began: Instant::now(),
            phase: None,
            pass: 0,
            error: None,
            photons: 0.0,
            samples: 0.0,
            seconds: [None; 6],
        };
        Self { display, stop, state: Mutex::new(state), shown: AtomicU64::new(0) }
    }

    /// A line that stays; on a terminal it goes above the bar.
    pub fn line(&self, text: &str) {
        match &self.display {
            Display::Quiet => {}
            Display::Lines => report::note(text),
            Display::Bar(bar) => bar.suspend(|| report::note(text)),
        }
    }

    /// What a pass amounts to is known now.
    pub fn planned(&self, plan: &Plan) {
        let mut state = self.state();
        self.end_phase(&mut state);
        (state.photons, state.samples) = (f64::from(plan.photons), plan.samples as f64);
    }

    /// A phase begins.
    pub fn begin(&self, phase: Phase, pass: u32) {
        let mut state = self.state();
        self.end_phase(&mut state);
        state.phase = Some((phase, Instant::now()));
        state.pass = pass;
        self.shown.store(0, Ordering::Relaxed);
        self.show(&state, 0.0);
    }

    /// `done` of `total` parts of the phase are finished. Called often, from many threads.
    pub fn advance(&self, done: u64, total: u64) {
        let Display::Bar(_) = &self.display else { return };
        let share = done as f64 / total.max(1) as f64;
        let thousandths = (share * STEPS) as u64;
        if self.shown.fetch_max(thousandths, Ordering::Relaxed) < thousandths {
            self.show(&self.state(), share);
        }
    }

    /// A pass has ended.
    pub fn pass_done(&self, passes: u32, error: Option<f64>, last: bool) {
        let mut state = self.state();
        self.end_phase(&mut state);
        state.error = error;
        state.pass = passes;
        if matches!(self.display, Display::Lines) && (passes.is_power_of_two() || last) && passes > 1 {
            let limit = self.stop.pass_limit().map(|limit| format!(" of {limit}")).unwrap_or_default();
            report::note(&format!("pass {passes}{limit}: {:.1} s", state.render_began.elapsed().as_secs_f64()));
        }
    }

    /// The render is over: the bar goes away.
    pub fn finish(&self) {
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes how long the current phase took; without a terminal those before the second pass get a line.
    fn end_phase(&self, state: &mut State) {
        let Some((phase, began)) = state.phase.take() else { return };
        let seconds = began.elapsed().as_secs_f64();
        if let Some(index) = PHASES.iter().position(|(p, _)| *p == phase) {
            state.seconds[index] = Some(seconds);
        }
        if matches!(self.display, Display::Lines) && state.pass == 0 {
            report::note(&format!("{}: {seconds:.2} s", phase.name()));
        }
    }

    /// Draws the bar with `share` of the current phase done.
    fn show(&self, state: &State, share: f64) {
        let (Display::Bar(bar), Some((phase, began))) = (&self.display, state.phase) else { return };
        let done = match phase {
            Phase::Pilot => 0.0,
            _ => f64::from(state.pass) + share_of_pass(&state.seconds, phase, share),
        };
        let fraction = self.stop.fraction(done, state.error);
        bar.set_position((fraction * STEPS) as u64);
        let mut parts = vec![match self.stop.pass_limit() {
            _ if phase == Phase::Pilot => phase.name().to_owned(),
            Some(limit) => format!("pass {}/{limit}: {}", state.pass + 1, phase.name()),
            None => format!("pass {}: {}", state.pass + 1, phase.name()),
        }];
        let (amount, what) = match phase {
            Phase::PhotonPass => (state.photons, "photons"),
            Phase::EyePass => (state.samples, "samples"),
            _ => (0.0, ""),
        };
        let seconds = began.elapsed().as_secs_f64();
        if amount > 0.0 && share > 0.0 && seconds > 0.05 {
            parts.push(format!("{} {what}/s", report::short(amount * share / seconds)));
        }
        if fraction > 0.01 {
            let left = state.render_began.elapsed().as_secs_f64() * (1.0 - fraction) / fraction;
            parts.push(format!("{} left", report::duration(left)));
        }
        bar.set_message(parts.join(", "));
    }
}

/// Share of a pass that is done where `share` of `phase` is, by what the phases took the last time.
fn share_of_pass(seconds: &[Option<f64>; 6], phase: Phase, share: f64) -> f64 {
    let measured = seconds[PHASES.len() - 1].is_some();
    let weight = |i: usize| if measured { seconds[i].unwrap_or(0.0) } else { PHASES[i].1 };
    let total: f64 = (0..PHASES.len()).map(weight).sum();
    let index = PHASES.iter().position(|(p, _)| *p == phase).unwrap_or(0);
    let before: f64 = (0..index).map(weight).sum();
    if total > 0.0 { ((before + share * weight(index)) / total).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_a_pass_rise_from_phase_to_phase() {
        let guess = [None; 6];
        assert_eq!(share_of_pass(&guess, Phase::PhotonPass, 0.0), 0.0);
        assert!((share_of_pass(&guess, Phase::EyePass, 0.0) - 0.4).abs() < 1e-12);
        assert!((share_of_pass(&guess, Phase::EyePass, 1.0) - 1.0).abs() < 1e-12);
        let measured = [Some(1.0), Some(1.0), None, None, None, Some(2.0)];
        assert_eq!(share_of_pass(&measured, Phase::MapBuild, 0.5), 0.375);
        let eye_only = [None, None, None, None, None, Some(2.0)];
        assert_eq!(share_of_pass(&eye_only, Phase::EyePass, 0.5), 0.5);
    }
}
