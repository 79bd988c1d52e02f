//! The profile of a render: plain data, returned and merged, never global.
//!
//! It is the contract between the renderer and the hardware models: counts are exact, seconds are wall or processor
//! seconds as their names say.

mod counters;
mod profile;
pub mod queries;
mod thread_time;
mod ticks;

pub use counters::{EstimateTicks, IntersectCounters, RayTicks, SearchCounters, TraversalCounters};
pub use profile::{
    AccelProfile, IntersectProfile, PhotonProfile, Profile, ProfileSeconds, RayProfile, Row, SearchProfile,
    accelerated_share,
};
pub use thread_time::{thread_nanoseconds, undisturbed};
pub use ticks::{ticks, ticks_of_a_stamp};
