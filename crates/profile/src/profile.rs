//! The profile of a render: what the thesis measured (sections 3.4 and 7), as plain data that can be written, read and
//! projected onto hardware without rendering again.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Ray-primitive tests (thesis: RTI). Counts are scaled up from the rays that were counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct IntersectProfile {
    /// Tests of all rays.
    pub tests: f64,
    /// Tests of a ray, in the mean.
    pub tests_per_ray: f64,
    /// Of those, tests that hit within what was left of the ray's interval, in the mean.
    pub hits_per_ray: f64,
    /// Thread seconds in tests.
    pub seconds: f64,
}

/// Structure traversal (thesis: RAS). Counts are scaled up from the rays that were counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AccelProfile {
    /// Nodes visited by all rays, leaves excluded.
    pub nodes_visited: f64,
    /// Nodes visited by a ray, in the mean.
    pub nodes_per_ray: f64,
    /// Leaves visited by a ray, in the mean.
    pub leaves_per_ray: f64,
    /// Primitives of a leaf visited, in the mean.
    pub triangles_per_leaf: f64,
    /// Levels below the root.
    pub depth: u32,
    /// Thread seconds in traversal.
    pub seconds: f64,
    /// Rays that were counted.
    pub rays_counted: u64,
}

/// Photon search (thesis: PS).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SearchProfile {
    /// Member name.
    pub name: String,
    /// Searches made.
    pub searches: u64,
    /// Photons found by a search, in the mean.
    pub photons_found_mean: f64,
    /// Inclusion tests: photons tested by all searches, scaled up from those that were counted.
    pub photons_tested: f64,
    /// Inclusion tests of a search, in the mean.
    pub tests_per_search: f64,
    /// Thread seconds in photon searches, with the sums that they make.
    pub seconds: f64,
    /// Searches that were counted.
    pub searches_counted: u64,
}

/// Photons and rays, as far as the profile needs them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PhotonProfile {
    /// Sent out.
    pub emitted: u64,
    /// Stored.
    pub stored: u64,
}

/// Rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RayProfile {
    /// All that were traced.
    pub total: u64,
}

/// Processor time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ProfileSeconds {
    /// Of all threads together, since the program began.
    pub cpu_secs: f64,
}

/// The contract between renderer and hardware. The document of `--stats` is one, with more beside: fields that are not
/// named here are left unread.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// Name of the scene.
    pub scene: String,
    /// Triangles of the scene, spheres not counted.
    pub triangles: u64,
    /// Processor seconds of everything.
    pub seconds: ProfileSeconds,
    /// Rays.
    pub rays: RayProfile,
    /// Tests.
    pub intersect: IntersectProfile,
    /// Traversal.
    pub accel: AccelProfile,
    /// Photon search.
    pub search: SearchProfile,
    /// Photons, all but those sent out for caustics alone.
    pub photons: PhotonProfile,
    /// Photons sent out for caustics alone.
    #[serde(default)]
    pub caustic_photons: PhotonProfile,
    /// Thread seconds of everything else, by function.
    pub other: BTreeMap<String, f64>,
}

/// One of the four rows of the thesis's Table 7.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// What it is called.
    pub name: &'static str,
    /// Thread seconds.
    pub seconds: f64,
    /// Share of all processor time, 0 to 1.
    pub share: f64,
    /// How often, and what is counted; none for the rest.
    pub calls: Option<(f64, &'static str)>,
}

impl Row {
    /// Nanoseconds of a call; none without any.
    pub fn nanoseconds_a_call(&self) -> Option<f64> {
        self.calls.filter(|(count, _)| *count > 0.0).map(|(count, _)| self.seconds * 1e9 / count)
    }
}

impl Profile {
    /// Photons stored, whatever they were sent out for.
    pub fn photons_stored(&self) -> u64 {
        self.photons.stored.saturating_add(self.caustic_photons.stored)
    }

    /// Seconds of what is neither test, traversal nor search: all processor time less those.
    pub fn other_seconds(&self) -> f64 {
        (self.seconds.cpu_secs - self.intersect.seconds - self.accel.seconds - self.search.seconds).max(0.0)
    }

    /// The four rows of the thesis's Table 7, with calls and time of a call as in its Table 9.
    pub fn rows(&self) -> [Row; 4] {
        let whole = self.seconds.cpu_secs;
        let row =
            |name, seconds, calls| Row { name, seconds, share: if whole > 0.0 { seconds / whole } else { 0.0 }, calls };
        [
            row("intersection tests", self.intersect.seconds, Some((self.intersect.tests, "tests"))),
            row("structure traversal", self.accel.seconds, Some((self.rays.total as f64, "rays"))),
            row("photon search", self.search.seconds, Some((self.search.searches as f64, "searches"))),
            row("everything else", self.other_seconds(), None),
        ]
    }
}

/// Share of all time in the three functions that the thesis accelerates, 0 to 1.
pub fn accelerated_share(rows: &[Row; 4]) -> f64 {
    rows[..3].iter().map(|row| row.share).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The thesis's first room: Tables 7, 10, 17, 20 and 28.
    fn room_1() -> Profile {
        Profile {
            seconds: ProfileSeconds { cpu_secs: 137.297 },
            rays: RayProfile { total: 2_911_071 },
            intersect: IntersectProfile { tests: 7.985e7, seconds: 14.606, ..Default::default() },
            accel: AccelProfile { seconds: 8.407, ..Default::default() },
            search: SearchProfile { searches: 2_294_307, seconds: 89.961, ..Default::default() },
            ..Default::default()
        }
    }

    #[test]
    fn rows_are_those_of_the_thesis() {
        let rows = room_1().rows();
        let shares = [10.638, 6.123, 65.523, 17.716];
        for (row, share) in rows.iter().zip(shares) {
            assert!((100.0 * row.share - share).abs() < 0.001, "{}: {}", row.name, row.share);
        }
        // Tables 9 and 28: 39.211 us a search.
        assert!((rows[2].nanoseconds_a_call().unwrap() - 39_211.0).abs() < 1.0);
        assert_eq!(rows[3].nanoseconds_a_call(), None);
        assert!((accelerated_share(&rows) - 0.82284).abs() < 1e-4);
    }

    #[test]
    fn a_profile_is_read_back_and_what_it_does_not_know_is_left() {
        let mut document = serde_json::to_value(room_1()).unwrap();
        document["passes"] = 3.into();
        document["accel"]["structure"] = "more".into();
        let read: Profile = serde_json::from_value(document).unwrap();
        assert_eq!(read, room_1());
    }

    #[test]
    fn an_empty_profile_has_rows_without_numbers_that_are_none() {
        for row in Profile::default().rows() {
            assert_eq!((row.seconds, row.share, row.nanoseconds_a_call()), (0.0, 0.0, None), "{}", row.name);
        }
    }
}
