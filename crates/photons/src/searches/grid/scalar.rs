//! The gather kernel one photon at a time: what the vector kernels must equal bit for bit.

use super::blocks::{Block, LANES};
use crate::Gathered;
use crate::flux::{mantissas, scale};
use crate::inclusion::PreparedQuery;
use photinus_geometry::Vec3;
use std::ops::Range;

/// Sums the photons that `query` finds in runs of blocks.
///
/// The photon of a lane adds to that lane's sums, and the sixteen sums of a channel are added in a fixed tree, so
/// that the result depends neither on the vector width nor on which blocks without a photon in reach are read.
pub(crate) fn gather(blocks: &[Block], runs: &[Range<u32>], query: &PreparedQuery) -> Gathered {
    let mut sums = [[0f32; LANES]; 3];
    let mut count = 0;
    let position = query.position.to_array();
    for block in runs.iter().flat_map(|run| &blocks[run.start as usize..run.end as usize]) {
        for lane in 0..LANES {
            let d2 = block.distance_sq(lane, position);
            if d2 <= query.r2 && query.accepts(block.surface[lane]) {
                let word = block.flux[lane];
                let weight = scale(word) * query.kernel.weight(d2);
                for (sum, mantissa) in sums.iter_mut().zip(mantissas(word)) {
                    sum[lane] += mantissa * weight;
                }
                count += 1;
            }
        }
    }
    Gathered { flux: Vec3::from_array(sums.map(tree_sum)), count }
}

/// Halves folded onto one another: lane i + lane i + 8, then 4, 2, 1.
#[inline]
pub(crate) fn tree_sum(mut lanes: [f32; LANES]) -> f32 {
    let mut half = LANES / 2;
    while half > 0 {
        for i in 0..half {
            lanes[i] += lanes[i + half];
        }
        half /= 2;
    }
    lanes[0]
}
