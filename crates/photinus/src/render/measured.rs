//! The profile of a render from what it counted: counts and shares of the queries that ran the instrumented twin, scaled
//! up to all of them, and the processor time of all batches.

use photinus_accel::StructureSummary;
use photinus_profile::{AccelProfile, IntersectProfile, SearchProfile, ticks_of_a_stamp};
use photinus_render::Counters;

/// What the three accelerated functions did and took.
pub(super) struct Measured {
    pub intersect: IntersectProfile,
    pub accel: AccelProfile,
    pub search: SearchProfile,
    /// Thread seconds of estimates outside their searches.
    pub density_estimate_secs: f64,
    /// Thread seconds where rays land.
    pub surfaces_secs: f64,
}

impl Measured {
    pub fn of(counters: &Counters, structure: &StructureSummary, search: &str) -> Self {
        let rays = counters.rays.total();
        let (counted, tests) = (counters.sampled_rays.traversal, counters.sampled_rays.intersect);
        let ray_secs = seconds(counters.spent.rays);
        let test_secs = ray_secs * counters.sampled_rays.ticks.test_share(ticks_of_a_stamp()).unwrap_or(0.0);
        let tests_per_ray = ratio(tests.tests, counted.rays);
        let nodes_per_ray = ratio(counted.nodes_visited, counted.rays);
        let estimate_secs = seconds(counters.spent.estimates);
        let search_secs = estimate_secs * counters.sampled_estimates.search_share().unwrap_or(1.0);
        let searched = counters.sampled_searches;
        let tests_per_search = ratio(searched.photons_tested, searched.searches);
        Self {
            intersect: IntersectProfile {
                tests: tests_per_ray * rays as f64,
                tests_per_ray,
                hits_per_ray: ratio(tests.hits, counted.rays),
                seconds: test_secs,
            },
            accel: AccelProfile {
                nodes_visited: nodes_per_ray * rays as f64,
                nodes_per_ray,
                leaves_per_ray: ratio(counted.leaves_visited, counted.rays),
                triangles_per_leaf: ratio(counted.leaf_prims, counted.leaves_visited),
                depth: structure.depth,
                seconds: ray_secs - test_secs,
                rays_counted: counted.rays,
            },
            search: SearchProfile {
                name: search.to_owned(),
                searches: counters.searches,
                photons_found_mean: ratio(counters.photons_found, counters.searches),
                photons_tested: tests_per_search * counters.searches as f64,
                tests_per_search,
                seconds: search_secs,
                searches_counted: searched.searches,
            },
            density_estimate_secs: estimate_secs - search_secs,
            surfaces_secs: seconds(counters.spent.surfaces),
        }
    }
}

fn seconds(nanoseconds: u64) -> f64 {
    nanoseconds as f64 * 1e-9
}

/// A mean; 0 where nothing was counted.
fn ratio(sum: u64, count: u64) -> f64 {
    if count == 0 { 0.0 } else { sum as f64 / count as f64 }
}
