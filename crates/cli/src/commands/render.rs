//! `photinus render`: a scene into a picture.

use crate::args::{Output, RenderArgs};
use crate::failure::{Failure, Outcome, Result};
use crate::interrupt::Interrupts;
use crate::progress::Progress;
use crate::report;
use photinus::names;
use photinus::render::{
    Observer, PassState, Phase, Picture, Plan, RenderOptions, Rendered, Session, Settings, Stats, Stop, StopReason,
    View, Watcher,
};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A long render rewrites its picture at least this often.
const AUTOSAVE: Duration = Duration::from_secs(30);

/// Renders. `begun` is when the program started.
pub fn run(args: &RenderArgs, begun: Instant) -> Result {
    refuse_unbuilt(args)?;
    let interrupts = Interrupts::listen();
    let options = options(args, begun)?;
    let scene = super::open(&args.scene, args.allow_outside)?;
    let target = Target::new(args, &scene.name)?;
    if !args.quiet {
        super::warn(&scene);
    }
    let (opened, opened_cpu) = (begun.elapsed().as_secs_f64(), photinus::machine::cpu_seconds());
    let contents =
        format!("{} triangles, {} spheres", report::count(scene.triangle_count() as u64), scene.sphere_count());
    let session = Session::new(scene, options)?;
    let progress = Progress::new(args.quiet, session.options().stop);
    progress.line(&format!("scene {}: {contents}, {opened:.2} s", session.scene_name()));
    let structure = session.structure();
    progress.line(&format!(
        "{}: depth {}, {}, {:.2} s",
        structure.name,
        structure.depth,
        report::bytes(structure.bytes),
        session.build_secs()
    ));
    if !args.quiet {
        session.notes().iter().for_each(|note| report::warning(note));
    }

    let monitor = Monitor { progress, interrupts, target, saved: Mutex::new(Instant::now()) };
    monitor.interrupts.keep_results();
    let Rendered { picture, mut stats } = session.render(&monitor)?;
    monitor.progress.finish();
    let Monitor { progress, target, .. } = monitor;

    stats.add_other("load", opened_cpu, &session.options().stop);
    if let Some(picture) = &picture {
        let before = photinus::machine::cpu_seconds();
        target.save(picture)?;
        stats.add_other("write", photinus::machine::cpu_seconds() - before, &session.options().stop);
    }
    if let (Some(totals), Some(path)) = (session.finish_recording()?, &args.record_queries) {
        let [rays, searches] = [totals.rays, totals.searches].map(report::count);
        let size = report::bytes(totals.bytes);
        progress.line(&format!("recorded: {rays} rays, {searches} searches, {size}, {}", path.display()));
    }
    let document = Document { output: picture.is_some().then_some(target.path()), stats: &stats };
    if let Some(path) = &args.stats {
        photinus::write_json(path, &document)?;
    }
    if args.json {
        report::json(&document)?;
    }
    if args.profile_every > 0 {
        profile_table(&stats).iter().for_each(|line| progress.line(line));
    }
    progress.line(&summary(&document));
    Ok(if stats.stopped == StopReason::Interrupted { Outcome::Interrupted } else { Outcome::Done })
}

/// What `--json` prints and `--stats` writes.
#[derive(Serialize)]
struct Document<'a> {
    /// The picture's file; none where there is no picture.
    output: Option<&'a Path>,
    #[serde(flatten)]
    stats: &'a Stats,
}

/// The profile in the four rows of the thesis's Table 7, and the means behind them.
fn profile_table(stats: &Stats) -> Vec<String> {
    let profile = stats.profile();
    let mut lines = vec![format!("{:19} {:>6} {:>9} {:>16} {:>10}", "", "share", "seconds", "calls", "per call")];
    for row in profile.rows() {
        let (calls, each) = match (row.calls, row.nanoseconds_a_call()) {
            (Some((count, what)), Some(nanoseconds)) => {
                (format!("{} {what}", report::short(count)), report::nanoseconds(nanoseconds))
            }
            _ => Default::default(),
        };
        lines.push(format!(
            "{:19} {:4.1} % {:>7.2} s {calls:>16} {each:>10}",
            row.name,
            100.0 * row.share,
            row.seconds
        ));
    }
    let mut parts: Vec<(&str, f64)> = profile.other.iter().map(|(what, secs)| (what.as_str(), *secs)).collect();
    parts.sort_by(|a, b| b.1.total_cmp(&a.1));
    let part = |(what, secs): &(&str, f64)| format!("{} {secs:.2} s", what.replace('_', " "));
    lines.push(format!("of everything else: {}", parts.iter().take(5).map(part).collect::<Vec<_>>().join(", ")));
    let (intersect, accel, search) = (&profile.intersect, &profile.accel, &profile.search);
    lines.push(format!(
        "a ray: {:.1} tests, {:.1} leaves of {:.1} primitives, {:.1} nodes",
        intersect.tests_per_ray, accel.leaves_per_ray, accel.triangles_per_leaf, accel.nodes_per_ray
    ));
    if search.searches > 0 {
        lines.push(format!(
            "a search: {:.1} photons found of {:.1} tested; {} stored",
            search.photons_found_mean,
            search.tests_per_search,
            report::count(profile.photons_stored())
        ));
    }
    lines
}

fn summary(document: &Document<'_>) -> String {
    let Stats { passes, seconds, stopped, .. } = document.stats;
    let how = if *stopped == StopReason::Interrupted { "interrupted" } else { "done" };
    match document.output {
        Some(path) => format!("{how}: {passes} passes, {:.1} s, {}", seconds.wall_secs, path.display()),
        None => format!("{how} before there was a picture, {:.1} s", seconds.wall_secs),
    }
}

/// Options that belong to the contract and are not built yet are refused, never ignored.
fn refuse_unbuilt(args: &RenderArgs) -> std::result::Result<(), Failure> {
    let unbuilt =
        [(args.denoise, "--denoise"), (args.resume.is_some(), "--resume"), (args.hardware.is_some(), "--hardware")];
    if let Some((_, option)) = unbuilt.iter().find(|(given, _)| *given) {
        return Err(Failure::Usage(format!("{option}: not built yet; leave it out")));
    }
    if args.backend != names::BACKEND.default {
        let message = format!("--backend: {} is not built yet; use {}", args.backend, names::BACKEND.default);
        return Err(Failure::Usage(message));
    }
    Ok(())
}

fn options(args: &RenderArgs, begun: Instant) -> std::result::Result<RenderOptions, Failure> {
    let mut aovs = Vec::new();
    for name in &args.aov {
        let aov = names::aov(name)?;
        if !aovs.contains(&aov) {
            aovs.push(aov);
        }
    }
    Ok(RenderOptions {
        settings: Settings {
            mode: names::mode(&args.mode)?,
            photons: args.photons,
            radius: args.radius,
            caustic_radius: args.caustic_radius,
            support: args.support.clone(),
            kernel: args.kernel.clone(),
            knn: args.knn,
            indirect: names::indirect(&args.indirect)?,
            gather_rays: args.gather_rays,
            irradiance_every: args.irradiance_every,
            cache_accuracy: args.cache_accuracy,
            shadow_photons: args.shadow_photons,
            spp: args.spp,
            max_depth: args.max_depth,
            seed: args.seed,
            search: args.search.clone(),
            aovs,
            profile_every: args.profile_every,
            ..Settings::default()
        },
        accel: args.accel.clone(),
        intersect: args.intersect.clone(),
        build: args.structure.options()?,
        surface_model: names::surface_model(&args.surface_model)?,
        size: args.size.map(|size| [size.width, size.height]),
        view: args.camera.map(|camera| View {
            origin: camera.origin.into(),
            target: camera.target.into(),
            up: camera.up.into(),
            fov_degrees: camera.fov_degrees,
        }),
        crop: args.crop,
        tessellate: args.tessellate,
        threads: args.threads,
        record_queries: args.record_queries.clone(),
        stop: Stop {
            time_secs: args.time,
            cpu_secs: args.cpu_time,
            passes: args.passes,
            target_error: args.target_error,
            begun,
        },
    })
}

/// Where the picture goes.
struct Target {
    output: Output,
    tonemap: photinus::Tonemap,
    exposure: f32,
}

impl Target {
    /// Checks what would only be noticed at the end of a long render.
    fn new(args: &RenderArgs, scene_name: &str) -> std::result::Result<Self, Failure> {
        let output = args.output.clone().unwrap_or_else(|| Output::Png(PathBuf::from(format!("{scene_name}.png"))));
        if let (Output::Png(_), [_, ..]) = (&output, args.aov.as_slice()) {
            return Err(Failure::Usage("--aov: PNG files hold no layers; write to a file that ends in .exr".into()));
        }
        let target = Self { output, tonemap: names::tonemap(&args.tonemap)?, exposure: args.exposure };
        for path in [Some(target.path()), args.stats.as_deref(), args.record_queries.as_deref()].into_iter().flatten() {
            photinus::check_writable(path)?;
            photinus::remove_abandoned(path);
        }
        Ok(target)
    }

    fn path(&self) -> &Path {
        match &self.output {
            Output::Png(path) | Output::Exr(path) => path,
        }
    }

    fn save(&self, picture: &Picture) -> photinus::Result<()> {
        match &self.output {
            Output::Png(path) => picture.write_png(path, self.tonemap, self.exposure),
            Output::Exr(path) => picture.write_exr(path),
        }
    }
}

/// Watches the render on behalf of the person in front of it.
struct Monitor {
    progress: Progress,
    interrupts: Interrupts,
    target: Target,
    /// When the picture was last written, or the render began.
    saved: Mutex<Instant>,
}

impl Observer for Monitor {
    fn begin(&self, phase: Phase, pass: u32) {
        self.progress.begin(phase, pass);
    }

    fn progress(&self, done: u64, total: u64) {
        self.progress.advance(done, total);
    }

    fn cancelled(&self) -> bool {
        self.interrupts.requested()
    }
}

impl Watcher for Monitor {
    fn planned(&self, plan: &Plan) {
        self.progress.planned(plan);
        let needed = plan.memory.total_bytes;
        self.progress.line(&format!("memory: {} predicted", report::bytes(needed)));
        if let Some(available) = photinus::machine::available_bytes().filter(|available| *available < needed) {
            self.progress.line(&format!("photinus: warning: only {} are free", report::bytes(available)));
        }
    }

    fn pass_done(&self, state: &PassState<'_>) {
        self.progress.pass_done(state.passes, state.error, state.last);
        let mut saved = self.saved.lock().unwrap_or_else(PoisonError::into_inner);
        if !state.last && is_due(saved.elapsed(), Duration::from_secs_f64(state.pass_secs)) {
            // The last write reports the same trouble as an error; until then the render goes on.
            if let Err(error) = self.target.save(&state.picture()) {
                self.progress.line(&format!("photinus: warning: {error}"));
            }
            *saved = Instant::now();
        }
    }
}

/// Whether a picture written `age` ago is to be written again now: another pass must not make it older than allowed.
fn is_due(age: Duration, pass: Duration) -> bool {
    age + pass >= AUTOSAVE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_never_older_than_allowed_while_passes_are_shorter() {
        for pass_ms in [1u64, 900, 7_000, 16_000, 29_000] {
            let pass = Duration::from_millis(pass_ms);
            let mut age = Duration::ZERO;
            for _ in 0..100_000 / pass_ms + 100 {
                age += pass;
                assert!(age <= AUTOSAVE, "passes of {pass_ms} ms: {age:?}");
                if is_due(age, pass) {
                    age = Duration::ZERO;
                }
            }
        }
        assert!(!is_due(Duration::from_secs(1), Duration::from_secs(1)), "no more often than needed");
    }
}
