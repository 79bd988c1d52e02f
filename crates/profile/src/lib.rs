//! The profile of a render: plain data, returned and merged, never global.
//!
//! It is the contract between the renderer and the hardware models: counts are exact, seconds are wall or processor
//! seconds as their names say.

mod counters;

pub use counters::{IntersectCounters, SearchCounters, TraversalCounters};
