//! A session: a scene made ready once, then rendered and asked about.

use super::measured::Measured;
use super::memory::MemoryPrediction;
use super::picture::Picture;
use super::recorder::Recorder;
use super::stats::{AccelStats, MemoryStats, PhaseStats, PhotonStats, RayStats, Seconds, Stats};
use super::stop::{Spent, StopReason};
use super::timeline::Timeline;
use super::{RenderOptions, Stop};
use crate::machine::{Machine, cpu_seconds};
use crate::{Error, Result};
use photinus_accel::{BuildOptions, StructureSummary};
use photinus_geometry::{Hit, Ray};
use photinus_profile::queries::QueryTotals;
use photinus_render::{Compiled, Mode, Observer, Phase, RenderError, Renderer, Settings, World};
use photinus_scene::Scene;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::Arc;
use std::time::Instant;

/// A scene ready to be rendered.
pub struct Session {
    world: World,
    options: RenderOptions,
    pool: ThreadPool,
    structure: StructureSummary,
    triangles: u64,
    build: Seconds,
    notes: Vec<String>,
    recorder: Option<Arc<Recorder>>,
}

/// Listens to a render: phases and progress as an [`Observer`], what is planned, and every finished pass.
pub trait Watcher: Observer {
    /// The scene has been looked at, and the first pass is about to begin.
    fn planned(&self, _plan: &Plan) {}

    /// A pass has been finished.
    fn pass_done(&self, _state: &PassState<'_>) {}
}

impl Watcher for photinus_render::Silent {}

/// What a render is going to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Photons of a pass, or of all in the modes with one map; 0 without photons.
    pub photons: u32,
    /// Eye samples of a pass.
    pub samples: u64,
    /// First gather radii: after a diffuse bounce, and of caustics; scene units. None without photons.
    pub first_radii: Option<[f32; 2]>,
    /// The most memory that the process will hold.
    pub memory: MemoryPrediction,
}

/// The state of a render between two passes.
pub struct PassState<'a> {
    /// Passes finished.
    pub passes: u32,
    /// Mean relative squared error of the pixels, estimated from the passes; none where it is not asked for.
    pub error: Option<f64>,
    /// Wall seconds of the latest pass.
    pub pass_secs: f64,
    /// Whether this was the last one.
    pub last: bool,
    picture: &'a dyn Fn() -> Picture,
}

impl PassState<'_> {
    /// The picture so far.
    pub fn picture(&self) -> Picture {
        (self.picture)()
    }
}

/// What came out of a render.
pub struct Rendered {
    /// The picture; none where the render was stopped before it had any.
    pub picture: Option<Picture>,
    /// What was counted and measured.
    pub stats: Stats,
}

impl Session {
    /// Checks the options, compiles the scene and builds the structure.
    ///
    /// # Errors
    /// [`Error::Setting`], [`Error::UnknownName`] or [`Error::Structure`] for what does not fit.
    pub fn new(mut scene: Scene, options: RenderOptions) -> Result<Self> {
        options.check()?;
        options.apply(&mut scene)?;
        let notes = options.tessellate_spheres(&mut scene)?.into_iter().chain(options.uncorrected_edges()).collect();
        let triangles = scene.triangle_count() as u64;
        let pool = ThreadPoolBuilder::new()
            .num_threads(options.threads.unwrap_or(0))
            .build()
            .map_err(|e| Error::setting("--threads", format!("they cannot be started: {e}")))?;
        let (begun, cpu) = (Instant::now(), cpu_seconds());
        let mut world = pool.install(|| {
            let options = &options;
            let build = BuildOptions { method: options.intersect.clone(), ..options.build.clone() };
            Compiled::new(scene).build_structure(options.surface_model, |primitives| {
                photinus_accel::build(&options.accel, primitives, &build)
            })
        })?;
        let structure = world.structure().summary();
        let recorder = match &options.record_queries {
            Some(path) => Some(Arc::new(Recorder::new(path, &world)?)),
            None => None,
        };
        if let Some(recorder) = recorder.clone() {
            world.record_queries(recorder);
        }
        let build = Seconds { wall_secs: begun.elapsed().as_secs_f64(), cpu_secs: cpu_seconds() - cpu };
        Ok(Self { world, options, pool, structure, triangles, build, notes, recorder })
    }

    /// The structure that was built.
    pub fn structure(&self) -> &StructureSummary {
        &self.structure
    }

    /// Wall seconds that compiling the scene and building the structure took.
    pub fn build_secs(&self) -> f64 {
        self.build.wall_secs
    }

    /// What was done otherwise than asked for, one line each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Threads that work.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Name of the scene.
    pub fn scene_name(&self) -> &str {
        &self.world.name
    }

    /// Window of the picture that is rendered: x, y, width, height in pixels.
    pub fn window(&self) -> [u32; 4] {
        self.world.film.crop.unwrap_or([0, 0, self.world.film.width, self.world.film.height])
    }

    /// The options.
    pub fn options(&self) -> &RenderOptions {
        &self.options
    }

    /// The nearest hit of each ray within its interval; `hits` is as long as `rays`.
    pub fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.world.structure().closest_hit(rays, hits);
    }

    /// Whether each ray hits anything within its interval; `occluded` is as long as `rays`.
    pub fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.world.structure().any_hit(rays, occluded);
    }

    /// Renders until a stop condition is met or the watcher cancels.
    ///
    /// # Errors
    /// [`Error::Render`] where the photons cannot be searched.
    pub fn render(&self, watcher: &dyn Watcher) -> Result<Rendered> {
        self.pool.install(|| self.run(watcher))
    }

    /// Ends the file of [`RenderOptions::record_queries`] and puts it in place: it holds the queries of all renders so
    /// far. None where nothing is recorded, or the file has been ended.
    ///
    /// # Errors
    /// [`Error::Write`] with the first trouble that there was in writing it.
    pub fn finish_recording(&self) -> Result<Option<QueryTotals>> {
        self.recorder.as_ref().map_or(Ok(None), |recorder| recorder.finish())
    }

    fn run(&self, watcher: &dyn Watcher) -> Result<Rendered> {
        let stop = self.options.stop;
        let timeline = Timeline::new(watcher);
        let mut settings = self.options.settings.clone();
        settings.track_error |= stop.target_error.is_some();
        let mut renderer = match Renderer::new(&self.world, settings, &timeline) {
            Ok(renderer) => Some(renderer),
            Err(RenderError::Cancelled(_)) => None,
            Err(error) => return Err(error.into()),
        };
        timeline.end();
        let mut reason = StopReason::Interrupted;
        let mut plan = None;
        if let Some(renderer) = &mut renderer {
            let made = self.plan(renderer);
            watcher.planned(&made);
            plan = Some(made);
            reason = self.passes(renderer, stop, &timeline, watcher)?;
        }
        timeline.end();
        let stats = self.stats(renderer.as_ref(), reason, &timeline, plan.as_ref());
        let picture = renderer.as_ref().filter(|r| r.has_picture()).map(|r| self.picture(r));
        Ok(Rendered { picture, stats })
    }

    fn plan(&self, renderer: &Renderer<'_>) -> Plan {
        let [_, _, width, height] = renderer.window();
        let settings = &self.options.settings;
        Plan {
            photons: renderer.photons(),
            samples: u64::from(width) * u64::from(height) * u64::from(settings.spp),
            first_radii: (settings.mode != Mode::Path).then(|| renderer.radii()),
            memory: MemoryPrediction::of(&self.world, renderer, &self.structure, &self.options.stop),
        }
    }

    /// Runs passes until the render is over.
    fn passes(
        &self,
        renderer: &mut Renderer<'_>,
        stop: Stop,
        timeline: &Timeline<'_>,
        watcher: &dyn Watcher,
    ) -> Result<StopReason> {
        loop {
            let (before_secs, before_cpu) = stop.clock();
            match renderer.render_pass(timeline) {
                Ok(()) => timeline.end(),
                Err(RenderError::Cancelled(_)) => return Ok(StopReason::Interrupted),
                Err(error) => return Err(error.into()),
            }
            let (elapsed_secs, cpu_secs) = stop.clock();
            let spent = Spent {
                passes: renderer.passes(),
                elapsed_secs,
                cpu_secs,
                pass_secs: elapsed_secs - before_secs,
                pass_cpu_secs: cpu_secs - before_cpu,
                error: stop.target_error.and_then(|_| renderer.estimated_error()),
            };
            let reason = stop.reached(&spent);
            watcher.pass_done(&PassState {
                passes: spent.passes,
                error: spent.error,
                pass_secs: spent.pass_secs,
                last: reason.is_some(),
                picture: &|| self.picture(renderer),
            });
            if let Some(reason) = reason {
                return Ok(reason);
            }
        }
    }

    fn picture(&self, renderer: &Renderer<'_>) -> Picture {
        let [_, _, width, height] = renderer.window();
        let settings = &self.options.settings;
        let mut about = vec![
            ("scene", self.world.name.clone()),
            ("mode", settings.mode.name().to_owned()),
            ("passes", renderer.passes().to_string()),
            ("spp", settings.spp.to_string()),
            ("photons", renderer.photons().to_string()),
            ("seed", settings.seed.to_string()),
            ("software", concat!("photinus ", env!("CARGO_PKG_VERSION")).to_owned()),
        ];
        if settings.mode != Mode::Path {
            about.push(("support", settings.support.clone()));
            about.push(("kernel", settings.kernel_name().to_owned()));
        }
        Picture::new(&renderer.pixels(), renderer.layout(), width, height, &about)
    }

    fn stats(
        &self,
        renderer: Option<&Renderer<'_>>,
        stopped: StopReason,
        timeline: &Timeline<'_>,
        plan: Option<&Plan>,
    ) -> Stats {
        let counters = renderer.map(|r| *r.counters()).unwrap_or_default();
        let (wall_secs, cpu_secs) = self.options.stop.clock();
        let [_, _, width, height] = self.window();
        let settings = &self.options.settings;
        let measured = Measured::of(&counters, &self.structure, &settings.search);
        let other = [
            ("build", self.build.cpu_secs),
            ("pilot", timeline.spent(Phase::Pilot).cpu_secs),
            ("map_build", timeline.spent(Phase::MapBuild).cpu_secs),
            ("density_estimate", measured.density_estimate_secs),
            ("surfaces", measured.surfaces_secs),
        ];
        let mut stats = Stats {
            scene: self.world.name.clone(),
            triangles: self.triangles,
            size: [width, height],
            passes: renderer.map_or(0, Renderer::passes),
            stopped,
            estimated_error: renderer.and_then(Renderer::estimated_error),
            first_radii: plan.and_then(|plan| plan.first_radii),
            seconds: Seconds { wall_secs, cpu_secs },
            phases: PhaseStats {
                build: self.build,
                pilot: timeline.spent(Phase::Pilot),
                photon_pass: timeline.spent(Phase::PhotonPass),
                map_build: timeline.spent(Phase::MapBuild),
                shadow_photons: timeline.spent(Phase::ShadowPhotons),
                irradiance: timeline.spent(Phase::Irradiance),
                irradiance_cache: timeline.spent(Phase::IrradianceCache),
                eye_pass: timeline.spent(Phase::EyePass),
            },
            rays: RayStats::of(&counters),
            intersect: measured.intersect,
            accel: AccelStats { profile: measured.accel, structure: self.structure.clone() },
            search: measured.search,
            irradiance: counters.irradiance,
            shadow_photons: counters.shadow_photons,
            photons: PhotonStats::of(&counters.photons),
            caustic_photons: PhotonStats::of(&counters.caustic_photons),
            other: other.map(|(what, secs)| (what.to_owned(), secs)).into(),
            memory: MemoryStats::of(plan.map(|plan| &plan.memory)),
            threads: self.threads(),
            seed: settings.seed,
            settings: Settings {
                kernel: (settings.mode != Mode::Path).then(|| settings.kernel_name().to_owned()),
                ..settings.clone()
            },
            version: env!("CARGO_PKG_VERSION"),
            machine: Machine::this(),
        };
        stats.settle();
        stats
    }
}
