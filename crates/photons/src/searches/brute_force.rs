//! Every photon for every query: slow and obvious, what all other members are tested against.

use crate::inclusion::{PreparedQuery, distance_sq, radius_sq};
use crate::nearest::sort_by_distance;
use crate::results::ResultSet;
use crate::visiting::{gather_batch_by_visiting, gather_counted_by_visiting};
use crate::{GatherQuery, Gathered, Kernel, Neighbor, Photon, Region, Search, SearchSummary};
use photinus_geometry::Vec3;
use photinus_profile::SearchCounters;

pub(crate) const ABOUT: &str = "every photon for every query: the oracle";

/// The photons as they came.
pub(crate) struct BruteForce {
    photons: Vec<Photon>,
}

impl BruteForce {
    pub(crate) fn new(photons: Vec<Photon>) -> Self {
        Self { photons }
    }
}

impl Search for BruteForce {
    fn gather(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        gather_batch_by_visiting(self, queries, kernel, out);
    }

    fn gather_counted(
        &self,
        queries: &[GatherQuery],
        kernel: Kernel,
        out: &mut [Gathered],
        counters: &mut SearchCounters,
    ) {
        gather_counted_by_visiting(self, queries, kernel, out, counters);
    }

    fn visit(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32)) {
        let prepared = PreparedQuery::new(query, Kernel::Constant);
        for photon in &self.photons {
            let d2 = distance_sq(photon.position(), query.position);
            if d2 <= prepared.r2 && prepared.accepts(photon.surface_word()) {
                visit(photon, d2);
            }
        }
    }

    fn visit_counted(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32), counters: &mut SearchCounters) {
        let mut photons_found = 0;
        self.visit(query, &mut |photon, d2| {
            photons_found += 1;
            visit(photon, d2);
        });
        *counters += SearchCounters { searches: 1, photons_tested: self.photons.len() as u64, photons_found };
    }

    fn collect_nearest_counted(
        &self,
        query: &GatherQuery,
        k: u32,
        found: &mut Vec<(Photon, f32)>,
        counters: &mut SearchCounters,
    ) {
        found.clear();
        self.visit(query, &mut |photon, d2| found.push((*photon, d2)));
        let mut distances: Vec<f32> = found.iter().map(|(_, d2)| *d2).collect();
        distances.sort_unstable_by(f32::total_cmp);
        let farthest = distances.get((k as usize).wrapping_sub(1)).copied();
        let farthest = farthest.unwrap_or(if k == 0 { -1.0 } else { f32::INFINITY });
        found.retain(|(_, d2)| *d2 <= farthest);
        *counters += SearchCounters {
            searches: 1,
            photons_tested: self.photons.len() as u64,
            photons_found: found.len() as u64,
        };
    }

    fn search(&self, region: &Region, results: &mut dyn ResultSet) -> u64 {
        if !region.is_valid() {
            return 0;
        }
        let middle = region.middle();
        for (id, photon) in (0u32..).zip(&self.photons) {
            if let Some(d2) = region.holds(photon.position(), middle) {
                results.add(id, photon, d2);
            }
        }
        self.photons.len() as u64
    }

    fn within_radius(&self, position: Vec3, radius: f32, found: &mut Vec<Neighbor>) {
        let r2 = radius_sq(position, radius);
        found.clear();
        found.extend((0u32..).zip(&self.photons).filter_map(|(photon, p)| {
            let distance_sq = distance_sq(p.position(), position);
            (distance_sq <= r2).then_some(Neighbor { distance_sq, photon })
        }));
    }

    fn nearest(&self, position: Vec3, k: usize, radius: f32, found: &mut Vec<Neighbor>) {
        self.within_radius(position, radius, found);
        sort_by_distance(found);
        found.truncate(k);
    }

    fn photon(&self, id: u32) -> Photon {
        self.photons[id as usize]
    }

    fn summary(&self) -> SearchSummary {
        SearchSummary {
            name: "brute-force",
            photons: self.photons.len() as u64,
            bytes: (self.photons.capacity() * size_of::<Photon>()) as u64,
            kernels: "",
        }
    }
}
