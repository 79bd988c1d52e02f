//! The two steps of the hot loop, sixteen triangles of one ray at a time, once per instruction set.
//!
//! Both only leave out what cannot be hit, and hits are finished in doubles: results do not depend on the kernel. All
//! leave out the same, save where products overflow.

#[cfg(target_arch = "x86_64")]
pub mod avx2;
#[cfg(target_arch = "x86_64")]
pub mod avx512;
pub mod scalar;

use super::layout::{Boxes, CHUNK, Vertices};
use super::sieve::Sieve;
use crate::reach::Reach;
use photinus_intersect::methods::woop::Started;

/// A kernel: the steps of one instruction set. Having one proves that the machine can run it.
pub trait Kernel: Copy {
    /// Writes the indices of those of `boxes`, [`CHUNK`] at most, of which any passes the sieve to the front of `passed`,
    /// in order, and returns how many they are.
    fn sift(self, sieve: &Sieve, boxes: &[Boxes], passed: &mut [u8; CHUNK]) -> usize;

    /// Triangles that the ray may hit within its reach, as a mask of lanes: `woop`'s own filter.
    fn filter(self, ray: &Started<f32>, reach: &Reach, block: &Vertices) -> u16;
}
