//! The thesis's workload: rooms 1 to 4 make as many rays, searches and tests as the thesis's four test models did
//! (Hoggins 2010, tables 8, 10, 17, 20 and 28), at its settings and on a smaller picture.

mod common;

use common::{json, run};

/// How far each figure may lie from the thesis's.
const TOLERANCE: f64 = 0.15;
/// How far above the thesis's the inclusion tests of a search may lie in each room. Here a photon must also lie on a
/// surface turned like the query's: the more foliage, the more photons are tested for one that is found.
const INCLUSION_ABOVE: [f64; 4] = [0.15, 0.25, 0.50, 0.55];
/// Pixels of the thesis's pictures.
const PIXELS: f64 = 800.0 * 600.0;

/// What the thesis counted in a rendering.
struct Workload {
    scene: &'static str,
    /// Table 20; photons' rays with the viewer's.
    rays: f64,
    /// Table 10.
    tests: f64,
    /// Table 8, for 50,000 photons and a radius of 20.
    stored: f64,
    found: f64,
    /// Table 17: tests of all searches, and those of brute force, which are searches times stored photons.
    inclusion: [f64; 2],
}

const THESIS: [Workload; 4] = [
    Workload {
        scene: "room-1",
        rays: 2_911_071.0,
        tests: 7.985e7,
        stored: 65_756.0,
        found: 85.686,
        inclusion: [8.950e8, 1.509e11],
    },
    Workload {
        scene: "room-2",
        rays: 3_208_094.0,
        tests: 9.753e7,
        stored: 71_049.0,
        found: 90.444,
        inclusion: [1.146e9, 1.796e11],
    },
    Workload {
        scene: "room-3",
        rays: 3_451_328.0,
        tests: 1.293e8,
        stored: 70_497.0,
        found: 88.909,
        inclusion: [1.160e9, 1.905e11],
    },
    Workload {
        scene: "room-4",
        rays: 3_674_338.0,
        tests: 1.317e8,
        stored: 70_583.0,
        found: 86.710,
        inclusion: [1.222e9, 2.021e11],
    },
];

/// Searches of a ray; the thesis gives their number for its first room alone (table 28).
const SEARCHES_PER_RAY: f64 = 2_294_307.0 / 2_911_071.0;

/// The thesis's settings but for the picture's size.
const SETTINGS: &[&str] = &[
    "--mode",
    "direct",
    "--photons",
    "50000",
    "--radius",
    "20",
    "--knn",
    "100",
    "--surface-model",
    "fixed",
    "--passes",
    "1",
    "--profile-every",
    "1",
    "--accel",
    "kd-tree",
    "--intersect",
    "badouel-thesis",
    "--search",
    "kd-balanced",
    "--quiet",
    "--json",
    "-o",
    "a.exr",
];

/// Two sizes of pictures; counts grow with the pixels from what the photons make of them.
const SIZES: [(&str, f64); 2] = [("12x9", 108.0), ("120x90", 10_800.0)];

#[test]
fn rooms_make_the_workload_of_the_thesis() {
    for (thesis, inclusion_above) in THESIS.iter().zip(INCLUSION_ABOVE) {
        let [few, stats] =
            SIZES.map(|(size, _)| json(&run(&[&["render", thesis.scene, "--size", size], SETTINGS].concat())));
        let number = |group: &str, field: &str| stats[group][field].as_f64().unwrap();
        let at_full_size = |group: &str, field: &str| {
            let [small, large] = [&few, &stats].map(|stats| stats[group][field].as_f64().unwrap());
            let a_pixel = (large - small) / (SIZES[1].1 - SIZES[0].1);
            large + a_pixel * (PIXELS - SIZES[1].1)
        };
        let rays = at_full_size("rays", "total");
        for (what, here, there) in [
            ("rays", rays, thesis.rays),
            ("searches", at_full_size("search", "searches"), SEARCHES_PER_RAY * thesis.rays),
            ("photons stored", number("photons", "stored"), thesis.stored),
            ("photons found of a search", number("search", "photons_found_mean"), thesis.found),
            ("tests of a ray", at_full_size("intersect", "tests") / rays, thesis.tests / thesis.rays),
        ] {
            let ratio = here / there;
            assert!((ratio - 1.0).abs() < TOLERANCE, "{}: {what}: {here} for {there}: {ratio:.3}", thesis.scene);
        }
        let [smart, brute_force] = thesis.inclusion;
        let here = number("search", "tests_per_search");
        let there = smart / (brute_force / thesis.stored);
        let ratio = here / there;
        let held = 1.0 - TOLERANCE..1.0 + inclusion_above;
        assert!(held.contains(&ratio), "{}: inclusion tests: {here} for {there}: {ratio:.3}", thesis.scene);
    }
}
