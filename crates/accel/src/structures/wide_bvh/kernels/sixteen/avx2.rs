//! Two registers of AVX2.

use super::Sixteen;
use crate::structures::wide_bvh::layout::WIDTH;
use crate::structures::wide_bvh::packet::ByRay;
use photinus_intersect::doubles::Doubles;
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Sub};

/// Sixteen numbers.
#[derive(Clone, Copy)]
pub struct Two([__m256; 2]);

impl Two {
    /// Zeros, from which others are made.
    ///
    /// # Safety
    ///
    /// The machine must have AVX2.
    #[inline(always)]
    pub unsafe fn zeros() -> Self {
        // SAFETY: as the caller promises.
        unsafe { Self([_mm256_setzero_ps(); 2]) }
    }

    /// Eight numbers and eight more.
    ///
    /// # Safety
    ///
    /// The machine must have AVX2.
    #[inline(always)]
    pub unsafe fn from_halves(first: __m256, second: __m256) -> Self {
        Self([first, second])
    }
}

impl Add for Two {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_add_ps(self.0[0], other.0[0]), _mm256_add_ps(self.0[1], other.0[1])]) }
    }
}

impl Sub for Two {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_sub_ps(self.0[0], other.0[0]), _mm256_sub_ps(self.0[1], other.0[1])]) }
    }
}

impl Mul for Two {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_mul_ps(self.0[0], other.0[0]), _mm256_mul_ps(self.0[1], other.0[1])]) }
    }
}

impl Div for Two {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_div_ps(self.0[0], other.0[0]), _mm256_div_ps(self.0[1], other.0[1])]) }
    }
}

impl Sixteen for Two {
    type Half = TwoHalf;

    #[inline(always)]
    fn all(self, x: f32) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_set1_ps(x); 2]) }
    }

    #[inline(always)]
    fn twice(self, from: &[f32; WIDTH]) -> Self {
        // SAFETY: `self` proves that the machine has AVX2; the load is of eight words.
        unsafe { Self([_mm256_loadu_ps(from.as_ptr()); 2]) }
    }

    #[inline(always)]
    fn halved(self, first: f32, second: f32) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_set1_ps(first), _mm256_set1_ps(second)]) }
    }

    #[inline(always)]
    fn load(self, from: &ByRay) -> Self {
        // SAFETY: `self` proves that the machine has AVX2; the loads are of eight words of sixteen each.
        unsafe { Self([_mm256_loadu_ps(from.as_ptr()), _mm256_loadu_ps(from.as_ptr().add(WIDTH))]) }
    }

    #[inline(always)]
    fn store(self, to: &mut ByRay) {
        // SAFETY: `self` proves that the machine has AVX2; the stores are of eight words of sixteen each.
        unsafe {
            _mm256_storeu_ps(to.as_mut_ptr(), self.0[0]);
            _mm256_storeu_ps(to.as_mut_ptr().add(WIDTH), self.0[1]);
        }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_min_ps(self.0[0], other.0[0]), _mm256_min_ps(self.0[1], other.0[1])]) }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_max_ps(self.0[0], other.0[0]), _mm256_max_ps(self.0[1], other.0[1])]) }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe {
            let sign = _mm256_set1_ps(-0.0);
            Self([_mm256_andnot_ps(sign, self.0[0]), _mm256_andnot_ps(sign, self.0[1])])
        }
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u16 {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe {
            let half = |i: usize| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0[i], other.0[i])) as u16;
            half(0) | half(1) << WIDTH
        }
    }

    #[inline(always)]
    fn le(self, other: Self) -> u16 {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe {
            let half = |i: usize| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0[i], other.0[i])) as u16;
            half(0) | half(1) << WIDTH
        }
    }

    #[inline(always)]
    fn extremes(self) -> [f32; 2] {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe {
            let [a, b] = self.0;
            let halves = |x: __m256| (_mm256_castps256_ps128(x), _mm256_extractf128_ps::<1>(x));
            let ((a, b), (c, d)) = (halves(_mm256_min_ps(a, b)), halves(_mm256_max_ps(a, b)));
            let (low, high) = (_mm_min_ps(a, b), _mm_max_ps(c, d));
            let (low, high) = (_mm_min_ps(low, _mm_movehl_ps(low, low)), _mm_max_ps(high, _mm_movehl_ps(high, high)));
            let second = |x: __m128| _mm_shuffle_ps::<1>(x, x);
            [_mm_cvtss_f32(_mm_min_ss(low, second(low))), _mm_cvtss_f32(_mm_max_ss(high, second(high)))]
        }
    }

    #[inline(always)]
    fn select(self, mask: u16, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe {
            let half = |i: usize| {
                let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
                let own = _mm256_and_si256(_mm256_set1_epi32(i32::from(mask) >> (WIDTH * i)), bits);
                let own = _mm256_castsi256_ps(_mm256_cmpeq_epi32(own, bits));
                _mm256_blendv_ps(other.0[i], self.0[i], own)
            };
            Self([half(0), half(1)])
        }
    }

    #[inline(always)]
    fn halves(self) -> [TwoHalf; 2] {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe {
            let half = |x: __m256| {
                let (low, high) = (_mm256_castps256_ps128(x), _mm256_extractf128_ps::<1>(x));
                TwoHalf([_mm256_cvtps_pd(low), _mm256_cvtps_pd(high)])
            };
            [half(self.0[0]), half(self.0[1])]
        }
    }

    #[inline(always)]
    fn rounded(halves: [TwoHalf; 2]) -> Self {
        // SAFETY: the halves prove that the machine has AVX2.
        unsafe {
            let half = |x: TwoHalf| _mm256_set_m128(_mm256_cvtpd_ps(x.0[1]), _mm256_cvtpd_ps(x.0[0]));
            Self([half(halves[0]), half(halves[1])])
        }
    }
}

/// Eight doubles.
#[derive(Clone, Copy)]
pub struct TwoHalf([__m256d; 2]);

impl Add for TwoHalf {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_add_pd(self.0[0], other.0[0]), _mm256_add_pd(self.0[1], other.0[1])]) }
    }
}

impl Sub for TwoHalf {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_sub_pd(self.0[0], other.0[0]), _mm256_sub_pd(self.0[1], other.0[1])]) }
    }
}

impl Mul for TwoHalf {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_mul_pd(self.0[0], other.0[0]), _mm256_mul_pd(self.0[1], other.0[1])]) }
    }
}

impl Div for TwoHalf {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_div_pd(self.0[0], other.0[0]), _mm256_div_pd(self.0[1], other.0[1])]) }
    }
}

impl Doubles for TwoHalf {
    #[inline(always)]
    fn all(self, x: f64) -> Self {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe { Self([_mm256_set1_pd(x); 2]) }
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u8 {
        // SAFETY: `self` proves that the machine has AVX2.
        unsafe {
            let part = |i: usize| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0[i], other.0[i])) as u8;
            part(0) | part(1) << 4
        }
    }
}
