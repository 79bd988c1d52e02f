//! A batch of rays past all blocks: a chunk of boxes stays in the nearest cache while every ray of the batch is sifted
//! through it.
//!
//! Blocks that pass a ray's sieve are listed first and filtered then, and what the filter leaves is finished for all rays
//! of the batch together: no step waits for a branch on what the one before it found.
//!
//! The triangles of a ray are finished in the order of their ids, and one is a hit where it lies within what is left of the
//! ray's interval then. So neither hits nor their number depend on the batch, the kernel or when lists are emptied.

use super::blocked::Blocked;
use super::kernels::Kernel;
use super::layout::{CHUNK, LANES};
use super::sieve::Sieve;
use crate::reach::Reach;
use crate::structure::RayCounters;
use photinus_geometry::{Hit, Ray};
use photinus_intersect::RtiMethod;
use photinus_intersect::doubles::Lanes;
use photinus_intersect::methods::woop::{Started, Woop, finish_lanes};

/// Rays of a batch: their state stays in the second cache, and triangles come from farther away once for all of them.
const BATCH: usize = 1024;

/// Candidates that are finished at a time: doubles in the widest register.
const TOGETHER: usize = 8;

/// A list of candidates this long is finished before the next ray adds to it; one ray adds at most a chunk.
const ENOUGH: usize = 1024;

/// A ray under way.
struct Traced {
    woop: Started<f32>,
    sieve: Sieve,
    t_min: f32,
    /// Where the search ends: the end of the ray or its nearest hit.
    t_max: f32,
    best: Hit,
    /// Index in the slice of all.
    ray: usize,
}

impl Traced {
    #[inline(always)]
    fn new(ray: &Ray, index: usize, middle: &[f64; 3]) -> Option<Self> {
        let woop = <Woop as RtiMethod<f32>>::start(ray.origin.to_array(), ray.dir.to_array())?;
        let sieve = Sieve::new(&woop, middle);
        Some(Self { woop, sieve, t_min: ray.t_min, t_max: ray.t_max, best: Hit::MISS, ray: index })
    }
}

/// A triangle that the filter left.
struct Candidate {
    /// Place of its ray among those under way.
    place: u32,
    /// Its id.
    id: u32,
}

impl Blocked {
    /// The nearest hits, or with `ANY` any hits, of all rays, handed to `set`.
    #[inline(always)]
    pub(super) fn trace<K: Kernel, const ANY: bool>(
        &self,
        kernel: K,
        rays: &[Ray],
        mut set: impl FnMut(usize, Hit),
        counters: &mut RayCounters,
    ) {
        let all = (rays.len() * self.len()) as u64;
        counters.traversal.rays += rays.len() as u64;
        counters.traversal.leaves_visited += rays.len() as u64;
        counters.traversal.leaf_prims += all;
        counters.intersect.tests += all;
        let mut under_way = Vec::with_capacity(BATCH.min(rays.len()));
        let mut candidates = Vec::new();
        for first in (0..rays.len()).step_by(BATCH) {
            let batch = &rays[first..rays.len().min(first + BATCH)];
            for (i, ray) in (first..).zip(batch) {
                match Traced::new(ray, i, &self.blocks.middle) {
                    Some(traced) => under_way.push(traced),
                    None => set(i, Hit::MISS),
                }
            }
            let chunks = self.blocks.boxes.len().div_ceil(CHUNK);
            for chunk in 0..chunks {
                self.pass_chunk::<K, ANY>(kernel, chunk, &mut under_way, &mut candidates, counters);
                if ANY {
                    // What comes after the chunk is spared the rays that hit something.
                    let seen = ((chunk + 1) * CHUNK * LANES).min(self.triangles);
                    under_way.retain(|traced| {
                        if traced.best.is_hit() {
                            counters.intersect.tests -= (self.len() - seen) as u64;
                            set(traced.ray, traced.best);
                        }
                        !traced.best.is_hit()
                    });
                }
            }
            for mut traced in under_way.drain(..) {
                if !self.sphere_ids.is_empty() {
                    self.pass_spheres::<ANY>(&rays[traced.ray], &mut traced.best, counters);
                }
                set(traced.ray, traced.best);
            }
        }
    }

    /// Takes all rays past a chunk.
    #[inline(always)]
    fn pass_chunk<K: Kernel, const ANY: bool>(
        &self,
        kernel: K,
        chunk: usize,
        under_way: &mut [Traced],
        candidates: &mut Vec<Candidate>,
        counters: &mut RayCounters,
    ) {
        let first = chunk * CHUNK;
        let last = self.blocks.boxes.len().min(first + CHUNK);
        let (boxes, vertices) = (&self.blocks.boxes[first..last], &self.blocks.vertices[first..last]);
        for place in 0..under_way.len() {
            let traced = &under_way[place];
            let mut passed = kernel.sift(&traced.sieve, boxes);
            let reach = Reach::new(traced.woop.dir_z, traced.t_min, traced.t_max);
            while passed != 0 {
                let block = passed.trailing_zeros() as usize;
                passed &= passed - 1;
                let mut mask = kernel.filter(&traced.woop, &reach, &vertices[block]);
                while mask != 0 {
                    let id = ((first + block) * LANES) as u32 + mask.trailing_zeros();
                    candidates.push(Candidate { place: place as u32, id });
                    mask &= mask - 1;
                }
            }
            if candidates.len() >= ENOUGH {
                counters.intersect.hits += self.finish::<ANY>(under_way, candidates);
            }
        }
        counters.intersect.hits += self.finish::<ANY>(under_way, candidates);
    }

    /// Finishes the candidates, of each ray in the order of their ids, and returns how many are hits.
    #[inline(always)]
    fn finish<const ANY: bool>(&self, under_way: &mut [Traced], candidates: &mut Vec<Candidate>) -> u64 {
        let mut hits = 0;
        for group in candidates.chunks(TOGETHER) {
            let (mut sheared, mut dir_z) = ([[[0.0; TOGETHER]; 3]; 3], [1.0; TOGETHER]);
            for (i, candidate) in group.iter().enumerate() {
                let woop = &under_way[candidate.place as usize].woop;
                let (block, lane) = (candidate.id as usize / LANES, candidate.id as usize % LANES);
                let rows = &self.blocks.vertices[block].rows;
                let vertices = woop.sheared(|vertex, axis| rows[3 * vertex + axis][lane]);
                for (to, from) in sheared.as_flattened_mut().iter_mut().zip(vertices.as_flattened()) {
                    to[i] = f64::from(*from);
                }
                dir_z[i] = f64::from(woop.dir_z);
            }
            let found = finish_lanes(&sheared.map(|v| v.map(Lanes)), Lanes(dir_z));
            for (i, candidate) in group.iter().enumerate() {
                let traced = &mut under_way[candidate.place as usize];
                let [t, alpha, beta] = [found.t, found.alpha, found.beta].map(|lanes| lanes.0[i] as f32);
                let is_hit = found.hits >> i & 1 == 1;
                let hit = Hit { t, alpha, beta, prim: candidate.id };
                if is_hit & (t >= traced.t_min) & (t <= traced.t_max) & t.is_finite() {
                    hits += 1;
                    if hit.beats(&traced.best) {
                        traced.best = hit;
                        traced.t_max = if ANY { f32::NEG_INFINITY } else { t };
                    }
                }
            }
        }
        candidates.clear();
        hits
    }

    /// Takes a ray past the spheres.
    #[inline(never)]
    fn pass_spheres<const ANY: bool>(&self, ray: &Ray, best: &mut Hit, counters: &mut RayCounters) {
        if !ANY {
            counters.intersect.hits += u64::from(self.spheres.closest_hit(ray, &self.sphere_ids, best).hits);
            return;
        }
        let (any, work) = self.spheres.any_hit(ray, &self.sphere_ids);
        counters.intersect.hits += u64::from(work.hits);
        counters.intersect.tests -= self.sphere_ids.len() as u64 - u64::from(work.tests);
        if any {
            // Which one was hit is not asked for.
            best.prim = self.sphere_ids[0];
        }
    }
}
