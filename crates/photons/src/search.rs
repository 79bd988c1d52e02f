//! What every photon search answers.

use crate::Photon;
use photinus_geometry::Vec3;
use photinus_profile::SearchCounters;

/// Weight of a photon at distance d from the middle of a search of radius r. All integrate to one over the disc when
/// divided by [`Kernel::area`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kernel {
    /// 1.
    Constant,
    /// 1 - d / (k r), Jensen's cone filter with constant k >= 1.
    Cone {
        /// Jensen's k.
        k: f32,
    },
    /// 1 - (d/r)^2.
    Epanechnikov,
    /// Jensen's Gaussian: 0.918 (1 - (1 - exp(-1.953 d^2 / 2 r^2)) / (1 - exp(-1.953))).
    Gaussian,
}

/// A question: what lands around `position`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GatherQuery {
    /// Middle of the search.
    pub position: Vec3,
    /// Radius in scene units; zero or more.
    pub radius: f32,
    /// Surface normal (unit): photons whose stored normal differs by more than 60 degrees are left out.
    pub normal: Vec3,
    /// Only photons that have made at most this many bounces (1 for a photon straight from its light).
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
}

/// A photon search structure. Photon ids are indices into the slice that it was built over.
pub trait Search: Send + Sync {
    /// Sums kernel-weighted flux for each query; `out` is as long as `queries`. Photons are found where
    /// `distance_sq <= radius * radius`.
    fn gather(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]);

    /// As [`Search::gather`] with the work counted: the same results, more slowly.
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

    /// All photons within `radius` of `position` (closed), in ascending id; `found` is cleared first.
    fn within_radius(&self, position: Vec3, radius: f32, found: &mut Vec<Neighbor>);

    /// The `k` nearest photons within `radius`, by distance, ties by id; `found` is cleared first.
    fn nearest(&self, position: Vec3, k: usize, radius: f32, found: &mut Vec<Neighbor>);

    /// What was built.
    fn summary(&self) -> SearchSummary;
}
