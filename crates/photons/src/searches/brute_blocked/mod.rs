//! Every photon for every query, as the thesis's memory tests them, at the speed of vectors: blocks of photons that fit
//! the cache are tested for four queries at a time, and only blocks with a photon that is in are looked at again (Hoggins
//! 2010, section 6.2, in software).

mod kernels;
mod sieve;
#[cfg(test)]
mod tests;

use crate::index::{Index, Indexed, Scan};
use crate::{Photon, Region};
use kernels::SieveKernel;
use sieve::{Group, LANES};
use std::ops::Range;

pub(crate) const ABOUT: &str = "every photon for every query, in cache blocks with vectors";

/// Blocks that are tested for all queries before the next: 24 KiB of coordinates.
const BLOCKS_AT_ONCE: usize = 128;

/// Coordinates in blocks.
pub(crate) struct BruteBlocked {
    /// By axis.
    blocks: [Vec<[f32; LANES]>; 3],
    count: usize,
    kernel: SieveKernel,
}

impl BruteBlocked {
    /// The search over some photons.
    pub(crate) fn build(photons: &[Photon]) -> Indexed<Self> {
        Self::with_kernel(photons, kernels::available()[0])
    }

    fn with_kernel(photons: &[Photon], kernel: SieveKernel) -> Indexed<Self> {
        let blocks = std::array::from_fn(|axis| {
            let block = |photons: &[Photon]| {
                std::array::from_fn(|lane| photons.get(lane).map_or(f32::NAN, |p| p.position()[axis]))
            };
            photons.chunks(LANES).map(block).collect()
        });
        let index = Self { blocks, count: photons.len(), kernel };
        Indexed::new(photons, (index, (0..photons.len() as u32).collect()))
    }
}

impl Index for BruteBlocked {
    const NAME: &'static str = "brute-force-blocked";

    fn search(&self, scan: &mut impl Scan) {
        let region = scan.region();
        let mut tested = 0;
        self.search_all(&[region], &mut |_, places| {
            tested += places.len();
            scan.run(places);
        });
        scan.leave_out(self.count - tested);
    }

    fn search_all(&self, regions: &[Region], run: &mut impl FnMut(usize, Range<usize>)) -> bool {
        let [x, y, z] = self.blocks.each_ref().map(Vec::as_slice);
        let mut found = Vec::new();
        let mut groups = Vec::new();
        let mut next = 0;
        while next < regions.len() {
            let (group, count) = Group::of(&regions[next..]);
            groups.push((next, group));
            next += count;
        }
        for first in (0..x.len()).step_by(BLOCKS_AT_ONCE) {
            let end = (first + BLOCKS_AT_ONCE).min(x.len());
            for (query, group) in &groups {
                found.clear();
                (self.kernel.sieve)([&x[first..end], &y[first..end], &z[first..end]], first as u32, group, &mut found);
                for (block, lanes) in &found {
                    for (lane, held) in lanes.iter().enumerate().filter(|(_, held)| **held != 0) {
                        let place = *block as usize * LANES + lane;
                        let mut held = *held;
                        while held != 0 {
                            run(query + held.trailing_zeros() as usize, place..place + 1);
                            held &= held - 1;
                        }
                    }
                }
            }
        }
        true
    }

    fn bytes(&self) -> usize {
        self.blocks.iter().map(|blocks| blocks.capacity() * size_of::<[f32; LANES]>()).sum()
    }

    fn kernels(&self) -> &'static str {
        self.kernel.name
    }
}
