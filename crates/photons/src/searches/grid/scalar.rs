//! The kernels one photon at a time: what the vector kernels must equal bit for bit.

use super::blocks::{Block, Boxes, LANES};
use super::candidates::{Candidates, key};
use super::even;
use super::facing::of_query;
use super::kernels::{NormalMemo, Selected, VectorKernels};
use super::kth::{kth_least, pad};
use super::shared;
use crate::flux::{PLACED_UNITS, placed_mantissas, raw_scale};
use crate::inclusion::PreparedQuery;
use crate::{Gathered, Kernel};
use photinus_geometry::Vec3;
use std::ops::Range;

/// These kernels, for any processor.
pub(crate) const KERNELS: VectorKernels = VectorKernels {
    name: "scalar",
    cull,
    facing: of_query,
    prefetch: |_, _| (),
    gather,
    select,
    scan,
    kth,
    gather_selected,
    shared: shared::SCALAR,
};

fn cull(boxes: &Boxes, ranges: &[Range<u32>], position: Vec3, r2: f32, facing: u32, hits: &mut Vec<u32>) {
    let position = position.to_array();
    let bounds = &boxes.bounds;
    hits.extend(ranges.iter().flat_map(Clone::clone).filter(|block| {
        let i = *block as usize;
        let d: [f32; 3] = std::array::from_fn(|axis| {
            (bounds[axis][i] - position[axis]).max(position[axis] - bounds[axis + 3][i]).max(0.0)
        });
        (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2] <= r2 && boxes.facing[i] & facing != 0
    }));
}

/// The photon of a lane adds to that lane's sums, and the sixteen sums of a channel are added in a fixed tree, so
/// that the result depends neither on the vector width nor on which blocks without a photon in reach are read.
fn gather(blocks: &[Block], hits: &[u32], query: &PreparedQuery, _: &mut NormalMemo) -> Gathered {
    let mut sums = Sums::default();
    for block in hits.iter().map(|block| &blocks[*block as usize]) {
        for (lane, d2) in block.distances_sq(query.position).into_iter().enumerate() {
            if d2 <= query.r2 && query.accepts(block.surface[lane]) {
                sums.add(block, lane, d2, query);
            }
        }
    }
    sums.gathered()
}

fn gather_selected(blocks: &[Block], selected: &[Selected], query: &PreparedQuery) -> Gathered {
    if query.kernel.kernel == Kernel::Constant {
        return even::gather_selected(blocks, selected, query.r2);
    }
    let mut sums = Sums::default();
    for selected in selected {
        for (lane, d2) in selected.found().filter(|(_, d2)| *d2 <= query.r2) {
            sums.add(&blocks[selected.block as usize], lane, d2, query);
        }
    }
    sums.gathered()
}

/// Weighted flux by lane.
#[derive(Default)]
struct Sums {
    flux: [[f32; LANES]; 3],
    count: u32,
}

impl Sums {
    fn add(&mut self, block: &Block, lane: usize, d2: f32, query: &PreparedQuery) {
        let word = block.flux[lane];
        let weight = raw_scale(word) * query.kernel.weight(d2);
        for (sum, mantissa) in self.flux.iter_mut().zip(placed_mantissas(word).to_array()) {
            sum[lane] += mantissa * weight;
        }
        self.count += 1;
    }

    fn gathered(self) -> Gathered {
        Gathered { flux: Vec3::from_array(self.flux.map(tree_sum)) * PLACED_UNITS, count: self.count }
    }
}

fn select(blocks: &[Block], hits: &[u32], query: &PreparedQuery, _: &mut NormalMemo, found: &mut Vec<Selected>) {
    for &block in hits {
        let photons = &blocks[block as usize];
        let distances_sq = photons.distances_sq(query.position);
        let is_found = |lane: &usize| distances_sq[*lane] <= query.r2 && query.accepts(photons.surface[*lane]);
        let lanes = (0..LANES).filter(is_found).fold(0, |lanes, lane| lanes | 1 << lane);
        if lanes != 0 {
            found.push(Selected { block, lanes, distances_sq });
        }
    }
}

/// Halves folded onto one another: lane i + lane i + 8, then 4, 2, 1.
pub(super) fn tree_sum(mut lanes: [f32; LANES]) -> f32 {
    let mut half = LANES / 2;
    while half > 0 {
        for i in 0..half {
            lanes[i] += lanes[i + half];
        }
        half /= 2;
    }
    lanes[0]
}

fn scan(blocks: &[Block], ids: &[[u32; LANES]], hits: &[u32], position: Vec3, r2: f32, candidates: &mut Candidates) {
    let mut limit = r2;
    for &block in hits {
        let free = candidates.free(LANES);
        let mut count = 0;
        for (lane, d2) in blocks[block as usize].distances_sq(position).into_iter().enumerate() {
            if d2 <= limit {
                free[count] = key(d2, ids[block as usize][lane]);
                count += 1;
            }
        }
        limit = candidates.push(count).unwrap_or(limit);
    }
}

fn kth(selected: &[Selected], k: usize, distances_sq: &mut Vec<f32>) -> f32 {
    distances_sq.clear();
    for selected in selected {
        distances_sq.extend(selected.found().map(|(_, d2)| d2));
    }
    pad(distances_sq);
    kth_least(distances_sq, -1.0, k)
}
