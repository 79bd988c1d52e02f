//! The number type that a ray-triangle method is written over.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number system: `f32`, `f64`, a counting scalar, a logarithmic number system.
///
/// Results of the four operations are rounded by the number system itself; methods written over `Scalar` must not
/// assume more than a total order of finite values.
pub trait Scalar:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The nearest value to `x` that the number system holds.
    fn from_f64(x: f64) -> Self;
    /// The value as a double, exact for `f32` and `f64`.
    fn to_f64(self) -> f64;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// The relative spacing of values near one: from one to the next larger value.
    fn epsilon() -> Self;
    /// Arc cosine in radians, by way of doubles: no number system in hardware has it.
    fn acos(self) -> Self {
        Self::from_f64(libm::acos(self.to_f64()))
    }
    /// Zero.
    fn zero() -> Self {
        Self::from_f64(0.0)
    }
    /// One.
    fn one() -> Self {
        Self::from_f64(1.0)
    }
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool {
        self.to_f64().is_finite()
    }
}

impl Scalar for f32 {
    fn from_f64(x: f64) -> Self {
        x as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }
    fn abs(self) -> Self {
        f32::abs(self)
    }
    fn epsilon() -> Self {
        f32::EPSILON
    }
}

impl Scalar for f64 {
    fn from_f64(x: f64) -> Self {
        x
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    fn abs(self) -> Self {
        f64::abs(self)
    }
    fn epsilon() -> Self {
        f64::EPSILON
    }
}
