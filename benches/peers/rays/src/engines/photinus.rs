//! Our default structure, asked in batches as the renderer asks.

use super::Engine;
use crate::Arguments;
use crate::meshes::Mesh;
use crate::sets::Set;
use photinus_accel::{BuildOptions, DEFAULT_STRUCTURE, RayCounters, Structure};
use photinus_geometry::{Hit, Ray};

/// Rays of a batch: a tile's.
const BATCH: usize = 1024;

struct Ours(Box<dyn Structure>);

/// Builds the tree as renders do.
pub fn build(mesh: &Mesh, _: &Arguments) -> Result<Box<dyn Engine>, String> {
    build_with(mesh, &BuildOptions::default())
}

/// Builds the tree without reinsertions, which are what others' builds do without.
pub fn build_quickly(mesh: &Mesh, _: &Arguments) -> Result<Box<dyn Engine>, String> {
    build_with(mesh, &BuildOptions { reinsertion_rounds: 0, ..BuildOptions::default() })
}

fn build_with(mesh: &Mesh, options: &BuildOptions) -> Result<Box<dyn Engine>, String> {
    let structure = photinus_accel::build(DEFAULT_STRUCTURE, mesh.primitives.clone(), options);
    Ok(Box::new(Ours(structure.map_err(|error| error.to_string())?)))
}

impl Engine for Ours {
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        for (rays, hits) in rays.chunks(BATCH).zip(hits.chunks_mut(BATCH)) {
            self.0.closest_hit(rays, hits);
        }
    }

    fn any(&self, rays: &[Ray], occluded: &mut [bool]) -> bool {
        for (rays, occluded) in rays.chunks(BATCH).zip(occluded.chunks_mut(BATCH)) {
            self.0.any_hit(rays, occluded);
        }
        true
    }

    fn work(&self, set: &Set) -> Option<String> {
        let mut counters = RayCounters::default();
        let (mut hits, mut occluded) = (vec![Hit::MISS; BATCH], vec![false; BATCH]);
        for rays in set.rays.chunks(BATCH) {
            match set.any {
                true => self.0.any_hit_counted(rays, &mut occluded[..rays.len()], &mut counters),
                false => self.0.closest_hit_counted(rays, &mut hits[..rays.len()], &mut counters),
            }
        }
        let (walk, test) = (&counters.traversal, &counters.intersect);
        let [nodes, leaves, tests, hits] = [walk.nodes_visited, walk.leaves_visited, test.tests, test.hits]
            .map(|count| count as f64 / set.rays.len() as f64);
        Some(format!("{nodes:.2} nodes, {leaves:.2} leaves, {tests:.1} tests, {hits:.2} hits a ray"))
    }
}
