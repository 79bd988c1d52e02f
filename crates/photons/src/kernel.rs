//! The weight of a photon by its distance from the middle of a search.

use crate::PhotonError;

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
        self.share() * std::f32::consts::PI * (r * r)
    }

    /// The mean of the weight over the disc.
    pub(crate) fn share(self) -> f32 {
        match self {
            Self::Constant => 1.0,
            Self::Cone { k } => 1.0 - 2.0 / (3.0 * cone_k(k)),
            Self::Epanechnikov => 0.5,
            // The mean over the disc of (1 - e^(-b u / 2)), u uniform in 0..1, is 1 - (2/b)(1 - e^(-b/2)).
            Self::Gaussian => {
                let b = 1.953f64;
                let mean = 1.0 - 2.0 / b * (1.0 - libm::exp(-b / 2.0));
                (0.918 * (1.0 - mean / (1.0 - libm::exp(-b)))) as f32
            }
        }
    }

    /// The share of the integral over the disc that lies within a distance d, by (d/r)^2.
    fn part_within(self, u: f64) -> f64 {
        let integral = match self {
            Self::Constant => u,
            Self::Cone { k } => u - 2.0 / (3.0 * f64::from(cone_k(k))) * u * u.sqrt(),
            Self::Epanechnikov => u - 0.5 * u * u,
            Self::Gaussian => {
                let b = 1.953f64;
                let mean = u - 2.0 / b * (1.0 - libm::exp(-b * u / 2.0));
                0.918 * (u - mean / (1.0 - libm::exp(-b)))
            }
        };
        integral / f64::from(self.share())
    }

    /// The square of a distance over the radius, 0 to 1, within which a share `part` of the kernel's integral lies: for a
    /// `part` that is uniform in 0..1 it belongs to a point that is drawn in proportion to the kernel.
    pub fn square_within(self, part: f32) -> f32 {
        match self {
            Self::Constant => part,
            Self::Epanechnikov => 1.0 - (1.0 - part).sqrt(),
            Self::Cone { .. } | Self::Gaussian => {
                let (mut low, mut high) = (0.0f64, 1.0f64);
                // To the last bit of an f32 near 1.
                for _ in 0..24 {
                    let middle = 0.5 * (low + high);
                    if self.part_within(middle) < f64::from(part) { low = middle } else { high = middle }
                }
                high as f32
            }
        }
    }
}

/// A kernel that is chosen by name.
#[derive(Clone, Copy, Debug)]
pub struct KernelMember {
    /// Command-line name.
    pub name: &'static str,
    /// One sentence for help and documentation.
    pub about: &'static str,
    /// The kernel.
    pub kernel: Kernel,
}

/// All kernels that have a name.
pub const KERNELS: &[KernelMember] = &[
    KernelMember { name: "constant", about: "all photons alike", kernel: Kernel::Constant },
    KernelMember { name: "cone", about: "1 - d/r, Jensen's cone with k = 1", kernel: Kernel::Cone { k: 1.0 } },
    KernelMember { name: "epanechnikov", about: "1 - (d/r)^2", kernel: Kernel::Epanechnikov },
    KernelMember { name: "gaussian", about: "Jensen's Gaussian", kernel: Kernel::Gaussian },
];

/// The kernel of a command-line name; underscores count as hyphens.
///
/// # Errors
/// No such kernel.
pub fn find_kernel(name: &str) -> Result<Kernel, PhotonError> {
    let wanted = name.replace('_', "-");
    let member = KERNELS.iter().find(|member| member.name == wanted);
    member.map(|member| member.kernel).ok_or_else(|| PhotonError::UnknownKernel(name.to_owned()))
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
    fn parts_of_the_integral_are_found_again() {
        for kernel in KERNELS {
            assert_eq!(kernel.square_within(0.0).round(), 0.0, "{kernel:?}");
            assert!((kernel.part_within(1.0) - 1.0).abs() < 1e-6, "{kernel:?}");
            for i in 0..100 {
                let part = i as f32 / 100.0;
                let u = kernel.square_within(part);
                assert!((0.0..=1.0).contains(&u), "{kernel:?} {part}: {u}");
                assert!((kernel.part_within(f64::from(u)) - f64::from(part)).abs() < 1e-6, "{kernel:?} {part}: {u}");
                // Against the weight itself, by the midpoint rule.
                let weight = |j: u32| f64::from(kernel.weight(u * (j as f32 + 0.5) / 1000.0, 1.0));
                let sum = (0..1000).map(weight).sum::<f64>() / 1000.0 * f64::from(u) / f64::from(kernel.share());
                assert!((sum - f64::from(part)).abs() < 1e-5, "{kernel:?} {part}: {sum}");
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
