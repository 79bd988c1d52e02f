//! A render, pass by pass: photon pass, map build, eye pass, film.

use crate::camera::CameraModel;
use crate::caustic_plan::CausticPlan;
use crate::control::{Cancelled, Observer, Phase};
use crate::counters::Counters;
use crate::cut_pixels::CutPixels;
use crate::direct::DEFAULT_LEVELS;
use crate::eye_pass::{EyePass, TILE};
use crate::film::{Aov, Film, FilmLayout};
use crate::film_filter::{FilterSampler, SharedFilter};
use crate::indirect::{IndirectEstimate, Photons, Preparing};
use crate::light::{LightGuide, Lights, SkyView, anchors, shadow_rays};
use crate::maps::{Map, Maps};
use crate::memory::{Ahead, RenderMemory};
use crate::photon_pass::{Keep, PhotonPass, StoredPhotons, Together};
use crate::photon_window::PhotonWindow;
use crate::pilot::{self, PhotonOutlook, Radii};
use crate::settings::{Mode, Settings};
use crate::shadow_photons::ShadowPhotons;
use crate::waves::{ESTIMATES_A_PIXEL, WAVE_ESTIMATES};
use crate::world::World;
use photinus_num::StreamKind;
use photinus_photons::{
    BuildOptions, DEFAULT_SUPPORT, Kernel, Photon, PhotonError, Support, find_kernel, find_support,
};
use photinus_profile::queries::{Block, BlockKey, MapKind, Stage};
use photinus_scene::Light;
use rayon::prelude::*;

/// Shrinking of the radius, Knaus and Zwicker 2011, section 5: the area falls by (i + ALPHA) / (i + 1).
const ALPHA: f64 = 2.0 / 3.0;

/// Looks at where photons from infinity are useful; those that are aimed already show it better.
const AIM_ROUNDS: u32 = 2;

/// Bytes of a photon whose irradiance is known: itself, and its place in the tree.
const KNOWN_BYTES: u64 = 84;

/// Pixels that one task finishes.
const PIXELS_A_TASK: usize = 1 << 15;

/// Why a render cannot start or go on.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// Stopped by its observer.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The photon search could not be built.
    #[error("photon map: {0}")]
    Photons(#[from] PhotonError),
}

/// A running render.
pub struct Renderer<'w> {
    world: &'w World,
    settings: Settings,
    layout: FilmLayout,
    camera: CameraModel,
    filter: FilterSampler,
    /// The filter where pixels share samples.
    shared: Option<SharedFilter>,
    crop: [u32; 4],
    max_depth: u32,
    photons: u32,
    lights: Lights,
    radii: Radii,
    kernel: Kernel,
    /// None: balls.
    support: Option<&'static Support>,
    /// Photons of their own for caustics.
    caustics: Option<CausticPlan>,
    /// How strong photons should be.
    window: Option<PhotonWindow>,
    /// Photons stored by a pass, by the pilot: in the global map and in the caustic map.
    stored: [u64; 2],
    /// Light covers so much of the view that diffuse surfaces look for it by chance too.
    probe: bool,
    /// Shadow rays of each visible point.
    shadow_rays: u32,
    /// Pixels whose photon estimates are cut by something; only where a picture has them among other light.
    cut_pixels: Option<CutPixels>,
    /// Maps that all passes share, in the modes with one photon map.
    shared_maps: Option<Maps>,
    /// Photons that tell where no shadow ray is needed, of the same modes.
    shadow_photons: Option<ShadowPhotons>,
    /// What estimates light after a diffuse bounce, of the same modes.
    shared_indirect: Box<dyn IndirectEstimate>,
    film: Film,
    /// What a first pass had done when it was stopped.
    partial: Option<Vec<f32>>,
    counters: Counters,
}

impl<'w> Renderer<'w> {
    /// Looks at the scene: what is visible, which radii fit.
    pub fn new(world: &'w World, settings: Settings, observer: &dyn Observer) -> Result<Self, RenderError> {
        observer.begin(Phase::Pilot, 0);
        let kernel = find_kernel(settings.kernel_name())?;
        let support = Some(find_support(&settings.support)?).filter(|support| support.name != DEFAULT_SUPPORT);
        let camera = CameraModel::new(&world.camera, &world.film);
        let crop = world.film.crop.unwrap_or([0, 0, world.film.width, world.film.height]);
        let mut aovs = settings.aovs.clone();
        if settings.track_error && !aovs.contains(&Aov::Variance) {
            aovs.push(Aov::Variance);
        }
        let layout = FilmLayout::new(&aovs);
        let filter = FilterSampler::new(world.film.filter);
        // The thesis's renderer keeps its pixels apart.
        let shared = filter.shared().filter(|_| settings.mode != Mode::Direct);
        let layout = if shared.is_some() { layout.with_weight() } else { layout };
        let pixels = crop[2] as usize * crop[3] as usize;
        let photons = settings.photons.unwrap_or_else(|| default_photons(settings.mode, pixels));
        let max_depth = settings.max_depth.or(world.integrator.max_depth).unwrap_or(match settings.mode {
            Mode::Direct => DEFAULT_LEVELS,
            _ => u32::MAX,
        });
        let points = pilot::visible_points(world, &camera, crop, settings.seed);
        // Paths and shadow rays ask how much lamps cover; else only light from infinity needs the look.
        let is_distant = |light: &Light| matches!(light, Light::Directional { .. } | Light::Environment(_));
        let view = if settings.mode != Mode::Direct || world.lights.iter().any(is_distant) {
            pilot::sky_view(world, &points, settings.seed)
        } else {
            SkyView::new()
        };
        let mut lights = Lights::new(world, pilot::visible_region(world, &points), &view);
        lights.begin_pass(settings.seed, 0);
        // Only shadow rays choose by place, and the thesis's renderer sends none.
        let guide = match settings.mode {
            Mode::Direct => None,
            _ => LightGuide::learn(world, &lights, &points, &view, pixels, settings.seed, observer)?,
        };
        let lights = lights.guided(guide);
        let shadow_rays = match settings.mode {
            Mode::Direct => 0,
            _ => shadow_rays(world, &lights, &points, settings.seed),
        };
        let mut renderer = Self {
            world,
            layout,
            camera,
            filter,
            shared,
            crop,
            max_depth,
            photons,
            probe: lights.has_environment() || view.lamps_are_wide(),
            shadow_rays,
            cut_pixels: settings.corrects_edges().then(|| CutPixels::new(crop[2], crop[3])),
            lights,
            radii: Radii { global: 1.0, caustic: 1.0 },
            kernel,
            support,
            caustics: None,
            window: None,
            stored: [0; 2],
            shared_maps: None,
            shadow_photons: None,
            shared_indirect: Box::new(Photons),
            film: Film::new(0),
            partial: None,
            counters: Counters::default(),
            settings,
        };
        renderer.film = Film::new(pixels * renderer.layout.channels());
        if matches!(renderer.settings.mode, Mode::Progressive | Mode::Gather) && renderer.lights.any_far() {
            for round in 0..AIM_ROUNDS {
                let pass = PhotonPass { pass: round, ..renderer.photon_pass(0) };
                let useful = pilot::useful_rays(world, &renderer.lights, &points, pass, photons, observer)?;
                let anchors = anchors(&useful, renderer.lights.region());
                let open = pilot::openness(world, &renderer.lights, &anchors, renderer.settings.seed);
                renderer.lights = renderer.lights.anchored(&anchors, &open);
            }
        }
        if renderer.settings.mode != Mode::Path {
            let pass = renderer.photon_pass(0);
            PhotonOutlook {
                radii: renderer.radii,
                stored: renderer.stored,
                caustics: renderer.caustics,
                window: renderer.window,
            } = pilot::photon_outlook(
                world,
                &renderer.lights,
                &points,
                pass,
                photons,
                renderer.settings.radius,
                observer,
            )?;
            if let Some(radius) = renderer.settings.caustic_radius {
                renderer.radii.caustic = radius;
            }
        }
        Ok(renderer)
    }

    /// Photons of a pass, or of all in the modes with one map.
    pub fn photons(&self) -> u32 {
        self.photons
    }

    /// First gather radii: light after a diffuse bounce, and caustics.
    pub fn radii(&self) -> [f32; 2] {
        [self.radii.global, self.radii.caustic]
    }

    /// What has been counted so far.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Passes finished.
    pub fn passes(&self) -> u32 {
        self.film.passes()
    }

    /// Whether there is anything to be seen: a finished pass, or what a stopped first one has done.
    pub fn has_picture(&self) -> bool {
        self.film.passes() > 0 || self.partial.is_some()
    }

    /// Where outputs lie among the channels of [`Renderer::pixels`].
    pub fn layout(&self) -> &FilmLayout {
        &self.layout
    }

    /// Window of the film that is rendered: x, y, width, height.
    pub fn window(&self) -> [u32; 4] {
        self.crop
    }

    /// What the render will hold at its peak in `passes` passes, which may be a guess, beside the world itself.
    pub fn predicted_memory(&self, passes: u32, is_guess: bool) -> RenderMemory {
        let pixels = u64::from(self.crop[2]) * u64::from(self.crop[3]);
        RenderMemory::predict(&Ahead {
            values: pixels * self.layout.channels() as u64,
            passes,
            is_guess,
            tiles: self.shared.as_ref().map_or(1.0, |filter| {
                let edge = f64::from(TILE + 2 * filter.reach) / f64::from(TILE);
                edge * edge
            }),
            stored: self.stored,
            maps_once: matches!(self.settings.mode, Mode::Gather | Mode::Direct),
            marks: self.cut_pixels.as_ref().map_or([0; 2], CutPixels::bytes).map(|bytes| bytes as u64),
            estimates: match (self.settings.mode, self.settings.knn) {
                (Mode::Direct, Some(_)) => WAVE_ESTIMATES.min(pixels * ESTIMATES_A_PIXEL),
                _ => 0,
            },
            further: self.further_photons(),
            lights: (self.lights.bytes() + self.caustics.as_ref().map_or(0, |plan| plan.guide.bytes())) as u64,
        })
    }

    /// Photons of the largest map beside those of estimates, and bytes that stand beside it while it is built.
    fn further_photons(&self) -> [u64; 2] {
        // Some tenths of all photons end on the first surface, few go through more than two.
        let shadow = if self.settings.shadow_photons { 2 * u64::from(self.photons) } else { 0 };
        if !(self.settings.mode == Mode::Gather && self.settings.indirect.wants_all_light()) {
            return [shadow, 0];
        }
        let all = self.stored.iter().sum::<u64>() + u64::from(self.photons);
        let known = all / u64::from(self.settings.irradiance_every.max(1)) * KNOWN_BYTES;
        [all.max(shadow), known]
    }

    /// Lights of the scene.
    pub fn lights(&self) -> &Lights {
        &self.lights
    }

    fn photon_pass(&self, pass: u32) -> PhotonPass<'_> {
        PhotonPass {
            seed: self.settings.seed,
            kind: StreamKind::Photon,
            pass,
            count: self.photons,
            // The estimate's own edge to the camera is the last one.
            max_depth: if self.settings.mode == Mode::Direct { 127 } else { self.max_depth.saturating_sub(1) },
            keep: match (self.settings.mode, self.settings.caustic_radius) {
                (Mode::Direct, None) => Keep::All,
                (Mode::Direct, Some(_)) => Keep::AllApart,
                _ => Keep::Indirect,
            },
            keeps_direct: false,
            guide: None,
            together: self.caustics.as_ref().map(|plan| Together {
                guide: &plan.guide,
                plain: self.photons,
                aimed: plan.count,
            }),
            window: self.window.as_ref(),
            profile_every: self.settings.profile_every,
        }
    }

    /// Renders the next pass. Stopped by its observer, the render is as after the pass before; if that was none, what
    /// the first pass has done is kept as the picture so far.
    pub fn render_pass(&mut self, observer: &dyn Observer) -> Result<(), RenderError> {
        let pass = self.film.passes();
        self.lights.begin_pass(self.settings.seed, pass);
        let own_maps = match self.settings.mode {
            Mode::Path => None,
            Mode::Progressive => {
                let radii = self.pass_radii(pass);
                Some(self.build_maps(pass, radii, observer)?)
            }
            Mode::Gather | Mode::Direct => {
                if self.shared_maps.is_none() {
                    self.shared_maps = Some(self.build_maps(0, self.radii, observer)?);
                }
                None
            }
        };
        let maps = own_maps.as_ref().or(self.shared_maps.as_ref());
        observer.begin(Phase::EyePass, pass);
        let mut buffer = self.film.buffer();
        let eye = EyePass {
            world: self.world,
            lights: &self.lights,
            camera: &self.camera,
            filter: &self.filter,
            shared: self.shared.as_ref(),
            layout: &self.layout,
            crop: self.crop,
            seed: self.settings.seed,
            pass,
            spp: self.settings.spp.max(1),
            max_depth: self.max_depth,
            maps,
            indirect: &*self.shared_indirect,
            probe: self.probe,
            profile_every: self.settings.profile_every,
            shadow_rays: self.shadow_rays,
            shadow_photons: self.shadow_photons.as_ref(),
            cut_pixels: self.cut_pixels.as_ref(),
        };
        let result = match (self.settings.mode, maps) {
            (Mode::Direct, Some(maps)) => eye.run_direct(maps, &mut buffer, observer),
            _ => eye.run(&mut buffer, observer),
        };
        match result {
            Ok(counters) => {
                self.counters += counters;
                self.film.add(buffer);
                self.partial = None;
                self.lights.keep_findings();
                if let Some(pixels) = &mut self.cut_pixels {
                    pixels.advance();
                }
                Ok(())
            }
            Err(cancelled) => {
                self.lights.forget_findings();
                if let Some(pixels) = &mut self.cut_pixels {
                    pixels.forget();
                }
                // A picture of nothing is none.
                if self.film.passes() == 0 && buffer.iter().any(|value| *value != 0.0) {
                    self.partial = Some(buffer);
                }
                Err(cancelled.into())
            }
        }
    }

    fn pass_radii(&self, pass: u32) -> Radii {
        let mut area = 1.0f64;
        for i in 1..=u64::from(pass) {
            area *= (i as f64 + ALPHA) / (i as f64 + 1.0);
        }
        let shrink = area.sqrt() as f32;
        Radii { global: self.radii.global * shrink, caustic: self.radii.caustic * shrink }
    }

    fn build_maps(&mut self, pass: u32, radii: Radii, observer: &dyn Observer) -> Result<Maps, RenderError> {
        observer.begin(Phase::PhotonPass, pass);
        let indirect = self.settings.indirect;
        let keeps_direct = self.settings.mode == Mode::Gather && indirect.wants_all_light();
        let photon_pass = PhotonPass { keeps_direct, ..self.photon_pass(pass) };
        let (StoredPhotons { global, mut caustic, direct: mut all, .. }, mut counters) =
            photon_pass.run(self.world, &self.lights, observer)?;
        if let Some(plan) = &self.caustics {
            let own = PhotonPass {
                kind: StreamKind::CausticPhoton,
                count: plan.count,
                keep: Keep::Caustic,
                keeps_direct: false,
                guide: Some(&plan.guide),
                window: None,
                ..photon_pass
            };
            let (stored, counted) = own.run(self.world, &self.lights, observer)?;
            caustic.reserve_exact(stored.caustic.len());
            caustic.extend(stored.caustic);
            counters += counted;
        }
        self.counters += counters;
        observer.begin(Phase::MapBuild, pass);
        let (kernel, support) = (self.kernel, self.support);
        let name = &self.settings.search;
        let map = |kind: MapKind, photons: Vec<Photon>, radius| -> Result<Map, PhotonError> {
            if let Some(recorder) = &self.world.recorder {
                let key = BlockKey { pass, stage: Stage::Map, index: kind as u32 };
                let photons = photons.iter().map(Photon::to_words).collect();
                recorder.record(&Block { photons, ..Block::new(key) });
            }
            let options = BuildOptions { radius_hint: radius };
            let search = photinus_photons::build(name, photons, &options)?;
            let search = match support {
                None => search,
                Some(support) => support.over(search),
            };
            Ok(Map { kind, search, radius, kernel, support })
        };
        if keeps_direct {
            all.extend_from_slice(&global);
            all.extend_from_slice(&caustic);
        }
        let maps = Maps {
            global: map(MapKind::Global, global, radii.global)?,
            caustic: if caustic.is_empty() { None } else { Some(map(MapKind::Caustic, caustic, radii.caustic)?) },
            knn: self.settings.knn,
        };
        if self.settings.mode == Mode::Gather {
            let mut preparing = Preparing {
                world: self.world,
                camera: &self.camera,
                crop: self.crop,
                settings: &self.settings,
                max_depth: self.max_depth,
                maps: &maps,
                all,
                observer,
            };
            let mut counters = Counters::default();
            self.shared_indirect = indirect.prepare(&mut preparing, &mut counters)?;
            if self.settings.shadow_photons {
                observer.begin(Phase::ShadowPhotons, pass);
                let photons = &self.photon_pass(pass);
                let (radius, search) = (radii.global, &self.settings.search);
                let made =
                    ShadowPhotons::new(self.world, &self.lights, photons, radius, search, observer, &mut counters)?;
                self.shadow_photons = Some(made?);
            }
            self.counters += counters;
        }
        Ok(maps)
    }

    /// The picture so far: channels of each pixel of the window, row by row, by [`Renderer::layout`].
    pub fn pixels(&self) -> Vec<f32> {
        let mut mean = match &self.partial {
            Some(partial) if self.film.passes() == 0 => partial.clone(),
            _ => self.film.mean(),
        };
        let passes = self.film.passes().max(1) as f32;
        let finish = |pixel: &mut [f32]| {
            if let Some(weight) = self.layout.weight() {
                let scale = if pixel[weight] > 0.0 { 1.0 / pixel[weight] } else { 0.0 };
                let sums = pixel.iter_mut().enumerate().filter(|(channel, _)| self.layout.is_sum(*channel));
                sums.for_each(|(_, value)| *value *= scale);
            }
            if let Some(offset) = self.layout.offset(Aov::Variance) {
                let luminance = 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2];
                let spread = (pixel[offset] - luminance * luminance).max(0.0);
                pixel[offset] = if passes > 1.0 { spread / (passes - 1.0) } else { 0.0 };
            }
            // Only the first pass writes ids: the mean over passes divided them.
            for aov in [Aov::ObjectId, Aov::MaterialId] {
                if let Some(offset) = self.layout.offset(aov) {
                    pixel[offset] = (pixel[offset] * passes).round();
                }
            }
        };
        mean.par_chunks_exact_mut(self.layout.channels()).with_min_len(PIXELS_A_TASK).for_each(finish);
        mean
    }

    /// Estimated error of the picture so far: mean over pixels of variance / (luminance^2 + 0.01), as relMSE weighs
    /// it. None before the second pass, or where variance is not tracked.
    pub fn estimated_error(&self) -> Option<f64> {
        let offset = self.layout.offset(Aov::Variance)?;
        if self.film.passes() < 2 {
            return None;
        }
        let pixels = self.pixels();
        let channels = self.layout.channels();
        let sum: f64 = pixels
            .chunks_exact(channels)
            .map(|p| {
                let luminance = f64::from(0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]);
                f64::from(p[offset]) / (luminance * luminance + 0.01)
            })
            .sum();
        Some(sum / (pixels.len() / channels).max(1) as f64)
    }
}

fn default_photons(mode: Mode, pixels: usize) -> u32 {
    match mode {
        Mode::Path => 0,
        Mode::Progressive => pixels.clamp(100_000, 1_000_000) as u32,
        Mode::Gather => 1_000_000,
        // The thesis's standard rendering.
        Mode::Direct => 50_000,
    }
}
