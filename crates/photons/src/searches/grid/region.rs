//! Any region for any set of results: balls around the region's middle that grow until nothing beyond is of use.

use super::Grid;
use super::blocks::LANES;
use super::reach::Scratch;
use crate::Region;
use crate::results::ResultSet;

/// Photons that the first ball is to hold.
const FIRST: usize = 64;

impl Grid {
    /// See [`Search::search`](crate::Search::search).
    pub(super) fn search_region(&self, region: &Region, results: &mut dyn ResultSet) -> u64 {
        if !region.is_valid() || self.photon_count == 0 {
            return 0;
        }
        let (middle, whole_sq) = (region.middle(), region.radius_sq());
        // A root may be rounded down.
        let whole = if let Region::Sphere { radius, .. } = *region { radius } else { whole_sq.sqrt() * 1.000_001 };
        let mut scratch = Scratch::new();
        let mut reach = self.cells.reach(middle, FIRST, self.table.photons_a_cell());
        // What lies no further has been added.
        let mut added_sq = -1.0;
        let mut tested = 0;
        loop {
            let is_last = !(reach < whole);
            let (ball, ball_sq) = if is_last { (whole, whole_sq) } else { (reach, reach * reach) };
            self.find_blocks(middle, ball, ball_sq, &mut scratch);
            tested += self.photons_in(&scratch);
            for block in &scratch.hits {
                let (block, ids) = (&self.blocks[*block as usize], &self.ids[*block as usize]);
                for lane in 0..LANES {
                    // Lanes without a photon are nowhere.
                    let photon = block.photon(lane);
                    if let Some(d2) = region.holds(photon.position(), middle)
                        && d2 > added_sq
                        && d2 <= ball_sq.min(results.limit())
                    {
                        results.add(ids[lane], &photon, d2);
                    }
                }
            }
            added_sq = ball_sq;
            if is_last || results.limit() <= added_sq {
                return tested;
            }
            reach *= 2.0;
        }
    }
}
