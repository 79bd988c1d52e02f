//! Gathering by visiting: for members without a kernel of their own.

use crate::{GatherQuery, Gathered, GatheredNearest, Kernel, Photon, Search};
use photinus_geometry::Vec3;
use photinus_profile::SearchCounters;
use rayon::prelude::*;

/// Queries that are worth a task of their own.
const QUERIES_A_TASK: usize = 256;

/// Sums what `search` visits, in f64 in the order of the visits, rounded once.
pub(crate) fn gather_by_visiting(search: &dyn Search, query: &GatherQuery, kernel: Kernel) -> Gathered {
    let mut sums = Sums::default();
    search.visit(query, &mut |photon, d2| sums.add(photon, kernel.weight(d2, query.radius)));
    sums.gathered()
}

/// As [`gather_by_visiting`] for a batch on this thread, with the work counted.
pub(crate) fn gather_counted_by_visiting(
    search: &dyn Search,
    queries: &[GatherQuery],
    kernel: Kernel,
    out: &mut [Gathered],
    counters: &mut SearchCounters,
) {
    assert_eq!(queries.len(), out.len(), "one result a query");
    for (query, out) in queries.iter().zip(out) {
        let mut sums = Sums::default();
        let mut visit = |photon: &Photon, d2| sums.add(photon, kernel.weight(d2, query.radius));
        search.visit_counted(query, &mut visit, counters);
        *out = sums.gathered();
    }
}

/// Flux summed in f64.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    flux: [f64; 3],
    count: u32,
}

impl Sums {
    /// Adds a photon's flux times a weight.
    #[inline]
    pub(crate) fn add(&mut self, photon: &Photon, weight: f32) {
        for (sum, channel) in self.flux.iter_mut().zip(photon.flux().to_array()) {
            *sum += f64::from(channel) * f64::from(weight);
        }
        self.count += 1;
    }

    /// Rounded.
    pub(crate) fn gathered(self) -> Gathered {
        Gathered { flux: Vec3::from_array(self.flux.map(|c| c as f32)), count: self.count }
    }
}

/// As [`gather_by_visiting`] for a batch, on the threads of the current pool where the batch is large.
pub(crate) fn gather_batch_by_visiting(
    search: &dyn Search,
    queries: &[GatherQuery],
    kernel: Kernel,
    out: &mut [Gathered],
) {
    assert_eq!(queries.len(), out.len(), "one result a query");
    let one = |(query, out): (&GatherQuery, &mut Gathered)| *out = gather_by_visiting(search, query, kernel);
    queries.par_iter().zip(out).with_min_len(QUERIES_A_TASK).for_each(one);
}

/// Sums the nearest photons that `collect` hands out, in their order.
fn gather_collected(
    query: &GatherQuery,
    k: u32,
    kernel: Kernel,
    collect: impl FnOnce(&mut Vec<(Photon, f32)>),
) -> GatheredNearest {
    let mut found = Vec::new();
    collect(&mut found);
    let farthest_sq = found.iter().fold(0f32, |farthest, (_, d2)| farthest.max(*d2));
    let nearest = GatheredNearest { flux: Vec3::ZERO, count: found.len() as u32, farthest_sq };
    let radius = nearest.radius(query, k);
    let mut sums = Sums::default();
    found.iter().for_each(|(photon, d2)| sums.add(photon, kernel.weight(*d2, radius)));
    GatheredNearest { flux: sums.gathered().flux, ..nearest }
}

/// [`Search::gather_nearest`] by [`Search::collect_nearest`].
pub(crate) fn gather_nearest_by_collecting(
    search: &(impl Search + ?Sized),
    queries: &[GatherQuery],
    k: u32,
    kernel: Kernel,
    out: &mut [GatheredNearest],
) {
    assert_eq!(queries.len(), out.len(), "one result a query");
    let one = |(query, out): (&GatherQuery, &mut GatheredNearest)| {
        *out = gather_collected(query, k, kernel, |found| search.collect_nearest(query, k, found));
    };
    queries.par_iter().zip(out).with_min_len(QUERIES_A_TASK).for_each(one);
}

/// [`Search::gather_nearest_counted`] by [`Search::collect_nearest_counted`].
pub(crate) fn gather_nearest_counted_by_collecting(
    search: &(impl Search + ?Sized),
    queries: &[GatherQuery],
    k: u32,
    kernel: Kernel,
    out: &mut [GatheredNearest],
    counters: &mut SearchCounters,
) {
    assert_eq!(queries.len(), out.len(), "one result a query");
    for (query, out) in queries.iter().zip(out) {
        *out = gather_collected(query, k, kernel, |found| search.collect_nearest_counted(query, k, found, counters));
    }
}
