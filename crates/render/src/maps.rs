//! Photon maps and the radiance estimate from them.

use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use crate::counters::{Counters, timed};
use crate::recording::{search_record, sum};
use crate::trace::Tracer;
use crate::twin::Twin;
use photinus_geometry::Vec3;
use photinus_photons::{GatherQuery, Gathered, Kernel, Neighbor, Photon, Search};
use photinus_profile::queries::{MapKind, SearchAnswer, SearchRecord};
use photinus_profile::{SearchCounters, ticks, undisturbed};

/// One photon map with its gather radius.
pub(crate) struct Map {
    pub kind: MapKind,
    pub search: Box<dyn Search>,
    /// Gather radius of this pass, scene units.
    pub radius: f32,
    pub kernel: Kernel,
}

/// The maps of one pass.
pub(crate) struct Maps {
    pub global: Map,
    /// None where no light passes mirrors or glass, or where one map holds everything.
    pub caustic: Option<Map>,
    /// Most photons of one estimate.
    pub knn: Option<u32>,
}

/// An estimate to be made: where, for which way of seeing, and what it counts.
pub(crate) struct Estimate {
    pub query: GatherQuery,
    pub bsdf: Bsdf,
    pub throughput: Vec3,
    /// The path it belongs to.
    pub path: u32,
    /// Record of the ray that asks.
    pub ray: u32,
}

/// What an estimate found: reflected radiance times throughput, and photons per area.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Estimated {
    pub radiance: Vec3,
    pub density: f32,
}

/// Buffers of a batch of estimates.
#[derive(Default)]
pub(crate) struct EstimateScratch {
    /// Searches, where they are recorded.
    records: Option<Vec<SearchRecord>>,
    queries: Vec<GatherQuery>,
    slots: Vec<usize>,
    gathered: Vec<Gathered>,
    neighbors: Vec<Neighbor>,
    visited: Vec<(Photon, f32)>,
}

impl EstimateScratch {
    /// Buffers that keep the searches where those of `tracer`'s batch are recorded.
    pub fn for_batch_of(tracer: &Tracer) -> Self {
        Self { records: tracer.records().then(Vec::new), ..Self::default() }
    }

    /// Hands the searches over to the record of the batch.
    pub fn hand_over(&mut self, tracer: &mut Tracer) {
        if let Some(records) = &mut self.records {
            tracer.record_searches(records);
        }
    }
}

impl Map {
    /// Makes the estimates of a batch; `out` gets one entry for each. The radius of a query is a lower bound for
    /// that of the map: a wide pixel gathers over its own width.
    pub fn estimate(
        &self,
        estimates: &[Estimate],
        knn: Option<u32>,
        twin: &mut Twin,
        scratch: &mut EstimateScratch,
        out: &mut Vec<Estimated>,
        counters: &mut Counters,
    ) {
        out.clear();
        out.resize(estimates.len(), Estimated::default());
        counters.searches += estimates.len() as u64;
        let mut nanoseconds = 0;
        timed(twin.is_on(), &mut nanoseconds, || {
            for (run, counted) in twin.runs(estimates.len()) {
                let (estimates, out) = (&estimates[run.clone()], &mut out[run]);
                if counted {
                    let before = counters.sampled_estimates;
                    let steady = undisturbed(|| {
                        let begun = ticks();
                        self.estimate_run::<true>(estimates, knn, scratch, out, counters);
                        counters.sampled_estimates.total += ticks().wrapping_sub(begun);
                    });
                    if !steady {
                        counters.sampled_estimates = before;
                    }
                } else {
                    self.estimate_run::<false>(estimates, knn, scratch, out, counters);
                }
            }
        });
        counters.spent.estimates += nanoseconds;
    }

    /// The estimates of a run, counted and stamped where `COUNT` says so.
    fn estimate_run<const COUNT: bool>(
        &self,
        estimates: &[Estimate],
        knn: Option<u32>,
        scratch: &mut EstimateScratch,
        out: &mut [Estimated],
        counters: &mut Counters,
    ) {
        scratch.queries.clear();
        scratch.slots.clear();
        for (i, e) in estimates.iter().enumerate() {
            let query = GatherQuery { radius: self.radius_for(e.query.radius), ..e.query };
            let constant = e.bsdf.constant(LobeSet::GATHER);
            if let Some(k) = knn {
                out[i] = self.nearest::<COUNT>(e, &query, k as usize, &mut scratch.neighbors, counters);
                if let Some(records) = &mut scratch.records {
                    let farthest_sq = scratch.neighbors.last().map_or(0.0, |n| n.distance_sq);
                    let answer = SearchAnswer::Nearest { k, farthest_sq };
                    let found = scratch.neighbors.len() as u32;
                    records.push(search_record(self.kind, self.kernel, e.ray, &query, found, answer));
                }
            } else if constant.is_some() {
                scratch.queries.push(query);
                scratch.slots.push(i);
            } else {
                let before = counters.photons_found;
                out[i] = self.each::<COUNT>(e, &query, &mut scratch.visited, counters);
                if let Some(records) = &mut scratch.records {
                    let found = (counters.photons_found - before) as u32;
                    records.push(search_record(self.kind, self.kernel, e.ray, &query, found, SearchAnswer::Visited));
                }
            }
        }
        scratch.gathered.clear();
        scratch.gathered.resize(scratch.queries.len(), Gathered::default());
        if COUNT {
            let (queries, gathered) = (&scratch.queries, &mut scratch.gathered);
            stamped(counters, |counted| self.search.gather_counted(queries, self.kernel, gathered, counted));
        } else {
            self.search.gather(&scratch.queries, self.kernel, &mut scratch.gathered);
        }
        for ((&i, query), found) in scratch.slots.iter().zip(&scratch.queries).zip(&scratch.gathered) {
            let e = &estimates[i];
            counters.photons_found += u64::from(found.count);
            if let Some(records) = &mut scratch.records {
                records.push(search_record(self.kind, self.kernel, e.ray, query, found.count, sum(found.flux)));
            }
            if let Some(factor) = e.bsdf.constant(LobeSet::GATHER) {
                let irradiance = found.flux / self.kernel.area(query.radius);
                let disc = std::f32::consts::PI * query.radius * query.radius;
                out[i] = Estimated { radiance: e.throughput * factor * irradiance, density: found.count as f32 / disc };
            }
        }
    }

    /// The map's radius, or the pixel's where that is wider, up to three times the map's so that far pixels do not
    /// gather everything.
    fn radius_for(&self, pixel: f32) -> f32 {
        self.radius.max(pixel.min(3.0 * self.radius))
    }

    /// Scattering that depends on where the photons come from: each photon by itself. The twin finds all of them first,
    /// so that a stamp can stand between the search and the rest; the sums are the same.
    fn each<const COUNT: bool>(
        &self,
        e: &Estimate,
        query: &GatherQuery,
        visited: &mut Vec<(Photon, f32)>,
        counters: &mut Counters,
    ) -> Estimated {
        let mut sum = Vec3::ZERO;
        let mut count = 0u32;
        let mut add = |photon: &Photon, distance_sq: f32| {
            let weight = self.kernel.weight(distance_sq, query.radius);
            sum += scattered(e, photon.direction()) * photon.flux() * weight;
            count += 1;
        };
        if COUNT {
            visited.clear();
            stamped(counters, |counted| {
                self.search.visit_counted(query, &mut |photon, d2| visited.push((*photon, d2)), counted);
            });
            visited.iter().for_each(|(photon, d2)| add(photon, *d2));
        } else {
            self.search.visit(query, &mut add);
        }
        counters.photons_found += u64::from(count);
        Estimated {
            radiance: e.throughput * sum / self.kernel.area(query.radius),
            density: count as f32 / (std::f32::consts::PI * query.radius * query.radius),
        }
    }

    /// The `k` nearest photons at most; where the cap bites, the area is that of the farthest one taken.
    fn nearest<const COUNT: bool>(
        &self,
        e: &Estimate,
        query: &GatherQuery,
        k: usize,
        neighbors: &mut Vec<Neighbor>,
        counters: &mut Counters,
    ) -> Estimated {
        if COUNT {
            stamped(counters, |counted| {
                self.search.nearest_counted(query.position, k, query.radius, neighbors, counted);
            });
        } else {
            self.search.nearest(query.position, k, query.radius, neighbors);
        }
        counters.photons_found += neighbors.len() as u64;
        let radius = if neighbors.len() == k {
            neighbors.last().map_or(query.radius, |n| n.distance_sq.sqrt())
        } else {
            query.radius
        };
        let mut sum = Vec3::ZERO;
        for n in neighbors.iter() {
            let photon = self.search.photon(n.photon);
            if photon.depth() <= query.max_depth && photon.normal().dot(query.normal) >= 0.5 {
                let weight = self.kernel.weight(n.distance_sq, radius);
                sum += scattered(e, photon.direction()) * photon.flux() * weight;
            }
        }
        let area = self.kernel.area(radius.max(1e-20));
        Estimated {
            radiance: e.throughput * sum / area,
            density: neighbors.len() as f32 / (std::f32::consts::PI * radius * radius).max(1e-20),
        }
    }
}

/// Runs a counted search between two stamps.
fn stamped(counters: &mut Counters, search: impl FnOnce(&mut SearchCounters)) {
    let begun = ticks();
    search(&mut counters.sampled_searches);
    counters.sampled_estimates.searches += ticks().wrapping_sub(begun);
}

/// Scattering without the cosine: the density of photons already counts it.
fn scattered(e: &Estimate, wi: Vec3) -> Vec3 {
    let cos = e.bsdf.shading_normal().dot(wi).abs();
    if cos < 1e-4 {
        return Vec3::ZERO;
    }
    e.bsdf.eval(LobeSet::GATHER, wi, TransportMode::Radiance) / cos
}
