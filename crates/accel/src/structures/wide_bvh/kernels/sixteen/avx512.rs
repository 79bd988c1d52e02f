//! One register of AVX-512F.

use super::Sixteen;
use crate::structures::wide_bvh::layout::WIDTH;
use crate::structures::wide_bvh::packet::ByRay;
use photinus_intersect::doubles::Doubles;
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Sub};

/// Sixteen numbers.
#[derive(Clone, Copy)]
pub struct One(__m512);

impl One {
    /// Zeros, from which others are made.
    ///
    /// # Safety
    ///
    /// The machine must have AVX-512F and DQ.
    #[inline(always)]
    pub unsafe fn zeros() -> Self {
        // SAFETY: as the caller promises.
        unsafe { Self(_mm512_setzero_ps()) }
    }

    /// Eight numbers and eight more.
    ///
    /// # Safety
    ///
    /// The machine must have AVX-512F and DQ.
    #[inline(always)]
    pub unsafe fn from_halves(first: __m256, second: __m256) -> Self {
        // SAFETY: as the caller promises.
        unsafe { Self(_mm512_insertf32x8::<1>(_mm512_castps256_ps512(first), second)) }
    }
}

impl Add for One {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_add_ps(self.0, other.0)) }
    }
}

impl Sub for One {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_sub_ps(self.0, other.0)) }
    }
}

impl Mul for One {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_mul_ps(self.0, other.0)) }
    }
}

impl Div for One {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_div_ps(self.0, other.0)) }
    }
}

impl Sixteen for One {
    type Half = OneHalf;

    #[inline(always)]
    fn all(self, x: f32) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_set1_ps(x)) }
    }

    #[inline(always)]
    fn twice(self, from: &[f32; WIDTH]) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F and DQ; the load is of eight words.
        unsafe { Self(_mm512_broadcast_f32x8(_mm256_loadu_ps(from.as_ptr()))) }
    }

    #[inline(always)]
    fn halved(self, first: f32, second: f32) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_mask_blend_ps(0xFF00, _mm512_set1_ps(first), _mm512_set1_ps(second))) }
    }

    #[inline(always)]
    fn load(self, from: &ByRay) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F; the load is of sixteen words.
        unsafe { Self(_mm512_loadu_ps(from.as_ptr())) }
    }

    #[inline(always)]
    fn store(self, to: &mut ByRay) {
        // SAFETY: `self` proves that the machine has AVX-512F; the store is of sixteen words.
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), self.0) }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_min_ps(self.0, other.0)) }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_max_ps(self.0, other.0)) }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_abs_ps(self.0)) }
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u16 {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) }
    }

    #[inline(always)]
    fn le(self, other: Self) -> u16 {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) }
    }

    #[inline(always)]
    fn extremes(self) -> [f32; 2] {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { [_mm512_reduce_min_ps(self.0), _mm512_reduce_max_ps(self.0)] }
    }

    #[inline(always)]
    fn select(self, mask: u16, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_mask_blend_ps(mask, other.0, self.0)) }
    }

    #[inline(always)]
    fn halves(self) -> [OneHalf; 2] {
        // SAFETY: `self` proves that the machine has AVX-512F and DQ.
        unsafe {
            let second = _mm512_extractf32x8_ps::<1>(self.0);
            [OneHalf(_mm512_cvtps_pd(_mm512_castps512_ps256(self.0))), OneHalf(_mm512_cvtps_pd(second))]
        }
    }

    #[inline(always)]
    fn rounded([first, second]: [OneHalf; 2]) -> Self {
        // SAFETY: the halves prove that the machine has AVX-512F and DQ.
        unsafe { Self::from_halves(_mm512_cvtpd_ps(first.0), _mm512_cvtpd_ps(second.0)) }
    }
}

/// Eight doubles.
#[derive(Clone, Copy)]
pub struct OneHalf(__m512d);

impl Add for OneHalf {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_add_pd(self.0, other.0)) }
    }
}

impl Sub for OneHalf {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_sub_pd(self.0, other.0)) }
    }
}

impl Mul for OneHalf {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_mul_pd(self.0, other.0)) }
    }
}

impl Div for OneHalf {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_div_pd(self.0, other.0)) }
    }
}

impl Doubles for OneHalf {
    #[inline(always)]
    fn all(self, x: f64) -> Self {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { Self(_mm512_set1_pd(x)) }
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u8 {
        // SAFETY: `self` proves that the machine has AVX-512F.
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) }
    }
}
