//! Numbers: the [`Scalar`] trait that every ray-triangle method is written over, a scalar that counts its
//! operations, and counter-based random numbers.
//!
//! Nothing here holds state between calls: a random number is a function of a seed, a stream and an index, so that
//! any thread may compute any sample and get the same bits.

mod counted;
mod philox;
mod sampler;
mod scalar;
mod sobol;
mod splitmix;

pub use counted::{Counted, OpCounts};
pub use philox::philox4x32;
pub use sampler::{Sampler, StreamKind, unit_f32};
pub use scalar::Scalar;
