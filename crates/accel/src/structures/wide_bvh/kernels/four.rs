//! Four doubles in a register of AVX, for the kernels that have it.

use super::Four;
use photinus_intersect::doubles::Doubles;
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Sub};

/// Four doubles.
#[derive(Clone, Copy)]
pub struct AvxFour(__m256d);

impl AvxFour {
    /// Zeros, from which others are made.
    ///
    /// # Safety
    ///
    /// The machine must have AVX2.
    #[inline(always)]
    pub unsafe fn zeros() -> Self {
        // SAFETY: as the caller promises.
        unsafe { Self(_mm256_setzero_pd()) }
    }
}

impl Add for AvxFour {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self(_mm256_add_pd(self.0, other.0)) }
    }
}

impl Sub for AvxFour {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self(_mm256_sub_pd(self.0, other.0)) }
    }
}

impl Mul for AvxFour {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self(_mm256_mul_pd(self.0, other.0)) }
    }
}

impl Div for AvxFour {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self(_mm256_div_pd(self.0, other.0)) }
    }
}

impl Doubles for AvxFour {
    #[inline(always)]
    fn all(self, x: f64) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self(_mm256_set1_pd(x)) }
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u8 {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0)) as u8 }
    }
}

impl Four for AvxFour {
    #[inline(always)]
    fn load(self, from: &[f32; 4]) -> Self {
        // SAFETY: `self` proves that the machine has AVX2; the load is of four words.
        unsafe { Self(_mm256_cvtps_pd(_mm_loadu_ps(from.as_ptr()))) }
    }

    #[inline(always)]
    fn rounded(self) -> [f32; 4] {
        let mut out = [0.0; 4];
        // SAFETY: `self` proves that the machine has AVX2; the store is of four words.
        unsafe { _mm_storeu_ps(out.as_mut_ptr(), _mm256_cvtpd_ps(self.0)) };
        out
    }
}
