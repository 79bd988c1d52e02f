//! The two steps of the hot loop, sixteen triangles of one ray at a time, once per instruction set.
//!
//! Both only leave out what cannot be hit, and hits are finished in doubles: results do not depend on the kernel. All
//! leave out the same, save where products overflow.

#[cfg(target_arch = "x86_64")]
pub mod avx2;
#[cfg(target_arch = "x86_64")]
pub mod avx512;
pub mod scalar;

#[cfg(doc)]
use super::layout::CHUNK;
use super::layout::{Boxes, Vertices};
use super::sieve::Sieve;
use crate::reach::Reach;
use photinus_intersect::methods::woop::Started;

/// A kernel: the steps of one instruction set. Having one proves that the machine can run it.
pub trait Kernel: Copy {
    /// Those of `boxes`, [`CHUNK`] at most, of which any passes the sieve, as a mask of their indices.
    fn sift(self, sieve: &Sieve, boxes: &[Boxes]) -> u64;

    /// Triangles that the ray may hit within its reach, as a mask of lanes: `woop`'s own filter.
    fn filter(self, ray: &Started<f32>, reach: &Reach, block: &Vertices) -> u16;
}
