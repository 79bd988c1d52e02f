//! The octree's invariants and its bounds on depth and memory.

use super::*;
use crate::bounds::padded_bounds;
use crate::options::Clip;
use photinus_geometry::Vec3;
use photinus_num::{Sampler, StreamKind};

fn soup(seed: u64, count: u32, size: f32) -> Primitives {
    let mut out = Primitives::default();
    for i in 0..count {
        let mut s = Sampler::new(seed, StreamKind::Test, 0, i);
        let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
        let (a, b, c) = (vec3(), vec3(), vec3());
        out.positions.extend([a, a + size * b, a + size * c]);
        out.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    out
}

fn tree(primitives: &Primitives, options: &BuildOptions) -> Octree {
    Octree::new(primitives, options).unwrap()
}

#[test]
fn leaves_hold_what_reaches_them_and_are_as_small_as_asked() {
    let primitives = soup(1, 1500, 0.05);
    for (leaf_size, tree_depth) in [(1, 3), (6, 16), (20, 4)] {
        let options = BuildOptions { leaf_size: Some(leaf_size), tree_depth, ..BuildOptions::default() };
        let tree = tree(&primitives, &options);
        let mut leaves = 0;
        tree.visit_cells(|depth, cell, node| {
            assert!(depth <= tree_depth);
            let Unpacked::Leaf(refs) = node else { return };
            leaves += 1;
            let reaching: Vec<u32> = (0..1500)
                .filter(|id| {
                    let b = padded_bounds(&primitives, *id as usize).unwrap();
                    b.min.cmple(cell.max).all() && b.max.cmpge(cell.min).all()
                })
                .collect();
            assert_eq!(tree.refs[refs.clone()], reaching);
            assert!(refs.len() <= leaf_size as usize || depth == tree_depth);
        });
        assert!(leaves > 100, "{leaves} leaves");
    }
}

#[test]
fn cut_triangles_make_fewer_references_and_every_point_stays() {
    let primitives = soup(2, 600, 0.2);
    let whole = tree(&primitives, &BuildOptions::default());
    let cut = tree(&primitives, &BuildOptions { clip: Clip::Exact, ..BuildOptions::default() });
    assert!(cut.summary().sah_cost < whole.summary().sah_cost);
    for id in 0..600 {
        let [a, b, c] = primitives.triangle(id);
        let point = (a + b) * 0.3 + c * 0.4;
        let mut held = 0;
        cut.visit_cells(|_, cell, node| {
            let Unpacked::Leaf(refs) = node else { return };
            if cell.contains(point) {
                held += 1;
                assert!(cut.refs[refs.clone()].contains(&(id as u32)), "triangle {id} at {point}");
            }
        });
        assert!(held > 0);
    }
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let primitives = soup(3, 10_000, 0.03);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| tree(&primitives, &BuildOptions { clip: Clip::Exact, ..BuildOptions::default() }))
    };
    let one = run(1);
    for threads in [2, 7] {
        let other = run(threads);
        assert!(one.nodes == other.nodes && one.refs == other.refs);
    }
}

#[test]
fn what_cannot_be_divided_ends_all_the_same() {
    let mut primitives = soup(4, 100, 0.1);
    for _ in 0..1000 {
        primitives.triangles.push(primitives.triangles[0]);
    }
    for clip in [Clip::Box, Clip::Exact] {
        let options = BuildOptions { leaf_size: Some(1), tree_depth: 24, clip, ..BuildOptions::default() };
        let summary = tree(&primitives, &options).summary();
        assert!(summary.references + summary.empty_leaves <= 32 * 1100, "{summary:?}");
    }
    let refused = |options: BuildOptions| Octree::new(&primitives, &options).is_err();
    assert!(refused(BuildOptions { leaf_size: Some(0), ..BuildOptions::default() }));
    assert!(refused(BuildOptions { tree_depth: 25, ..BuildOptions::default() }));
}
