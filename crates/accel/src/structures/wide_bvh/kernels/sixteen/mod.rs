//! A number for each of the sixteen rays of a packet, in the registers of one instruction set: what the tests of packets
//! are written in once for all sets.

#[cfg(target_arch = "x86_64")]
pub mod avx2;
#[cfg(target_arch = "x86_64")]
pub mod avx512;
pub mod scalar;

use crate::structures::wide_bvh::layout::WIDTH;
use crate::structures::wide_bvh::packet::ByRay;
use photinus_intersect::doubles::Doubles;
use std::ops::{Add, Div, Mul, Sub};

/// Sixteen numbers. Having one proves that the machine can run its instructions: kernels make the first ones.
///
/// Comparisons are false where a side is not a number; masks hold the first ray in the lowest bit.
pub trait Sixteen: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    /// Half of them in doubles.
    type Half: Doubles;

    /// The same number for all, in the registers of `self`.
    fn all(self, x: f32) -> Self;

    /// Eight numbers from memory, twice.
    fn twice(self, from: &[f32; WIDTH]) -> Self;

    /// The same number for the first eight, and another for the rest.
    fn halved(self, first: f32, second: f32) -> Self;

    /// Numbers from memory, into the registers of `self`.
    fn load(self, from: &ByRay) -> Self;

    /// Numbers to memory.
    fn store(self, to: &mut ByRay);

    /// The smaller of each two; that of `other` where one is not a number.
    fn min(self, other: Self) -> Self;

    /// The larger of each two; that of `other` where one is not a number.
    fn max(self, other: Self) -> Self;

    /// Magnitudes.
    fn abs(self) -> Self;

    /// Which are less.
    fn lt(self, other: Self) -> u16;

    /// Which are less or equal.
    fn le(self, other: Self) -> u16;

    /// The least and the greatest of all; undefined where one is not a number.
    fn extremes(self) -> [f32; 2];

    /// Those of a mask, and of `other` where it has no bit.
    fn select(self, mask: u16, other: Self) -> Self;

    /// All in doubles, which is exact.
    fn halves(self) -> [Self::Half; 2];

    /// The nearest to doubles.
    fn rounded(halves: [Self::Half; 2]) -> Self;
}
