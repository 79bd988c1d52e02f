//! What a render is to do.

use crate::film::Aov;
use crate::indirect::Indirect;
use photinus_photons::{DEFAULT_SUPPORT, find_support};
use serde::Serialize;

/// How light is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// Independent photon passes with a shrinking radius; the default.
    Progressive,
    /// One photon map with a fixed radius, many eye passes.
    Gather,
    /// The thesis's renderer: one map, an estimate at every hit, no shadow rays.
    Direct,
    /// A path tracer: ground truth.
    Path,
}

impl Mode {
    /// Every one.
    pub const ALL: [Self; 4] = [Self::Progressive, Self::Gather, Self::Direct, Self::Path];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Progressive => "progressive",
            Self::Gather => "gather",
            Self::Direct => "direct",
            Self::Path => "path",
        }
    }

    /// The one of this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.name() == name)
    }
}

/// Settings of a render. Equal settings and scene give equal bits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Settings {
    /// How light is found.
    pub mode: Mode,
    /// Photons emitted: a pass in progressive, in all in direct and gather; none: chosen from the picture's size.
    pub photons: Option<u32>,
    /// Gather radius in scene units: fixed in direct and gather, of the first pass in progressive; none: chosen from
    /// the pixel's footprint and the photon density at visible points.
    pub radius: Option<f32>,
    /// Gather radius of caustics in scene units, fixed or first as the other one. In direct it takes caustic photons into a
    /// map of their own. None: as the other radius where that is given, chosen in progressive and gather, one map in direct.
    pub caustic_radius: Option<f32>,
    /// Most photons of one estimate, the nearest; none: no limit.
    pub knn: Option<u32>,
    /// Support of an estimate, by its name.
    pub support: String,
    /// Kernel of an estimate, by its name; none: Epanechnikov's in progressive, else the constant one.
    pub kernel: Option<String>,
    /// Eye samples a pixel and pass, at least 1.
    pub spp: u32,
    /// Most edges of a path, camera to light: 1 sees emission only; none: as the scene says, or no limit.
    pub max_depth: Option<u32>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// How light after a diffuse bounce is estimated at visible points; in gather mode only.
    pub indirect: Indirect,
    /// Rays of final gathering from each visible point, 1 to 65,536; four times as many from records of the cache.
    pub gather_rays: u32,
    /// Irradiance is computed at one photon in so many, at least 1.
    pub irradiance_every: u32,
    /// Ward's a of the irradiance cache, above 0, 1 at most: records are used where the error is estimated below it.
    pub cache_accuracy: f32,
    /// Shadow photons tell where shadow rays are not needed; in gather mode only.
    pub shadow_photons: bool,
    /// Photon search, by its name.
    pub search: String,
    /// Pictures beside the beauty.
    pub aovs: Vec<Aov>,
    /// Variance is tracked for a stop on error.
    pub track_error: bool,
    /// One query in this many is counted and timed by the instrumented twin; 0: no profile. The picture's bits are the
    /// same.
    pub profile_every: u32,
}

impl Settings {
    /// Name of the kernel of its estimates.
    pub fn kernel_name(&self) -> &str {
        self.kernel.as_deref().unwrap_or(match self.mode {
            Mode::Progressive => "epanechnikov",
            _ => "constant",
        })
    }

    /// Whether estimates whose support is cut by a wall or a rim are divided by what is there of it: where shadow rays give
    /// the direct light, and the support is as good as the ball.
    pub fn corrects_edges(&self) -> bool {
        let is_ball = find_support(&self.support).is_ok_and(|support| support.is_ball);
        is_ball && matches!(self.mode, Mode::Progressive | Mode::Gather)
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            mode: Mode::Progressive,
            photons: None,
            radius: None,
            caustic_radius: None,
            knn: None,
            support: DEFAULT_SUPPORT.to_owned(),
            kernel: None,
            spp: 1,
            max_depth: None,
            seed: 0,
            indirect: Indirect::Photons,
            gather_rays: 64,
            irradiance_every: 4,
            cache_accuracy: 0.2,
            shadow_photons: false,
            search: "grid".to_owned(),
            aovs: Vec::new(),
            track_error: false,
            profile_every: 64,
        }
    }
}
