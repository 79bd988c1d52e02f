//! The portable code for shared photons, compiled for 256-bit vectors.

use super::{Found, Share, Shared};
use crate::inclusion::PreparedQuery;
use crate::searches::grid::blocks::Block;
use crate::searches::grid::kernels::SharedKernels;
use crate::{Gathered, GatheredNearest};

/// For processors that have AVX2, POPCNT and BMI1.
pub(crate) const KERNELS: SharedKernels = SharedKernels { collect, nearest, gather, gather_few };

fn collect(blocks: &[Block], hits: &[u32], share: &Share, shared: &mut Shared) {
    // SAFETY: these kernels are handed out only where the processor has AVX2, POPCNT and BMI1.
    unsafe { collect_avx2(blocks, hits, share, shared) }
}

fn nearest(shared: &mut Shared, query: &PreparedQuery, k: usize, guess_sq: f32) -> Found {
    // SAFETY: as above.
    unsafe { nearest_avx2(shared, query, k, guess_sq) }
}

fn gather(shared: &Shared, query: &PreparedQuery) -> Gathered {
    // SAFETY: as above.
    unsafe { gather_avx2(shared, query) }
}

fn gather_few(shared: &Shared, query: &PreparedQuery, k: usize) -> Option<GatheredNearest> {
    // SAFETY: as above.
    unsafe { gather_few_avx2(shared, query, k) }
}

#[target_feature(enable = "avx2,popcnt,bmi1")]
fn collect_avx2(blocks: &[Block], hits: &[u32], share: &Share, shared: &mut Shared) {
    super::collect(blocks, hits, share, shared);
}

#[target_feature(enable = "avx2,popcnt,bmi1")]
fn nearest_avx2(shared: &mut Shared, query: &PreparedQuery, k: usize, guess_sq: f32) -> Found {
    super::nearest(shared, query, k, guess_sq)
}

#[target_feature(enable = "avx2,popcnt,bmi1")]
fn gather_avx2(shared: &Shared, query: &PreparedQuery) -> Gathered {
    super::gather(shared, query)
}

#[target_feature(enable = "avx2,popcnt,bmi1")]
fn gather_few_avx2(shared: &Shared, query: &PreparedQuery, k: usize) -> Option<GatheredNearest> {
    super::gather_few(shared, query, k)
}
