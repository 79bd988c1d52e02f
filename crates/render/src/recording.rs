//! Queries of one batch as they are recorded: which ray led to which, and what each was told.

use photinus_geometry::{Hit, Ray, Vec3};
use photinus_photons::{GatherQuery, Kernel};
use photinus_profile::queries::{
    Block, BlockKey, MapKind, NO_PARENT, QuerySink, RayAnswer, RayHit, RayKind, RayRecord, SearchAnswer, SearchKernel,
    SearchRecord,
};

/// The rays of a batch, and who asks next.
pub(crate) struct Recording<'w> {
    sink: &'w dyn QuerySink,
    block: Block,
    /// For each ray of the query under way what it is for, and its latest record: its parent's until it has its own.
    kinds: Vec<RayKind>,
    latest: Vec<u32>,
}

impl<'w> Recording<'w> {
    pub fn new(sink: &'w dyn QuerySink, key: BlockKey) -> Self {
        Self { sink, block: Block::new(key), kinds: Vec::new(), latest: Vec::new() }
    }

    /// Says for each ray of the next query what it is for, and which ray led to it.
    pub fn ask(&mut self, askers: impl Iterator<Item = (RayKind, u32)>) {
        self.kinds.clear();
        self.latest.clear();
        for (kind, parent) in askers {
            self.kinds.push(kind);
            self.latest.push(parent);
        }
    }

    /// The latest record of ray `i` of the query under way.
    pub fn latest(&self, i: usize) -> u32 {
        self.latest[i]
    }

    /// Records hits; `rays[slot]` is ray `which[slot]` of the query, once more if it has been recorded before.
    pub fn closest(&mut self, rays: &[Ray], hits: &[Hit], which: impl Iterator<Item = usize>) {
        for ((ray, hit), i) in rays.iter().zip(hits).zip(which) {
            let found = hit.is_hit().then_some(RayHit { t: hit.t, alpha: hit.alpha, beta: hit.beta, prim: hit.prim });
            self.push(ray, i, RayAnswer::Closest(found));
        }
    }

    /// Records what was in the way.
    pub fn any(&mut self, rays: &[Ray], blocked: &[bool]) {
        for (i, (ray, blocked)) in rays.iter().zip(blocked).enumerate() {
            self.push(ray, i, RayAnswer::Any(*blocked));
        }
    }

    fn push(&mut self, ray: &Ray, i: usize, answer: RayAnswer) {
        let own = self.block.rays.len() as u32;
        self.block.rays.push(RayRecord {
            kind: self.kinds[i],
            parent: std::mem::replace(&mut self.latest[i], own),
            origin: ray.origin.to_array(),
            dir: ray.dir.to_array(),
            interval: [ray.t_min, ray.t_max],
            answer,
        });
    }

    /// Takes searches of this batch's paths.
    pub fn searches(&mut self, searches: &mut Vec<SearchRecord>) {
        self.block.searches.append(searches);
    }

    /// Hands the batch over.
    pub fn finish(self) {
        self.sink.record(&self.block);
    }
}

/// A search as it is recorded.
pub(crate) fn search_record(
    map: MapKind,
    kernel: Kernel,
    parent: u32,
    query: &GatherQuery,
    found: u32,
    answer: SearchAnswer,
) -> SearchRecord {
    SearchRecord {
        map,
        // The renderer's maps have these two.
        kernel: if kernel == Kernel::Epanechnikov { SearchKernel::Epanechnikov } else { SearchKernel::Constant },
        parent,
        position: query.position.to_array(),
        radius: query.radius,
        normal: query.normal.to_array(),
        max_depth: query.max_depth,
        found,
        answer,
    }
}

/// Flux as it is recorded.
pub(crate) fn sum(flux: Vec3) -> SearchAnswer {
    SearchAnswer::Sum(flux.to_array())
}

/// A path's record before its first ray.
pub(crate) const NOT_YET: u32 = NO_PARENT;
