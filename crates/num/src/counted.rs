//! A scalar that counts the operations spent on it.

use crate::Scalar;
use std::cell::Cell;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Arithmetic operations of one computation, as Tables 11 and 12 of the thesis count them, and arc cosines apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OpCounts {
    /// Additions.
    pub add: u64,
    /// Subtractions.
    pub sub: u64,
    /// Multiplications.
    pub mul: u64,
    /// Divisions.
    pub div: u64,
    /// Square roots.
    pub sqrt: u64,
    /// Arc cosines, which the tables leave out.
    pub acos: u64,
}

impl OpCounts {
    /// The larger count of each operation: what a pipeline holds that can take either way.
    pub fn max(self, other: Self) -> Self {
        Self {
            add: self.add.max(other.add),
            sub: self.sub.max(other.sub),
            mul: self.mul.max(other.mul),
            div: self.div.max(other.div),
            sqrt: self.sqrt.max(other.sqrt),
            acos: self.acos.max(other.acos),
        }
    }
}

/// A double whose operations are counted in the [`Cell`] it was made with.
///
/// Constants made by [`Scalar::from_f64`] belong to no counter; an operation counts where either operand does.
#[derive(Clone, Copy, Debug)]
pub struct Counted<'a> {
    value: f64,
    counts: Option<&'a Cell<OpCounts>>,
}

impl<'a> Counted<'a> {
    /// An input value whose uses are counted in `counts`.
    pub fn new(value: f64, counts: &'a Cell<OpCounts>) -> Self {
        Self { value, counts: Some(counts) }
    }

    fn count(self, other: Option<&'a Cell<OpCounts>>, bump: impl Fn(&mut OpCounts)) -> Option<&'a Cell<OpCounts>> {
        let counter = self.counts.or(other);
        if let Some(cell) = counter {
            let mut counts = cell.get();
            bump(&mut counts);
            cell.set(counts);
        }
        counter
    }
}

impl Add for Counted<'_> {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        let counts = self.count(rhs.counts, |c| c.add += 1);
        Self { value: self.value + rhs.value, counts }
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "counting adds one to a counter")]
impl Sub for Counted<'_> {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        let counts = self.count(rhs.counts, |c| c.sub += 1);
        Self { value: self.value - rhs.value, counts }
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "counting adds one to a counter")]
impl Mul for Counted<'_> {
    type Output = Self;
    fn mul(self, rhs: Self) -> Self {
        let counts = self.count(rhs.counts, |c| c.mul += 1);
        Self { value: self.value * rhs.value, counts }
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "counting adds one to a counter")]
impl Div for Counted<'_> {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        let counts = self.count(rhs.counts, |c| c.div += 1);
        Self { value: self.value / rhs.value, counts }
    }
}

impl Neg for Counted<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, counts: self.counts }
    }
}

impl PartialEq for Counted<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl PartialOrd for Counted<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl Scalar for Counted<'_> {
    fn from_f64(x: f64) -> Self {
        Self { value: x, counts: None }
    }
    fn to_f64(self) -> f64 {
        self.value
    }
    fn sqrt(self) -> Self {
        let counts = self.count(None, |c| c.sqrt += 1);
        Self { value: self.value.sqrt(), counts }
    }
    fn abs(self) -> Self {
        Self { value: self.value.abs(), counts: self.counts }
    }
    fn epsilon() -> Self {
        Self::from_f64(f64::EPSILON)
    }
    fn acos(self) -> Self {
        let counts = self.count(None, |c| c.acos += 1);
        Self { value: libm::acos(self.value), counts }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_each_operation_once() {
        let cell = Cell::new(OpCounts::default());
        let a = Counted::new(2.0, &cell);
        let b = Counted::new(3.0, &cell);
        let r = (a * b + a - Counted::one()) / b.sqrt();
        assert!((r.to_f64() - 7.0 / 3f64.sqrt()).abs() < 1e-15);
        let counts = OpCounts { add: 1, sub: 1, mul: 1, div: 1, sqrt: 1, acos: 0 };
        assert_eq!(cell.get(), counts);
        assert!((Counted::new(0.5, &cell).acos().to_f64() - std::f64::consts::FRAC_PI_3).abs() < 1e-15);
        assert_eq!(cell.get(), OpCounts { acos: 1, ..counts });
        assert_eq!(counts.max(OpCounts { add: 3, ..OpCounts::default() }), OpCounts { add: 3, ..counts });
    }
}
