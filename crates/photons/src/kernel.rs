//! The weight of a photon by its distance from the middle of a search.

/// Weight of a photon at distance d from the middle of a search of radius r. All integrate to one over the disc when
/// divided by [`Kernel::area`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kernel {
    /// 1.
    Constant,
    /// 1 - d / (k r), Jensen's cone filter (Jensen 2001, section 7.2.1); k below 1 counts as 1.
    Cone {
        /// Jensen's k, at least 1.
        k: f32,
    },
    /// 1 - (d/r)^2.
    Epanechnikov,
    /// Jensen's Gaussian (Jensen 2001, section 7.2.2): 0.918 (1 - (1 - exp(-1.953 d^2 / 2 r^2)) / (1 - exp(-1.953))).
    /// Computed as a polynomial in d^2/r^2, within 4e-7 of the formula.
    Gaussian,
}

/// Jensen's Gaussian as a polynomial in (d/r)^2, lowest power first: interpolation at the seven Chebyshev nodes of
/// [0, 1], error 1.5e-8 before rounding.
pub(crate) const GAUSSIAN: [f32; 7] =
    [0.918, -1.044_600_1, 0.510_003_9, -0.165_875_18, 0.040_122_997, -0.007_295_372, 0.000_796_469_4];

impl Kernel {
    /// Weight at squared distance `d2` (0..=r^2) in a search of radius `r`, never negative; 1 or 0.918 in the middle,
    /// where a radius of zero or infinity puts every photon.
    #[inline]
    pub fn weight(self, d2: f32, r: f32) -> f32 {
        PreparedKernel::new(self, r).weight(d2)
    }

    /// Integral of the weight over the disc of radius `r`, scene units squared: the sum of weight * flux divided by
    /// it estimates irradiance.
    pub fn area(self, r: f32) -> f32 {
        let share = match self {
            Self::Constant => 1.0,
            Self::Cone { k } => 1.0 - 2.0 / (3.0 * cone_k(k)),
            Self::Epanechnikov => 0.5,
            // The mean over the disc of (1 - e^(-b u / 2)), u uniform in 0..1, is 1 - (2/b)(1 - e^(-b/2)).
            Self::Gaussian => {
                let b = 1.953f64;
                let mean = 1.0 - 2.0 / b * (1.0 - libm::exp(-b / 2.0));
                (0.918 * (1.0 - mean / (1.0 - libm::exp(-b)))) as f32
            }
        };
        share * std::f32::consts::PI * (r * r)
    }
}

/// Jensen's k with what is out of range, NaN included, made 1.
fn cone_k(k: f32) -> f32 {
    if k > 1.0 { k } else { 1.0 }
}

/// A kernel with what depends on the radius only computed once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PreparedKernel {
    pub(crate) kernel: Kernel,
    /// 1 / r^2 and a little less, so that d^2 / r^2 never rounds to more than 1; zero where that is not finite.
    pub(crate) inv_r2: f32,
    /// 1 / k for the cone.
    pub(crate) inv_k: f32,
}

impl PreparedKernel {
    #[inline]
    pub(crate) fn new(kernel: Kernel, r: f32) -> Self {
        if kernel == Kernel::Constant {
            // Nothing depends on it.
            return Self { kernel, inv_r2: 0.0, inv_k: 1.0 };
        }
        let inv_r2 = 1.0 / (r * r) * (1.0 - 2.4e-7);
        let inv_k = if let Kernel::Cone { k } = kernel { 1.0 / cone_k(k) } else { 1.0 };
        Self { kernel, inv_r2: if inv_r2.is_finite() { inv_r2 } else { 0.0 }, inv_k }
    }

    /// The weight at squared distance `d2`. The vector kernels repeat these operations in this order.
    #[inline]
    pub(crate) fn weight(&self, d2: f32) -> f32 {
        let u = d2 * self.inv_r2;
        match self.kernel {
            Kernel::Constant => 1.0,
            Kernel::Cone { .. } => 1.0 - u.sqrt() * self.inv_k,
            Kernel::Epanechnikov => 1.0 - u,
            Kernel::Gaussian => GAUSSIAN[..6].iter().rev().fold(GAUSSIAN[6], |sum, c| sum * u + c),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KERNELS: [Kernel; 5] =
        [Kernel::Constant, Kernel::Cone { k: 1.0 }, Kernel::Cone { k: 1.3 }, Kernel::Epanechnikov, Kernel::Gaussian];

    #[test]
    fn area_is_the_integral_of_the_weight() {
        for kernel in KERNELS {
            for r in [1e-3f32, 1.0, 70.0] {
                // Midpoint rule over rings of equal area.
                const RINGS: u32 = 20_000;
                let ring = std::f64::consts::PI * f64::from(r * r) / f64::from(RINGS);
                let sum: f64 = (0..RINGS)
                    .map(|i| f64::from(kernel.weight(r * r * (i as f32 + 0.5) / RINGS as f32, r)) * ring)
                    .sum();
                let area = f64::from(kernel.area(r));
                assert!((sum / area - 1.0).abs() < 1e-5, "{kernel:?} {r}: {sum} {area}");
            }
        }
    }

    #[test]
    fn gaussian_is_within_its_documented_error() {
        let mut worst = 0f64;
        for i in 0..=10_000 {
            let u = i as f32 / 10_000.0;
            let b = 1.953f64;
            let exact = 0.918 * (1.0 - (1.0 - libm::exp(-b * f64::from(u) / 2.0)) / (1.0 - libm::exp(-b)));
            worst = worst.max((f64::from(Kernel::Gaussian.weight(u, 1.0)) - exact).abs());
        }
        assert!(worst < 4e-7, "{worst}");
    }

    #[test]
    fn degenerate_radii_give_finite_weights() {
        for kernel in KERNELS {
            let middle = if kernel == Kernel::Gaussian { GAUSSIAN[0] } else { 1.0 };
            for r in [0.0, 1e-30, f32::INFINITY] {
                assert_eq!(kernel.weight(0.0, r), middle, "{kernel:?} {r}");
            }
            assert_eq!(kernel.weight(3e38, f32::INFINITY), middle);
            for i in 1..1000 {
                let r = i as f32 * 0.37;
                assert!(kernel.weight(r * r, r) >= 0.0, "{kernel:?} {r}");
            }
        }
        assert!((Kernel::Cone { k: f32::NAN }.weight(0.25, 1.0) - 0.5).abs() < 1e-6);
    }
}
