//! The sieve for each instruction set, chosen at run time. All find the same.

use super::sieve::{Blocks, Found, Group, sieve_group};
use std::sync::OnceLock;

/// The sieve as one instruction set runs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SieveKernel {
    /// `avx512`, `avx2` or `scalar`.
    pub(crate) name: &'static str,
    /// See [`sieve_group`].
    pub(crate) sieve: fn(Blocks<'_>, u32, &Group, &mut Found),
}

/// Every kernel that this processor runs, the fastest first.
pub(crate) fn available() -> &'static [SieveKernel] {
    static AVAILABLE: OnceLock<Vec<SieveKernel>> = OnceLock::new();
    AVAILABLE.get_or_init(|| {
        let mut kernels = Vec::new();
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512bw")
                && is_x86_feature_detected!("avx512dq")
            {
                // SAFETY: the processor has what the function is compiled for.
                let sieve = |blocks: Blocks<'_>, first: u32, group: &Group, found: &mut Found| unsafe {
                    avx512(blocks, first, group, found);
                };
                kernels.push(SieveKernel { name: "avx512", sieve });
            }
            if is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has what the function is compiled for.
                let sieve = |blocks: Blocks<'_>, first: u32, group: &Group, found: &mut Found| unsafe {
                    avx2(blocks, first, group, found);
                };
                kernels.push(SieveKernel { name: "avx2", sieve });
            }
        }
        kernels.push(SieveKernel { name: "scalar", sieve: sieve_group });
        kernels
    })
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512bw,avx512dq")]
fn avx512(blocks: Blocks<'_>, first: u32, group: &Group, found: &mut Found) {
    sieve_group(blocks, first, group, found);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2(blocks: Blocks<'_>, first: u32, group: &Group, found: &mut Found) {
    sieve_group(blocks, first, group, found);
}
