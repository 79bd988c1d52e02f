//! What a caller may choose about a render, and whether it makes sense.

use super::Stop;
use crate::names::{ACCEL, INTERSECT, KERNEL, SEARCH, SUPPORT};
use crate::{Error, Result};
use photinus_accel::BuildOptions;
use photinus_geometry::Vec3;
use photinus_render::bsdf::SurfaceModel;
use photinus_render::{Indirect, Mode, Settings};
use photinus_scene::{FovAxis, Projection, Scene, tessellate};
use std::path::PathBuf;

/// A view that replaces the scene's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Position, scene units.
    pub origin: Vec3,
    /// A point in the middle of the picture.
    pub target: Vec3,
    /// Up in the picture.
    pub up: Vec3,
    /// Full opening in degrees, along the axis that the scene's camera measures its own along; horizontally where that
    /// has none.
    pub fov_degrees: f32,
}

/// Options of a render. Equal scene, settings and number of passes give equal bits, whatever the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// What light does and how it is estimated.
    pub settings: Settings,
    /// Acceleration structure, by name.
    pub accel: String,
    /// Ray-triangle method, by name.
    pub intersect: String,
    /// How the acceleration structure is built; its method is the one above.
    pub build: BuildOptions,
    /// What surfaces do.
    pub surface_model: SurfaceModel,
    /// Pixels across and down; none: the scene's.
    pub size: Option<[u32; 2]>,
    /// Another view; none: the scene's.
    pub view: Option<View>,
    /// Window of the picture: x, y, width, height in pixels; none: the scene's.
    pub crop: Option<[u32; 4]>,
    /// Spheres become triangles that are off by at most this many scene units.
    pub tessellate: Option<f32>,
    /// Threads; none: all processors.
    pub threads: Option<usize>,
    /// Every query is written to this file, with its answer.
    pub record_queries: Option<PathBuf>,
    /// When to stop.
    pub stop: Stop,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            settings: Settings::default(),
            accel: ACCEL.default.to_owned(),
            intersect: INTERSECT.default.to_owned(),
            build: BuildOptions::default(),
            surface_model: SurfaceModel::default(),
            size: None,
            view: None,
            crop: None,
            tessellate: None,
            threads: None,
            record_queries: None,
            stop: Stop::default(),
        }
    }
}

/// Most rays of final gathering from a point.
const MOST_GATHER_RAYS: u32 = 65_536;
/// Most pixels of a picture's edge, and in all.
const MAX_EDGE: u32 = 65_536;
const MAX_PIXELS: u64 = 1 << 28;

impl RenderOptions {
    /// Checks what can be checked without a scene.
    ///
    /// # Errors
    /// [`Error::Setting`] and [`Error::UnknownName`] for the first option that makes no sense.
    pub fn check(&self) -> Result<()> {
        ACCEL.find(&self.accel)?;
        INTERSECT.find(&self.intersect)?;
        SEARCH.find(&self.settings.search)?;
        SUPPORT.find(&self.settings.support)?;
        KERNEL.find(self.settings.kernel_name())?;
        let positive = |option, value: Option<f32>| match value {
            Some(x) if !(x > 0.0 && x.is_finite()) => Err(Error::setting(option, "it must be a number above 0")),
            _ => Ok(()),
        };
        positive("--radius", self.settings.radius)?;
        positive("--caustic-radius", self.settings.caustic_radius)?;
        positive("--tessellate", self.tessellate)?;
        let counted = |option, value: Option<u32>| match value {
            Some(0) => Err(Error::setting(option, "it must be at least 1")),
            _ => Ok(()),
        };
        counted("--photons", self.settings.photons)?;
        counted("--knn", self.settings.knn)?;
        counted("--spp", Some(self.settings.spp))?;
        counted("--max-depth", self.settings.max_depth)?;
        if self.threads == Some(0) {
            return Err(Error::setting("--threads", "it must be at least 1"));
        }
        self.check_estimates()?;
        self.check_indirect()?;
        self.stop.check()
    }

    /// Checks what is said about estimates against the mode and the record.
    fn check_estimates(&self) -> Result<()> {
        let settings = &self.settings;
        let is_ball = SUPPORT.find(&settings.support)?.name == SUPPORT.default;
        let of_estimates = [
            ("--knn", settings.knn.is_some()),
            ("--caustic-radius", settings.caustic_radius.is_some()),
            ("--support", !is_ball),
            ("--kernel", settings.kernel.is_some()),
        ];
        if let Some((option, _)) = of_estimates.iter().find(|(_, given)| *given && settings.mode == Mode::Path) {
            return Err(Error::setting(option, "the path mode makes no estimates from photons; leave it out"));
        }
        if self.record_queries.is_some() {
            let is_recorded = matches!(KERNEL.find(settings.kernel_name())?.name, "constant" | "epanechnikov");
            let what = "records of queries know balls with the kernels constant and epanechnikov only; leave one of the two out";
            match (is_ball, is_recorded) {
                (false, _) => return Err(Error::setting("--support", what)),
                (true, false) => return Err(Error::setting("--kernel", what)),
                (true, true) => {}
            }
        }
        Ok(())
    }

    /// Checks how light after a diffuse bounce is estimated.
    fn check_indirect(&self) -> Result<()> {
        let settings = &self.settings;
        if !(1..=MOST_GATHER_RAYS).contains(&settings.gather_rays) {
            return Err(Error::setting("--gather-rays", format!("it must be 1 to {MOST_GATHER_RAYS}")));
        }
        if settings.irradiance_every == 0 {
            return Err(Error::setting("--irradiance-every", "it must be at least 1"));
        }
        if !(settings.cache_accuracy > 0.0 && settings.cache_accuracy <= 1.0) {
            return Err(Error::setting("--cache-accuracy", "it must be a number above 0, 1 at most"));
        }
        if settings.indirect != Indirect::Photons {
            if settings.mode != Mode::Gather {
                return Err(Error::setting("--indirect", "only the mode gather has a choice; add --mode gather"));
            }
            if self.record_queries.is_some() {
                let what = "only searches of --indirect photons are recorded; leave one of them out";
                return Err(Error::setting("--record-queries", what));
            }
        }
        if settings.shadow_photons && settings.mode != Mode::Gather {
            return Err(Error::setting("--shadow-photons", "only the mode gather has them; add --mode gather"));
        }
        if settings.shadow_photons && self.record_queries.is_some() {
            let what = "what shadow photons say is not recorded; leave one of them out";
            return Err(Error::setting("--record-queries", what));
        }
        Ok(())
    }

    /// What to say about estimates that are not corrected where they usually are.
    pub(super) fn uncorrected_edges(&self) -> Option<String> {
        let settings = &self.settings;
        let is_usual = matches!(settings.mode, Mode::Progressive | Mode::Gather) && !settings.corrects_edges();
        is_usual.then(|| {
            format!("estimates over {} are dark at edges: they are corrected for balls only", settings.support)
        })
    }

    /// Turns spheres into triangles where that is asked for; returns what to say about it.
    pub(super) fn tessellate_spheres(&self, scene: &mut Scene) -> Result<Option<String>> {
        let Some(max_deviation) = self.tessellate else { return Ok(None) };
        let done = tessellate::spheres(scene, max_deviation).ok_or_else(|| {
            Error::setting("--tessellate", format!("{max_deviation} needs too many triangles for a sphere; use more"))
        })?;
        let (spheres, triangles) = (done.spheres, done.triangles);
        Ok(Some(format!("{spheres} spheres became {triangles} triangles, off by at most {:.3e}", done.deviation)))
    }

    /// Puts the size, the view and the window into the scene.
    pub(super) fn apply(&self, scene: &mut Scene) -> Result<()> {
        if let Some([width, height]) = self.size {
            (scene.film.width, scene.film.height) = (width, height);
            // A window in pixels of another size means nothing.
            scene.film.crop = None;
        }
        let (width, height) = (scene.film.width, scene.film.height);
        let pixels = u64::from(width) * u64::from(height);
        if width == 0 || height == 0 || width > MAX_EDGE || height > MAX_EDGE || pixels > MAX_PIXELS {
            let what =
                format!("a picture of {width} x {height} pixels is beyond 1..={MAX_EDGE} or {MAX_PIXELS} in all");
            return Err(Error::setting("--size", what));
        }
        if let Some(view) = self.view {
            let axis = match scene.camera.projection {
                Projection::Perspective { axis, .. } | Projection::ThinLens { axis, .. } => axis,
                Projection::Orthographic { .. } => FovAxis::X,
            };
            let camera = &mut scene.camera;
            (camera.origin, camera.target, camera.up) = (view.origin, view.target, view.up);
            camera.projection = Projection::Perspective { fov_degrees: view.fov_degrees, axis };
            camera.mirrored = false;
            camera.principal_point = [0.0, 0.0];
            let distance = (view.target - view.origin).length();
            (camera.near_clip, camera.far_clip) = (1e-4 * distance, f32::INFINITY);
        }
        if let Some([x, y, w, h]) = self.crop {
            let inside = |start: u32, length: u32, whole: u32| length > 0 && start < whole && length <= whole - start;
            if !inside(x, w, width) || !inside(y, h, height) {
                let what =
                    format!("the window {x},{y},{w},{h} does not lie in the picture of {width} x {height} pixels");
                return Err(Error::setting("--crop", what));
            }
            scene.film.crop = Some([x, y, w, h]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_scene::builtin;

    #[test]
    fn defaults_make_sense() {
        RenderOptions::default().check().unwrap();
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        let with = |change: fn(&mut RenderOptions)| {
            let mut options = RenderOptions::default();
            change(&mut options);
            options.check().unwrap_err().to_string()
        };
        assert!(with(|o| o.settings.radius = Some(f32::NAN)).starts_with("--radius: "));
        assert!(with(|o| o.settings.photons = Some(0)).starts_with("--photons: "));
        assert!(with(|o| o.settings.gather_rays = 0).starts_with("--gather-rays: "));
        assert!(with(|o| o.settings.irradiance_every = 0).starts_with("--irradiance-every: "));
        assert!(with(|o| o.settings.cache_accuracy = f32::NAN).starts_with("--cache-accuracy: "));
        assert!(with(|o| o.settings.indirect = Indirect::FinalGather).starts_with("--indirect: "));
        assert!(with(|o| o.settings.shadow_photons = true).starts_with("--shadow-photons: "));
        assert!(with(|o| o.tessellate = Some(-1.0)).starts_with("--tessellate: "));
        assert!(with(|o| o.settings.caustic_radius = Some(0.0)).starts_with("--caustic-radius: "));
        assert!(with(|o| o.settings.support = "boxfixed".into()).contains("did you mean box-fixed?"));
        assert!(with(|o| o.settings.kernel = Some("gauss".into())).contains("did you mean gaussian?"));
        let path = || Settings { mode: Mode::Path, ..Settings::default() };
        for (option, settings) in [
            ("--knn: ", Settings { knn: Some(9), ..path() }),
            ("--caustic-radius: ", Settings { caustic_radius: Some(1.0), ..path() }),
            ("--support: ", Settings { support: "disc".into(), ..path() }),
            ("--kernel: ", Settings { kernel: Some("cone".into()), ..path() }),
        ] {
            let options = RenderOptions { settings, ..RenderOptions::default() };
            assert!(options.check().unwrap_err().to_string().starts_with(option), "{option}");
        }
        let mut options = RenderOptions { record_queries: Some("q".into()), ..RenderOptions::default() };
        options.settings.kernel = Some("constant".into());
        options.check().unwrap();
        options.settings.kernel = Some("gaussian".into());
        assert!(options.check().unwrap_err().to_string().starts_with("--kernel: "));
        options.settings.support = "box_polygon".into();
        assert!(options.check().unwrap_err().to_string().starts_with("--support: "));
        assert!(with(|o| o.threads = Some(0)).starts_with("--threads: "));
        assert!(with(|o| o.accel = "wide-bhv".into()).contains("did you mean wide-bvh?"));
        assert!(with(|o| o.stop.time_secs = Some(f64::INFINITY)).starts_with("--time: "));
    }

    #[test]
    fn windows_must_lie_in_the_picture() {
        let apply = |size, crop| {
            let options = RenderOptions { size: Some(size), crop: Some(crop), ..RenderOptions::default() };
            let mut scene = builtin::build("furnace").unwrap();
            options.apply(&mut scene).map(|()| scene.film.crop)
        };
        assert_eq!(apply([64, 48], [60, 40, 4, 8]).unwrap(), Some([60, 40, 4, 8]));
        for crop in [[60, 40, 5, 8], [0, 48, 1, 1], [0, 0, 0, 1], [u32::MAX, 0, 2, 1]] {
            assert!(apply([64, 48], crop).is_err(), "{crop:?}");
        }
        assert!(apply([0, 48], [0, 0, 1, 1]).is_err());
    }
}
