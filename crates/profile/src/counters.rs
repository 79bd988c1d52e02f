//! Counters of the three core functions of the thesis: ray-triangle tests, structure traversal, photon search.

use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

macro_rules! counters {
    ($(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
        pub struct $name { $($(#[$field_doc])* pub $field: u64),* }

        impl AddAssign for $name {
            fn add_assign(&mut self, other: Self) {
                $(self.$field += other.$field;)*
            }
        }
    };
}

counters! {
    /// Ray-primitive tests (thesis: RTI).
    IntersectCounters {
        /// Ray-triangle and ray-sphere tests; a wide test counts its valid lanes.
        tests,
        /// Tests that hit within the ray's interval.
        hits,
    }
}

counters! {
    /// Structure traversal (thesis: RAS).
    TraversalCounters {
        /// Rays traced.
        rays,
        /// Nodes visited, leaves excluded.
        nodes_visited,
        /// Leaves visited.
        leaves_visited,
        /// Primitives in the leaves visited.
        leaf_prims,
    }
}

counters! {
    /// Photon search (thesis: PS).
    SearchCounters {
        /// Searches made.
        searches,
        /// Photons tested against a search volume.
        photons_tested,
        /// Photons found inside one.
        photons_found,
    }
}

counters! {
    /// Ticks of the processor's clock ([`crate::ticks`]) in the ray queries that were counted.
    RayTicks {
        /// In all of them, from their first stamp to their last.
        total,
        /// In tests alone.
        tests,
        /// Pairs of stamps around tests.
        pairs,
    }
}

impl RayTicks {
    /// Share of the tests, 0 to 1, with what the stamps themselves took left out; the rest is traversal. None where
    /// nothing was counted.
    pub fn test_share(&self, ticks_of_a_stamp: f64) -> Option<f64> {
        let stamps = self.pairs as f64 * ticks_of_a_stamp;
        let total = self.total as f64 - 2.0 * stamps;
        let tests = (self.tests as f64 - stamps).max(0.0);
        (total > 0.0).then(|| (tests / total).min(1.0))
    }
}

counters! {
    /// Ticks of the processor's clock in the photon estimates that were counted.
    EstimateTicks {
        /// In all of them.
        total,
        /// In searches alone.
        searches,
    }
}

impl EstimateTicks {
    /// Share of the searches, 0 to 1; the rest weighs what they found. None where nothing was counted.
    pub fn search_share(&self) -> Option<f64> {
        (self.total > 0).then(|| (self.searches as f64 / self.total as f64).min(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_are_taken_out_of_the_shares() {
        // 100 ticks of tests and 300 of traversal, in ten pairs of stamps of 3 ticks: one falls into the tests, two
        // into the whole.
        let ticks = RayTicks { total: 400 + 60, tests: 100 + 30, pairs: 10 };
        assert!((ticks.test_share(3.0).unwrap() - 0.25).abs() < 1e-12);
        assert_eq!(RayTicks::default().test_share(3.0), None);
        assert_eq!(RayTicks { total: 10, tests: 0, pairs: 0 }.test_share(3.0), Some(0.0));
    }

    #[test]
    fn searches_and_the_rest_make_the_estimates() {
        assert_eq!(EstimateTicks { total: 8, searches: 6 }.search_share(), Some(0.75));
        assert_eq!(EstimateTicks::default().search_share(), None);
    }
}
