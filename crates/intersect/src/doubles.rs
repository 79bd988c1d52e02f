//! Several doubles at once, of which the last part of a ray-triangle test is made without branches.

use std::ops::{Add, Div, Mul, Sub};

/// Doubles in the registers of some instruction set, at most eight. Comparisons are false where a side is not a number; masks
/// hold the first in the lowest bit.
pub trait Doubles: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    /// The same number for all, in the registers of `self`.
    fn all(self, x: f64) -> Self;

    /// Which are less.
    fn lt(self, other: Self) -> u8;
}

/// Doubles in an array.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<const N: usize>(pub [f64; N]);

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn with(mut self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        for i in 0..N {
            self.0[i] = f(self.0[i], other.0[i]);
        }
        self
    }
}

impl<const N: usize> Add for Lanes<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl<const N: usize> Sub for Lanes<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl<const N: usize> Mul for Lanes<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| a * b)
    }
}

impl<const N: usize> Div for Lanes<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.with(other, |a, b| a / b)
    }
}

impl<const N: usize> Doubles for Lanes<N> {
    #[inline(always)]
    fn all(self, x: f64) -> Self {
        Self([x; N])
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u8 {
        let mut mask = 0;
        for i in 0..N {
            mask |= u8::from(self.0[i] < other.0[i]) << i;
        }
        mask
    }
}
