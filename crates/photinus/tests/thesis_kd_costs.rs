//! Tables 3 and 4 of the thesis: only the ratio of the costs matters to a kd-tree, so that rows of equal ratio are equal.

use photinus::{BuildOptions, LoadOptions, TreeOptions, TreeReport, build_tree};

/// The printed rows come in pairs of one ratio: node and triangle cost in table 3, and in table 4.
const PAIRS: [[(f64, f64); 2]; 8] = [
    [(50.0, 1.0), (0.5, 0.01)],
    [(10.0, 1.0), (0.5, 0.05)],
    [(5.0, 1.0), (0.5, 0.1)],
    [(1.0, 1.0), (0.5, 0.5)],
    [(0.5, 1.0), (0.5, 1.0)],
    [(0.1, 1.0), (0.5, 5.0)],
    [(0.05, 1.0), (0.5, 10.0)],
    [(0.01, 1.0), (0.5, 50.0)],
];

#[test]
fn rows_of_equal_cost_ratio_have_equal_trees_and_tests() {
    let scene = photinus::open("room-1", &LoadOptions::default()).unwrap();
    let report = |(node_cost, triangle_cost): (f64, f64)| -> TreeReport {
        let build = BuildOptions { node_cost, triangle_cost, ..BuildOptions::default() };
        build_tree(scene.clone(), &TreeOptions { accel: "kd-tree".into(), build }).unwrap().report
    };
    let mut last: Option<TreeReport> = None;
    for [a, b] in PAIRS {
        let (first, second) = (report(a), report(b));
        assert_eq!((&first.structure, first.rays), (&second.structure, second.rays), "costs {a:?} and {b:?}");
        assert!(first.rays.rays >= 100_000);
        // Cheaper nodes: deeper trees, fewer tests, as in the thesis.
        if let Some(last) = last {
            let (deeper, fewer) = (first.structure.depth >= last.structure.depth, first.rays.tests_per_ray);
            assert!(deeper && fewer < 1.01 * last.rays.tests_per_ray, "costs {a:?}: {first:?} after {last:?}");
        }
        last = Some(first);
    }
}
