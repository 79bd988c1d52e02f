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
