//! Which kernel runs, decided once when the triangles are put into blocks.

use super::blocked::Blocked;
use super::kernels::scalar::Scalar;
#[cfg(target_arch = "x86_64")]
use super::kernels::{avx2::Avx2, avx512::Avx512};
use crate::options::Kernel;
use crate::structure::RayCounters;
use photinus_geometry::{Hit, Ray};

/// A kernel that this machine can run.
#[derive(Clone, Copy)]
pub enum Chosen {
    /// Plain Rust.
    Scalar,
    /// AVX2.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    /// AVX-512.
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

impl Chosen {
    /// The kernel asked for, or the next best that the machine has.
    pub fn new(kernel: Kernel) -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if let (Kernel::Auto | Kernel::Avx512, Some(k)) = (kernel, Avx512::detect()) {
                return Self::Avx512(k);
            }
            if let (Kernel::Auto | Kernel::Avx512 | Kernel::Avx2, Some(k)) = (kernel, Avx2::detect()) {
                return Self::Avx2(k);
            }
        }
        Self::Scalar
    }

    /// The name of the kernel that runs; never `Auto`.
    #[cfg(test)]
    pub fn kernel(self) -> Kernel {
        match self {
            Self::Scalar => Kernel::Scalar,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => Kernel::Avx2,
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => Kernel::Avx512,
        }
    }
}

impl Blocked {
    /// Traces every ray and hands out its hit.
    pub(super) fn trace_all<const ANY: bool>(
        &self,
        rays: &[Ray],
        set: impl FnMut(usize, Hit),
        counters: &mut RayCounters,
    ) {
        match self.kernel {
            Chosen::Scalar => self.trace::<_, ANY>(Scalar, rays, set, counters),
            #[cfg(target_arch = "x86_64")]
            Chosen::Avx2(kernel) => kernel.trace::<ANY>(self, rays, set, counters),
            #[cfg(target_arch = "x86_64")]
            Chosen::Avx512(kernel) => kernel.trace::<ANY>(self, rays, set, counters),
        }
    }
}
