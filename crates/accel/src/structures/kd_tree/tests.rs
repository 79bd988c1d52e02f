//! The tree's invariants, its equality under equal cost ratios, and its bounds on depth and memory.

use super::*;
use crate::options::{Clip, SplitCandidates};
use photinus_geometry::{Hit, Vec3};
use photinus_num::{Sampler, StreamKind};

fn soup(seed: u64, count: u32) -> Primitives {
    let mut out = Primitives::default();
    for i in 0..count {
        let mut s = Sampler::new(seed, StreamKind::Test, 0, i);
        let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
        let (a, b, c) = (vec3(), vec3(), vec3());
        out.positions.extend([a, a + 0.05 * b, a + 0.05 * c]);
        out.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    out
}

fn options(candidates: SplitCandidates, node_cost: f64, triangle_cost: f64) -> BuildOptions {
    BuildOptions { candidates, node_cost, triangle_cost, ..BuildOptions::default() }
}

#[test]
fn equal_cost_ratios_give_equal_trees() {
    let primitives = soup(1, 3000);
    for (_, candidates) in SplitCandidates::ALL {
        let build = |n, t| KdTree::new(&primitives, &options(candidates, n, t)).unwrap();
        let base = build(0.5, 0.5);
        for cost in [1.0, 0.1, 7.0] {
            let other = build(cost, cost);
            assert!(base.nodes == other.nodes && base.refs == other.refs, "{candidates:?}, cost {cost}");
        }
        let third = build(0.1, 0.3);
        let also = build(0.7, 2.1);
        assert!(third.nodes == also.nodes && third.nodes != base.nodes);
    }
}

#[test]
fn every_leaf_lists_exactly_the_primitives_that_reach_into_its_cell() {
    let primitives = soup(2, 800);
    for (_, candidates) in SplitCandidates::ALL {
        let tree = KdTree::new(&primitives, &options(candidates, 0.5, 0.5)).unwrap();
        let mut leaves = 0;
        tree.visit_cells(|cell| {
            let KdCellKind::Leaf(LeafRange { start, count }) = cell.kind else { return };
            leaves += 1;
            let reaching: Vec<u32> = (0..800u32)
                .filter(|id| {
                    let b = crate::bounds::padded_bounds(&primitives, *id as usize).unwrap();
                    (0..3).all(|k| {
                        let below = b.min[k] < cell.bounds.max[k] || cell.bounds.max[k] == tree.bounds.max[k];
                        let above = b.max[k] > cell.bounds.min[k] || cell.bounds.min[k] == tree.bounds.min[k];
                        below && above
                    })
                })
                .collect();
            assert_eq!(&tree.refs[start as usize..(start + count) as usize], reaching);
        });
        assert!(leaves > 100);
    }
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let primitives = soup(3, 10_000);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| KdTree::new(&primitives, &BuildOptions::default()).unwrap())
    };
    let one = run(1);
    for threads in [2, 7] {
        let other = run(threads);
        assert!(one.nodes == other.nodes && one.refs == other.refs);
    }
}

/// Points of triangles lie in leaves that list them, whatever of their bounds is cut away.
#[test]
fn cut_triangles_stay_where_they_are_and_cost_less() {
    let primitives = soup(10, 2000);
    let clipped = |clip| BuildOptions { clip, ..BuildOptions::default() };
    for (_, candidates) in SplitCandidates::ALL {
        let build = |clip| KdTree::new(&primitives, &BuildOptions { candidates, ..clipped(clip) }).unwrap();
        let (whole, cut) = (build(Clip::Box), build(Clip::Exact));
        assert!(cut.summary().sah_cost < whole.summary().sah_cost, "{candidates:?}");
        let mut cells = Vec::new();
        cut.visit_cells(|cell| cells.push(*cell));
        for id in (0..2000).step_by(37) {
            let [a, b, c] = primitives.triangle(id);
            for point in [a, b, c, (a + b) * 0.5, (a + b) * 0.3 + c * 0.4] {
                let mut held = 0;
                for cell in cells.iter().filter(|cell| cell.bounds.contains(point)) {
                    let KdCellKind::Leaf(LeafRange { start, count }) = cell.kind else { continue };
                    held += 1;
                    assert!(
                        cut.refs[start as usize..(start + count) as usize].contains(&(id as u32)),
                        "{id} at {point}"
                    );
                }
                assert!(held > 0);
            }
        }
    }
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| KdTree::new(&soup(11, 6000), &clipped(Clip::Exact)).unwrap())
    };
    let (one, many) = (run(1), run(7));
    assert!(one.nodes == many.nodes && one.refs == many.refs);
}

#[test]
fn dearer_nodes_make_shallower_trees_and_more_tests() {
    let primitives = soup(4, 5000);
    let summary = |n| KdTree::new(&primitives, &options(SplitCandidates::Sampled, n, 1.0)).unwrap().summary();
    let mut last = summary(0.01);
    for cost in [1.0, 10.0, 100.0] {
        let next = summary(cost);
        assert!(next.depth < last.depth && next.prims_per_leaf > last.prims_per_leaf, "{next:?} after {last:?}");
        last = next;
    }
}

#[test]
fn more_candidates_make_cheaper_trees() {
    let primitives = soup(5, 3000);
    let cost = |candidates, count| {
        let options = BuildOptions { candidate_count: count, ..options(candidates, 0.5, 0.5) };
        KdTree::new(&primitives, &options).unwrap().summary().sah_cost
    };
    let bounds = cost(SplitCandidates::Bounds, 100);
    let sampled = cost(SplitCandidates::Sampled, 100);
    let uniform = cost(SplitCandidates::Uniform, 4);
    assert!(bounds < 1.02 * sampled && sampled < uniform, "{bounds} {sampled} {uniform}");
}

#[test]
fn free_nodes_end_all_the_same() {
    let mut primitives = soup(6, 200);
    // Many copies of one triangle cannot be divided.
    for _ in 0..100 {
        primitives.triangles.push(primitives.triangles[0]);
    }
    for (_, candidates) in SplitCandidates::ALL {
        let tree = KdTree::new(&primitives, &options(candidates, 0.0, 1.0)).unwrap();
        let summary = tree.summary();
        assert!(summary.depth <= build::MAX_DEPTH);
        assert!(summary.references + summary.empty_leaves <= 32 * 300, "{summary:?}");
    }
}

#[test]
fn leaves_come_front_to_back_and_hold_the_hit() {
    let primitives = soup(7, 2000);
    let tree = KdTree::new(&primitives, &BuildOptions::default()).unwrap();
    let built = build(Arc::new(primitives.clone()), &BuildOptions::default()).unwrap();
    let mut hits = 0;
    for i in 0..500 {
        let mut s = Sampler::new(8, StreamKind::Test, 0, i);
        let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
        let (a, b) = (vec3(), vec3());
        let ray = Ray::new(a, b - a);
        let leaves = built.leaves(&ray).unwrap();
        let mut entries = Vec::new();
        for leaf in &leaves {
            tree.visit_cells(|cell| {
                if cell.kind == KdCellKind::Leaf(*leaf) {
                    let t0 = (cell.bounds.min - a) / ray.dir;
                    let t1 = (cell.bounds.max - a) / ray.dir;
                    entries.push(t0.min(t1).max_element().max(0.0));
                }
            });
        }
        assert_eq!(entries.len(), leaves.len());
        assert!(entries.is_sorted_by(|x, y| x <= &(y + 1e-4)), "{entries:?}");
        let mut hit = [Hit::MISS];
        built.closest_hit(&[ray], &mut hit);
        let [hit] = hit;
        if hit.is_hit() {
            hits += 1;
            let holds = |l: &LeafRange| tree.refs[l.start as usize..(l.start + l.count) as usize].contains(&hit.prim);
            assert!(leaves.iter().any(holds));
        }
    }
    assert!(hits > 100);
}

#[test]
fn senseless_options_are_refused() {
    let primitives = soup(9, 1);
    for (n, t) in [(-1.0, 1.0), (f64::NAN, 1.0), (1.0, 0.0), (1.0, f64::INFINITY)] {
        let error = KdTree::new(&primitives, &options(SplitCandidates::Bounds, n, t)).err().expect("refused");
        assert!(error.to_string().contains("cost is"), "{error}");
    }
    let none = BuildOptions { candidate_count: 0, ..BuildOptions::default() };
    assert!(KdTree::new(&primitives, &none).is_err());
}
