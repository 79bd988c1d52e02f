//! `photinus render`: what is rendered, how, for how long, and where the results go.

use super::members::parser;
use super::structure::StructureArgs;
use super::values::{self, CameraValue, Size};
use clap::Args;
use photinus::names;
use std::path::PathBuf;

/// `photinus render`.
#[derive(Debug, Args)]
pub struct RenderArgs {
    /// A scene file or the name of a built-in scene
    #[arg(default_value = names::SCENES.default)]
    pub scene: String,
    /// The picture; linear layers in EXR, tone mapped in PNG [default: SCENE.png here]
    #[arg(short, long, value_name = "OUT.{png,exr}", value_parser = output)]
    pub output: Option<Output>,
    /// Let the scene read files outside the folder of its own file
    #[arg(long)]
    pub allow_outside: bool,

    /// How light is found
    #[arg(long, value_name = "NAME", default_value = names::MODE.default, value_parser = parser(names::MODE),
        help_heading = "Light")]
    pub mode: String,
    /// Photons emitted: per pass in progressive, in all in direct and gather [default: by the picture's size]
    #[arg(long, value_name = "N", value_parser = values::count, help_heading = "Light")]
    pub photons: Option<u32>,
    /// Gather radius in scene units: fixed in direct and gather, the first one in progressive [default: from the
    /// pixel's footprint and the density of photons]
    #[arg(long, value_name = "R", value_parser = values::positive_f32, help_heading = "Light")]
    pub radius: Option<f32>,
    /// Gather radius of caustics in scene units; in direct it puts caustic photons into a map of their own [default: as
    /// --radius, or chosen; one map in direct]
    #[arg(long, value_name = "R", value_parser = values::positive_f32, help_heading = "Light")]
    pub caustic_radius: Option<f32>,
    /// Where the photons of an estimate lie, and by which area their light is divided
    #[arg(long, value_name = "NAME", default_value = names::SUPPORT.default, value_parser = parser(names::SUPPORT),
        help_heading = "Light")]
    pub support: String,
    /// How photons of an estimate are weighted by their distance d within the radius r [default: epanechnikov in
    /// progressive, else constant]
    #[arg(long, value_name = "NAME", value_parser = parser(names::KERNEL), help_heading = "Light")]
    pub kernel: Option<String>,
    /// Most photons of one estimate, the nearest [default: no limit]
    #[arg(long, value_name = "K", value_parser = values::count, help_heading = "Light")]
    pub knn: Option<u32>,
    /// How light after a diffuse bounce is estimated, in the mode gather
    #[arg(long, value_name = "NAME", default_value = names::INDIRECT.default, value_parser = parser(names::INDIRECT),
        help_heading = "Light")]
    pub indirect: String,
    /// Rays of final gathering from a point; four times as many from records of the irradiance cache
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = values::count, help_heading = "Light")]
    pub gather_rays: u32,
    /// Compute irradiance at one photon in N, for all of --indirect but photons
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = values::count, help_heading = "Light")]
    pub irradiance_every: u32,
    /// Error up to which a record of the irradiance cache is used, 0 to 1: Ward's a
    #[arg(long, value_name = "A", default_value_t = 0.2, value_parser = values::positive_f32, help_heading = "Light")]
    pub cache_accuracy: f32,
    /// Send no shadow rays where photons that go on through surfaces tell what is lit, in the mode gather
    #[arg(long, help_heading = "Light")]
    pub shadow_photons: bool,
    /// Eye samples a pixel and pass
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = values::count, help_heading = "Light")]
    pub spp: u32,
    /// Most edges of a path from camera to light; 1 sees lights only [default: as the scene says, or no limit]
    #[arg(long, value_name = "N", value_parser = values::count, help_heading = "Light")]
    pub max_depth: Option<u32>,
    /// What surfaces do
    #[arg(long, value_name = "NAME", default_value = names::SURFACE_MODEL.default,
        value_parser = parser(names::SURFACE_MODEL), help_heading = "Light")]
    pub surface_model: String,
    /// Seed of all random numbers: equal seeds give equal bits
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = "Light")]
    pub seed: u64,

    /// Stop after so many seconds, counted from the start of the program
    #[arg(long, value_name = "S", value_parser = values::positive, help_heading = "When to stop, whichever comes first")]
    pub time: Option<f64>,
    /// Stop after so many seconds of processor time, all threads together
    #[arg(long, value_name = "S", value_parser = values::positive, help_heading = "When to stop, whichever comes first")]
    pub cpu_time: Option<f64>,
    /// Stop after so many passes [default: 32 where no other stop is given]
    #[arg(long, value_name = "N", value_parser = values::count, help_heading = "When to stop, whichever comes first")]
    pub passes: Option<u32>,
    /// Stop when the mean relative squared error of the pixels, estimated from the passes, is at most E
    #[arg(long, value_name = "E", value_parser = values::positive, help_heading = "When to stop, whichever comes first")]
    pub target_error: Option<f64>,

    /// Size of the picture in pixels [default: as the scene says]
    #[arg(long, value_name = "WxH", value_parser = values::size, help_heading = "View")]
    pub size: Option<Size>,
    /// Another view: ten numbers, the last the opening in degrees along the axis that the scene's camera measures its
    /// own along, or horizontally [default: as the scene says]
    #[arg(long, value_name = "ORIGIN,TARGET,UP,FOV", value_parser = values::camera, allow_hyphen_values = true,
        help_heading = "View")]
    pub camera: Option<CameraValue>,
    /// Render only this window of the picture, in pixels from the top left
    #[arg(long, value_name = "X,Y,W,H", value_parser = values::crop, help_heading = "View")]
    pub crop: Option<[u32; 4]>,

    /// The acceleration structure
    #[arg(long, value_name = "NAME", default_value = names::ACCEL.default, value_parser = parser(names::ACCEL),
        help_heading = "Members")]
    pub accel: String,
    /// The ray-triangle method; the wide tree has its own kernel
    #[arg(long, value_name = "NAME", default_value = names::INTERSECT.default, value_parser = parser(names::INTERSECT),
        help_heading = "Members")]
    pub intersect: String,
    /// The photon search
    #[arg(long, value_name = "NAME", default_value = names::SEARCH.default, value_parser = parser(names::SEARCH),
        help_heading = "Members")]
    pub search: String,
    /// What answers ray and photon queries
    #[arg(long, value_name = "NAME", default_value = names::BACKEND.default, value_parser = parser(names::BACKEND),
        help_heading = "Members")]
    pub backend: String,
    /// Configuration of the hardware behind --backend (not built yet)
    #[arg(long, value_name = "NAME|FILE.toml", help_heading = "Members")]
    pub hardware: Option<String>,
    #[command(flatten)]
    pub structure: StructureArgs,
    /// Replace spheres by triangles that are off by at most E scene units
    #[arg(long, value_name = "E", value_parser = values::positive_f32, help_heading = "Members")]
    pub tessellate: Option<f32>,
    /// Threads [default: all processors]
    #[arg(long, value_name = "N", value_parser = values::threads, help_heading = "Members")]
    pub threads: Option<usize>,

    /// More layers in the EXR file
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = parser(names::AOV),
        help_heading = "Results")]
    pub aov: Vec<String>,
    /// Tone curve of a PNG file
    #[arg(long, value_name = "NAME", default_value = names::TONEMAP.default, value_parser = parser(names::TONEMAP),
        help_heading = "Results")]
    pub tonemap: String,
    /// Brightness of a PNG file in stops: light is multiplied by 2^EV
    #[arg(long, value_name = "EV", default_value_t = 0.0, value_parser = values::finite_f32,
        allow_hyphen_values = true, help_heading = "Results")]
    pub exposure: f32,
    /// Remove noise from the finished picture (not built yet)
    #[arg(long, help_heading = "Results")]
    pub denoise: bool,
    /// Write counts, seconds and memory as JSON
    #[arg(long, value_name = "FILE.json", help_heading = "Results")]
    pub stats: Option<PathBuf>,
    /// Count the work of one query in N, for the profile; 1: of all, 0: no profile
    #[arg(long, value_name = "N", default_value_t = 64, help_heading = "Results")]
    pub profile_every: u32,
    /// Print the same JSON document on standard output, and nothing else
    #[arg(long, help_heading = "Results")]
    pub json: bool,
    /// No progress, no warnings
    #[arg(long, help_heading = "Results")]
    pub quiet: bool,
    /// Go on from a file of an earlier render (not built yet)
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    pub resume: Option<PathBuf>,
    /// Record every ray and search with what led to it and its answer, some 60 bytes each, see docs/queries.md
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    pub record_queries: Option<PathBuf>,
}

/// The picture's file, of a kind that its name tells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Output {
    /// Tone mapped.
    Png(PathBuf),
    /// Linear, with layers.
    Exr(PathBuf),
}

fn output(text: &str) -> Result<Output, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("png") => Ok(Output::Png(path)),
        Some("exr") => Ok(Output::Exr(path)),
        _ => Err("its name must end in .png or .exr".into()),
    }
}
