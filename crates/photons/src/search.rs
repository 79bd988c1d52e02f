//! What every photon search answers.

use crate::results::ResultSet;
use crate::visiting::{gather_nearest_by_collecting, gather_nearest_counted_by_collecting};
use crate::{Kernel, Photon, Region};
use photinus_geometry::Vec3;
use photinus_profile::SearchCounters;

/// A question: what lands around `position`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GatherQuery {
    /// Middle of the search.
    pub position: Vec3,
    /// Radius in scene units; zero or more.
    pub radius: f32,
    /// Surface normal (unit): photons whose stored normal differs by more than 60 degrees are left out; the zero vector
    /// leaves out all.
    pub normal: Vec3,
    /// Only photons of at most this [`Photon::depth`] (1: photons straight from their light); from 127 on, all.
    pub max_depth: u32,
}

/// Sums over the photons found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gathered {
    /// Sum of kernel weight times flux, W.
    pub flux: Vec3,
    /// Photons found.
    pub count: u32,
}

/// Sums over the nearest of the photons found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GatheredNearest {
    /// Sum of kernel weight times flux, W.
    pub flux: Vec3,
    /// Photons that were summed.
    pub count: u32,
    /// Squared distance of the farthest of them, scene units squared; 0 without any.
    pub farthest_sq: f32,
}

impl GatheredNearest {
    /// The radius that `k` nearest photons were summed over: the distance of the farthest where there were as many as
    /// that, the query's otherwise.
    pub fn radius(&self, query: &GatherQuery, k: u32) -> f32 {
        if self.count >= k { self.farthest_sq.sqrt() } else { query.radius }
    }
}

/// A photon found, with the square of its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// Squared distance in scene units squared.
    pub distance_sq: f32,
    /// Index into the photons that the search was built over.
    pub photon: u32,
}

/// A finished search structure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SearchSummary {
    /// Member name.
    pub name: &'static str,
    /// Photons held.
    pub photons: u64,
    /// Memory, photons included.
    pub bytes: u64,
    /// Vector kernels in use (`avx512`, `avx2`, `scalar`); empty where the member has none.
    pub kernels: &'static str,
}

/// A photon search structure. Photon ids are indices into the vector that it was built over, whatever order the
/// member keeps its photons in; [`Search::photon`] reads them back.
///
/// All members find the same photons: those with `distance_sq <= radius * radius`, where `distance_sq` is
/// `(dx * dx + dy * dy) + dz * dz` in f32. A query with a position beyond 1e18 or NaN, or a radius that is negative or
/// NaN, finds nothing; radius 0 finds what lies at the very position, an infinite radius everything.
pub trait Search: Send + Sync {
    /// Sums kernel-weighted flux for each query; `out` is as long as `queries`. A photon counts where it lies within
    /// the radius, its normal is within 60 degrees of the query's and its depth is at most the query's.
    ///
    /// Every result depends on its query and the photons only: not on the rest of the batch, its order, the number of
    /// threads or the vector width. Large batches use the threads of the current rayon pool.
    fn gather(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]);

    /// As [`Search::gather`] with the work counted: the same results, more slowly, all on the calling thread.
    fn gather_counted(
        &self,
        queries: &[GatherQuery],
        kernel: Kernel,
        out: &mut [Gathered],
        counters: &mut SearchCounters,
    );

    /// Calls `visit` with every photon that [`Search::gather`] would sum for `query` and its squared distance, in an
    /// order that depends on nothing but the photons; for surfaces whose scattering depends on the photon's direction.
    fn visit(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32));

    /// As [`Search::visit`], with the work added to `counters`.
    fn visit_counted(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32), counters: &mut SearchCounters);

    /// A number that is near for queries that lie close to one another, see [`Search::gather_nearest_ordered`].
    /// Results do not depend on it.
    fn neighbourhood(&self, _query: &GatherQuery) -> u64 {
        0
    }

    /// [`Search::neighbourhood`] of each query; `keys` is cleared first.
    fn neighbourhoods(&self, queries: &[GatherQuery], keys: &mut Vec<u64>) {
        keys.clear();
        keys.extend(queries.iter().map(|query| self.neighbourhood(query)));
    }

    /// As [`Search::gather`] over the `k` nearest of what it would sum: where those within the radius are more, only up
    /// to the distance of the `k`th, with the kernel's radius at that distance. All photons at exactly that distance
    /// count, so that there can be more than `k`; 0 finds nothing.
    fn gather_nearest(&self, queries: &[GatherQuery], k: u32, kernel: Kernel, out: &mut [GatheredNearest]) {
        gather_nearest_by_collecting(self, queries, k, kernel, out);
    }

    /// As [`Search::gather_nearest`], and faster where queries come in the order of their [`Search::neighbourhood`]; in any
    /// other order the results are the same.
    fn gather_nearest_ordered(&self, queries: &[GatherQuery], k: u32, kernel: Kernel, out: &mut [GatheredNearest]) {
        self.gather_nearest(queries, k, kernel, out);
    }

    /// As [`Search::gather_nearest`] with the work counted: the same results, more slowly, all on the calling thread.
    fn gather_nearest_counted(
        &self,
        queries: &[GatherQuery],
        k: u32,
        kernel: Kernel,
        out: &mut [GatheredNearest],
        counters: &mut SearchCounters,
    ) {
        gather_nearest_counted_by_collecting(self, queries, k, kernel, out, counters);
    }

    /// Collects the photons that [`Search::gather_nearest`] would sum for `query` with their squared distances, in an
    /// order that depends on nothing but the photons; `found` is cleared first.
    fn collect_nearest(&self, query: &GatherQuery, k: u32, found: &mut Vec<(Photon, f32)>) {
        self.collect_nearest_counted(query, k, found, &mut SearchCounters::default());
    }

    /// As [`Search::collect_nearest`], with the work added to `counters`.
    fn collect_nearest_counted(
        &self,
        query: &GatherQuery,
        k: u32,
        found: &mut Vec<(Photon, f32)>,
        counters: &mut SearchCounters,
    );

    /// Adds the photons of a region to a set of results, in an order that depends on the photons and the region only, and
    /// returns how many were tested. What lies beyond the set's [`ResultSet::limit`] may be left out. A region that is none
    /// ([`Region::is_valid`]) holds nothing.
    fn search(&self, region: &Region, results: &mut dyn ResultSet) -> u64;

    /// All photons within `radius` of `position` (closed), in ascending id; `found` is cleared first.
    fn within_radius(&self, position: Vec3, radius: f32, found: &mut Vec<Neighbor>);

    /// The `k` nearest photons within `radius`, whatever their normals and depths, by distance, ties by id; `found` is
    /// cleared first.
    fn nearest(&self, position: Vec3, k: usize, radius: f32, found: &mut Vec<Neighbor>);

    /// The photon of an id.
    ///
    /// # Panics
    /// Where `id` is no index of the vector that the search was built over.
    fn photon(&self, id: u32) -> Photon;

    /// What was built.
    fn summary(&self) -> SearchSummary;
}
