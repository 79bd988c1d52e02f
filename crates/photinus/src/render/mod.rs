//! Rendering: options in, picture and statistics out.

mod measured;
mod memory;
mod options;
mod picture;
mod recorder;
mod session;
mod stats;
mod stop;
mod timeline;

pub use photinus_render::bsdf::SurfaceModel;
pub use photinus_render::{Aov, Mode, Observer, Phase, PhotonPower, RayCounts, Settings, Silent};

pub use memory::{MemoryPrediction, Owner};
pub use options::{RenderOptions, View};
pub use picture::Picture;
pub use session::{PassState, Plan, Rendered, Session, Watcher};
pub use stats::{AccelStats, MemoryStats, PhaseStats, PhotonStats, RayStats, Seconds, Stats};
pub use stop::{Stop, StopReason};
