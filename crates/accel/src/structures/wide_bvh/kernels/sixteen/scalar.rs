//! Plain arrays.

use super::Sixteen;
use crate::structures::wide_bvh::layout::WIDTH;
use crate::structures::wide_bvh::packet::{ByRay, PACKET};
use photinus_intersect::doubles::Lanes;
use std::ops::{Add, Div, Mul, Sub};

/// Sixteen numbers.
#[derive(Clone, Copy)]
pub struct Plain(pub ByRay);

impl Plain {
    #[inline(always)]
    fn with(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    #[inline(always)]
    fn mask(self, other: Self, f: impl Fn(f32, f32) -> bool) -> u16 {
        (0..PACKET).fold(0, |mask, i| mask | u16::from(f(self.0[i], other.0[i])) << i)
    }
}

impl Add for Plain {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl Sub for Plain {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl Mul for Plain {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| a * b)
    }
}

impl Div for Plain {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.with(other, |a, b| a / b)
    }
}

impl Sixteen for Plain {
    type Half = Lanes<8>;

    #[inline(always)]
    fn all(self, x: f32) -> Self {
        Self([x; PACKET])
    }

    #[inline(always)]
    fn twice(self, from: &[f32; WIDTH]) -> Self {
        Self(std::array::from_fn(|i| from[i % WIDTH]))
    }

    #[inline(always)]
    fn halved(self, first: f32, second: f32) -> Self {
        Self(std::array::from_fn(|i| if i < WIDTH { first } else { second }))
    }

    #[inline(always)]
    fn load(self, from: &ByRay) -> Self {
        Self(*from)
    }

    #[inline(always)]
    fn store(self, to: &mut ByRay) {
        *to = self.0;
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.with(other, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.with(other, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u16 {
        self.mask(other, |a, b| a < b)
    }

    #[inline(always)]
    fn le(self, other: Self) -> u16 {
        self.mask(other, |a, b| a <= b)
    }

    #[inline(always)]
    fn extremes(self) -> [f32; 2] {
        self.0.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[least, greatest], x| [least.min(*x), greatest.max(*x)])
    }

    #[inline(always)]
    fn select(self, mask: u16, other: Self) -> Self {
        Self(std::array::from_fn(|i| if mask >> i & 1 == 1 { self.0[i] } else { other.0[i] }))
    }

    #[inline(always)]
    fn halves(self) -> [Lanes<8>; 2] {
        [Lanes(std::array::from_fn(|i| f64::from(self.0[i]))), Lanes(std::array::from_fn(|i| f64::from(self.0[8 + i])))]
    }

    #[inline(always)]
    fn rounded([first, second]: [Lanes<8>; 2]) -> Self {
        Self(std::array::from_fn(|i| if i < 8 { first.0[i] as f32 } else { second.0[i - 8] as f32 }))
    }
}
