//! Photon maps and the radiance estimate from them.

use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use crate::counters::{Counters, timed};
use crate::indirect::Kept;
use crate::recording::{search_record, sum};
use crate::trace::Tracer;
use crate::twin::Twin;
use photinus_geometry::Vec3;
use photinus_photons::{GatherQuery, Gathered, GatheredNearest, Kernel, Photon, Search, Support};
use photinus_profile::queries::{MapKind, SearchAnswer, SearchRecord};
use photinus_profile::{SearchCounters, ticks, undisturbed};
use std::ops::Range;

/// One photon map with its gather radius.
pub(crate) struct Map {
    pub kind: MapKind,
    pub search: Box<dyn Search>,
    /// Gather radius of this pass, scene units.
    pub radius: f32,
    pub kernel: Kernel,
    /// What the search looks for; none: balls, as it does by itself.
    pub support: Option<&'static Support>,
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
#[derive(Clone, Copy)]
pub(crate) struct Estimate {
    pub query: GatherQuery,
    /// 1 on the outside of its surface, -1 behind it.
    pub side: f32,
    pub scatter: Scatter,
    pub throughput: Vec3,
    /// The path it belongs to.
    pub path: u32,
    /// Places that the caustic map is asked about in its stead, itself included.
    pub places: u32,
    /// Where it lies among them: its shift in the unit square of the pixel's filter.
    pub shift: [f32; 2],
    /// Record of the ray that asks.
    pub ray: u32,
    /// How far the surface may be off the place asked about, by rounding; scene units.
    pub offset: f32,
    /// The camera sees it directly.
    pub is_first: bool,
    /// Part of the radius of the map of all light that it is made over, 0 to 1.
    pub scale: f32,
    /// The same of the caustic map.
    pub caustic_scale: f32,
}

/// How the light of photons is scattered to where an estimate is asked for.
#[derive(Clone, Copy)]
pub(crate) enum Scatter {
    /// Alike from all directions: by this factor, 1/sr.
    Constant(Vec3),
    /// As the scattering function of this number in the batch says.
    ByDirection(u32),
}

/// The estimates of a batch.
#[derive(Default)]
pub(crate) struct Estimates {
    pub list: Vec<Estimate>,
    /// More places of the same pixel and surface that the caustic map is asked about, see [`crate::companions`].
    pub companions: Vec<Estimate>,
    /// What rays from each estimate of the list need to know, where there are such rays.
    pub kept: Vec<Kept>,
    /// Scattering functions that depend on directions; few surfaces need theirs kept.
    bsdfs: Vec<Bsdf>,
}

impl Estimates {
    /// Keeps of a scattering function what an estimate needs.
    pub fn scatter(&mut self, bsdf: &Bsdf) -> Scatter {
        match bsdf.constant(LobeSet::GATHER) {
            Some(factor) => Scatter::Constant(factor),
            None => {
                self.bsdfs.push(bsdf.clone());
                Scatter::ByDirection(self.bsdfs.len() as u32 - 1)
            }
        }
    }

    /// Starts again.
    pub fn clear(&mut self) {
        self.list.clear();
        self.companions.clear();
        self.kept.clear();
        self.bsdfs.clear();
    }
}

/// What an estimate found: reflected radiance times throughput, photons per area, and the radius that they were within.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Estimated {
    pub radiance: Vec3,
    pub density: f32,
    pub radius: f32,
}

/// The light of photons, whatever the surface makes of it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Found {
    /// Divided by how it is scattered: W per scene unit squared.
    pub irradiance: Vec3,
    /// Photons per area.
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
    nearest: Vec<GatheredNearest>,
    visited: Vec<(Photon, f32)>,
}

impl EstimateScratch {
    /// Buffers that keep the searches where those of `tracer`'s batch are recorded.
    pub fn for_batch_of(tracer: &Tracer) -> Self {
        let mut scratch = Self::default();
        scratch.begin_batch_of(tracer);
        scratch
    }

    /// Keeps the searches from now on where those of `tracer`'s batch are recorded.
    pub fn begin_batch_of(&mut self, tracer: &Tracer) {
        self.records = tracer.records().then(Vec::new);
    }

    /// Hands the searches over to the record of the batch.
    pub fn hand_over(&mut self, tracer: &mut Tracer) {
        if let Some(records) = &mut self.records {
            tracer.record_searches(records);
        }
    }
}

impl Map {
    /// The query of all photons within the radius, whatever their depth.
    #[inline]
    pub fn query(&self, position: Vec3, normal: Vec3) -> GatherQuery {
        GatherQuery { position, radius: self.radius, normal, max_depth: 127 }
    }

    /// Sums the `k` nearest photons of each query; they come in the order of their neighbourhoods.
    pub fn nearest(
        &self,
        queries: &[GatherQuery],
        k: u32,
        twin: &mut Twin,
        out: &mut [GatheredNearest],
        counters: &mut Counters,
    ) {
        in_runs(queries.len(), twin, counters, |run, counted, counters| {
            let (queries, out) = (&queries[run.clone()], &mut out[run]);
            if counted {
                stamped(counters, |work| self.search.gather_nearest_counted(queries, k, self.kernel, out, work));
            } else {
                self.search.gather_nearest_ordered(queries, k, self.kernel, out);
            }
        });
        counters.photons_found += out.iter().map(|found| u64::from(found.count)).sum::<u64>();
    }

    /// Makes the estimates `list` of the batch `estimates`; `out` gets one entry for each. The radius of a query is a
    /// lower bound for that of the map: a wide pixel gathers over its own width.
    pub fn estimate(
        &self,
        list: &[Estimate],
        estimates: &Estimates,
        knn: Option<u32>,
        twin: &mut Twin,
        scratch: &mut EstimateScratch,
        out: &mut Vec<Estimated>,
        counters: &mut Counters,
    ) {
        let bsdfs = &estimates.bsdfs;
        out.clear();
        out.resize(list.len(), Estimated::default());
        in_runs(list.len(), twin, counters, |run, counted, counters| {
            let (estimates, out) = (&list[run.clone()], &mut out[run]);
            if counted {
                self.estimate_run::<true>(estimates, bsdfs, knn, scratch, out, counters);
            } else {
                self.estimate_run::<false>(estimates, bsdfs, knn, scratch, out, counters);
            }
        });
    }

    /// The estimates of a run, counted and stamped where `COUNT` says so.
    fn estimate_run<const COUNT: bool>(
        &self,
        estimates: &[Estimate],
        bsdfs: &[Bsdf],
        knn: Option<u32>,
        scratch: &mut EstimateScratch,
        out: &mut [Estimated],
        counters: &mut Counters,
    ) {
        scratch.queries.clear();
        scratch.slots.clear();
        for (i, e) in estimates.iter().enumerate() {
            let query = GatherQuery { radius: self.radius_for(e), ..e.query };
            match e.scatter {
                Scatter::Constant(_) => {
                    scratch.queries.push(query);
                    scratch.slots.push(i);
                }
                Scatter::ByDirection(bsdf) => {
                    let bsdf = &bsdfs[bsdf as usize];
                    out[i] = match knn {
                        Some(k) => self.each_nearest::<COUNT>(e, bsdf, &query, k, scratch, counters),
                        None => self.each::<COUNT>(e, bsdf, &query, scratch, counters),
                    };
                }
            }
        }
        match knn {
            Some(k) => self.sum_nearest::<COUNT>(estimates, k, scratch, out, counters),
            None => self.sum::<COUNT>(estimates, scratch, out, counters),
        }
    }

    /// Estimates on surfaces that scatter alike from all directions: sums of what the queries find.
    fn sum<const COUNT: bool>(
        &self,
        estimates: &[Estimate],
        scratch: &mut EstimateScratch,
        out: &mut [Estimated],
        counters: &mut Counters,
    ) {
        let EstimateScratch { records, queries, slots, gathered, .. } = scratch;
        gathered.clear();
        gathered.resize(queries.len(), Gathered::default());
        if COUNT {
            stamped(counters, |counted| self.search.gather_counted(queries, self.kernel, gathered, counted));
        } else {
            self.search.gather(queries, self.kernel, gathered);
        }
        for ((&i, query), found) in slots.iter().zip(queries).zip(gathered) {
            let e = &estimates[i];
            counters.photons_found += u64::from(found.count);
            if let Some(records) = records {
                records.push(search_record(self.kind, self.kernel, e.ray, query, found.count, sum(found.flux)));
            }
            out[i] = self.estimated(e, query, found.flux, found.count, query.radius);
        }
    }

    /// As [`Self::sum`], over the `k` nearest at most.
    fn sum_nearest<const COUNT: bool>(
        &self,
        estimates: &[Estimate],
        k: u32,
        scratch: &mut EstimateScratch,
        out: &mut [Estimated],
        counters: &mut Counters,
    ) {
        let EstimateScratch { records, queries, slots, nearest, .. } = scratch;
        nearest.clear();
        nearest.resize(queries.len(), GatheredNearest::default());
        if COUNT {
            stamped(counters, |work| self.search.gather_nearest_counted(queries, k, self.kernel, nearest, work));
        } else {
            self.search.gather_nearest(queries, k, self.kernel, nearest);
        }
        for ((&i, query), found) in slots.iter().zip(queries).zip(nearest) {
            let e = &estimates[i];
            counters.photons_found += u64::from(found.count);
            if let Some(records) = records {
                let answer = SearchAnswer::Nearest { k, farthest_sq: found.farthest_sq };
                records.push(search_record(self.kind, self.kernel, e.ray, query, found.count, answer));
            }
            out[i] = self.estimated(e, query, found.flux, found.count, found.radius(query, k));
        }
    }

    /// Radiance by the sum of weighted flux within a radius.
    fn estimated(&self, e: &Estimate, query: &GatherQuery, flux: Vec3, count: u32, radius: f32) -> Estimated {
        let Scatter::Constant(factor) = e.scatter else { return Estimated::default() };
        let Found { irradiance, density } = self.found(query, flux, count, radius);
        Estimated { radiance: e.throughput * factor * irradiance, density, radius }
    }

    /// The light that so much weighted flux of a query is, within a radius.
    pub fn found(&self, query: &GatherQuery, flux: Vec3, count: u32, radius: f32) -> Found {
        let irradiance = flux / self.area(query, radius.max(LEAST_RADIUS));
        Found { irradiance, density: self.density(query, count, radius) }
    }

    /// Integral of the kernel over the surface within a radius.
    fn area(&self, query: &GatherQuery, radius: f32) -> f32 {
        match self.support {
            None => self.kernel.area(radius),
            Some(support) => support.area(self.kernel, query.normal, radius),
        }
    }

    /// Photons per area.
    fn density(&self, query: &GatherQuery, count: u32, radius: f32) -> f32 {
        let area = match self.support {
            None => std::f32::consts::PI * radius * radius,
            Some(support) => support.area(Kernel::Constant, query.normal, radius),
        };
        count as f32 / area.max(1e-20)
    }

    /// The map's radius, or the pixel's where that is wider (of each of its places, where there are several), up to
    /// three times the map's so that far pixels do not gather everything.
    fn radius_for(&self, e: &Estimate) -> f32 {
        let (part, own) = match self.kind {
            MapKind::Global => (e.scale, e.query.radius),
            // Places spread over the pixel need not reach as far as one.
            MapKind::Caustic => (e.caustic_scale, e.query.radius / (e.places as f32).sqrt()),
        };
        (self.radius * part).max(own.min(3.0 * self.radius))
    }

    /// Scattering that depends on where the photons come from: each photon by itself. The twin finds all of them first,
    /// so that a stamp can stand between the search and the rest; the sums are the same.
    fn each<const COUNT: bool>(
        &self,
        e: &Estimate,
        bsdf: &Bsdf,
        query: &GatherQuery,
        scratch: &mut EstimateScratch,
        counters: &mut Counters,
    ) -> Estimated {
        let mut sum = Vec3::ZERO;
        let mut count = 0u32;
        let mut add = |photon: &Photon, distance_sq: f32| {
            let weight = self.kernel.weight(distance_sq, query.radius);
            sum += scattered(bsdf, photon.direction()) * photon.flux() * weight;
            count += 1;
        };
        if COUNT {
            let visited = &mut scratch.visited;
            visited.clear();
            stamped(counters, |counted| {
                self.search.visit_counted(query, &mut |photon, d2| visited.push((*photon, d2)), counted);
            });
            visited.iter().for_each(|(photon, d2)| add(photon, *d2));
        } else {
            self.search.visit(query, &mut add);
        }
        counters.photons_found += u64::from(count);
        if let Some(records) = &mut scratch.records {
            records.push(search_record(self.kind, self.kernel, e.ray, query, count, SearchAnswer::Visited));
        }
        Estimated {
            radiance: e.throughput * sum / self.area(query, query.radius),
            density: self.density(query, count, query.radius),
            radius: query.radius,
        }
    }

    /// As [`Self::each`], over the `k` nearest at most.
    fn each_nearest<const COUNT: bool>(
        &self,
        e: &Estimate,
        bsdf: &Bsdf,
        query: &GatherQuery,
        k: u32,
        scratch: &mut EstimateScratch,
        counters: &mut Counters,
    ) -> Estimated {
        let visited = &mut scratch.visited;
        if COUNT {
            stamped(counters, |counted| self.search.collect_nearest_counted(query, k, visited, counted));
        } else {
            self.search.collect_nearest(query, k, visited);
        }
        let count = visited.len() as u32;
        let farthest_sq = visited.iter().fold(0f32, |farthest, (_, d2)| farthest.max(*d2));
        counters.photons_found += u64::from(count);
        if let Some(records) = &mut scratch.records {
            let answer = SearchAnswer::Nearest { k, farthest_sq };
            records.push(search_record(self.kind, self.kernel, e.ray, query, count, answer));
        }
        let radius = GatheredNearest { flux: Vec3::ZERO, count, farthest_sq }.radius(query, k);
        let mut sum = Vec3::ZERO;
        for (photon, d2) in visited {
            sum += scattered(bsdf, photon.direction()) * photon.flux() * self.kernel.weight(*d2, radius);
        }
        let area = self.area(query, radius.max(LEAST_RADIUS));
        Estimated { radiance: e.throughput * sum / area, density: self.density(query, count, radius), radius }
    }
}

/// Photons that all lie at the very place asked about are spread over a disc of this radius, scene units.
const LEAST_RADIUS: f32 = 1e-18;

/// Makes `count` estimates, run by run, as `work(run, counted, counters)` does: their time is taken, and what share
/// of it the searches have where runs are counted.
fn in_runs(
    count: usize,
    twin: &mut Twin,
    counters: &mut Counters,
    mut work: impl FnMut(Range<usize>, bool, &mut Counters),
) {
    counters.searches += count as u64;
    let mut nanoseconds = 0;
    timed(twin.is_on(), &mut nanoseconds, || {
        for (run, counted) in twin.runs(count) {
            if !counted {
                work(run, false, counters);
                continue;
            }
            let before = counters.sampled_estimates;
            let steady = undisturbed(|| {
                let begun = ticks();
                work(run, true, counters);
                counters.sampled_estimates.total += ticks().wrapping_sub(begun);
            });
            if !steady {
                counters.sampled_estimates = before;
            }
        }
    });
    counters.spent.estimates += nanoseconds;
}

/// Runs a counted search between two stamps.
fn stamped(counters: &mut Counters, search: impl FnOnce(&mut SearchCounters)) {
    let begun = ticks();
    search(&mut counters.sampled_searches);
    counters.sampled_estimates.searches += ticks().wrapping_sub(begun);
}

/// Scattering without the cosine: the density of photons already counts it.
fn scattered(bsdf: &Bsdf, wi: Vec3) -> Vec3 {
    let cos = bsdf.shading_normal().dot(wi).abs();
    if cos < 1e-4 {
        return Vec3::ZERO;
    }
    bsdf.eval(LobeSet::GATHER, wi, TransportMode::Radiance) / cos
}
