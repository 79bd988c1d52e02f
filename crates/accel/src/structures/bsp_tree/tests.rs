//! The tree's invariants: what is in which leaf, planes along triangles, and its bounds on depth and memory.

use super::*;
use photinus_geometry::{Sphere, Vec3};
use photinus_num::{Sampler, StreamKind};

fn soup(seed: u64, count: u32, size: f32) -> Primitives {
    let mut out = Primitives::default();
    for i in 0..count {
        let mut s = Sampler::new(seed, StreamKind::Test, 0, i);
        let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
        let (a, b, c) = (vec3(), vec3(), vec3());
        out.positions.extend([a, a + size * (b - 0.5), a + size * (c - 0.5)]);
        out.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    out
}

fn tree(primitives: &Primitives, options: &BuildOptions) -> BspTree {
    BspTree::new(primitives, options).unwrap()
}

/// References of the leaves whose cells hold a point, one point on a plane being on both sides.
fn leaves_at(tree: &BspTree, point: Vec3) -> Vec<Range<usize>> {
    let (mut waiting, mut out) = (vec![0], Vec::new());
    while let Some(index) = waiting.pop() {
        let (height, above) = match tree.nodes[index].unpack() {
            Unpacked::Leaf(refs) => {
                out.push(refs);
                continue;
            }
            Unpacked::Across { axis, position, above } => (f64::from(point[axis]) - f64::from(position), above),
            Unpacked::Oblique { plane, above } => {
                let Plane { normal, offset } = tree.planes[plane];
                ((0..3).map(|k| f64::from(normal[k]) * f64::from(point[k])).sum::<f64>() - offset, above)
            }
        };
        if height <= 0.0 {
            waiting.push(index + 1);
        }
        if height >= 0.0 {
            waiting.push(above);
        }
    }
    out
}

#[test]
fn every_point_of_a_triangle_lies_in_leaves_that_list_it() {
    let mut primitives = soup(1, 600, 0.3);
    primitives.spheres.push(Sphere { center: Vec3::splat(0.5), radius: 0.2 });
    let tree = tree(&primitives, &BuildOptions { node_cost: 0.1, ..BuildOptions::default() });
    assert!(tree.planes.len() > 50, "{} oblique planes", tree.planes.len());
    for id in 0..600 {
        let [a, b, c] = primitives.triangle(id);
        for i in 0..=8 {
            for j in 0..=8 - i {
                let point = a + (b - a) * (i as f32 * 0.125) + (c - a) * (j as f32 * 0.125);
                let leaves = leaves_at(&tree, point);
                assert!(!leaves.is_empty());
                for refs in leaves {
                    assert!(tree.refs[refs].contains(&(id as u32)), "triangle {id} at {point}");
                }
            }
        }
    }
    for i in 0..200 {
        let mut s = Sampler::new(2, StreamKind::Test, 0, i);
        let dir = Vec3::new(s.next_1d() - 0.5, s.next_1d() - 0.5, s.next_1d() - 0.5).normalize();
        for refs in leaves_at(&tree, Vec3::splat(0.5) + dir * 0.2) {
            assert!(tree.refs[refs].contains(&600));
        }
    }
}

#[test]
fn oblique_planes_make_cheaper_trees() {
    // Slanted squares, one behind the other: no plane across an axis parts them.
    let mut primitives = Primitives::default();
    for i in 0..12u32 {
        let at = Vec3::new(0.02, 0.02, 0.02) * i as f32;
        let (u, v) = (Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.5, 0.5, -1.0));
        primitives.positions.extend([at, at + u, at + v]);
        primitives.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let cost = |oblique_prims| {
        let options = BuildOptions { oblique_prims, node_cost: 0.1, ..BuildOptions::default() };
        let tree = tree(&primitives, &options);
        (tree.summary(), tree.planes.len())
    };
    let (across, none) = cost(0);
    let (any, some) = cost(16);
    assert!(none == 0 && some > 5, "{some} oblique planes");
    assert!(any.sah_cost < 0.7 * across.sah_cost, "{any:?} and {across:?}");
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let primitives = soup(3, 5000, 0.05);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| tree(&primitives, &BuildOptions::default()))
    };
    let one = run(1);
    for threads in [2, 7] {
        let other = run(threads);
        assert!(one.nodes == other.nodes && one.refs == other.refs && one.planes == other.planes);
    }
}

#[test]
fn what_cannot_be_divided_ends_all_the_same() {
    let mut primitives = soup(4, 100, 0.3);
    for _ in 0..100 {
        primitives.triangles.push(primitives.triangles[0]);
    }
    for node_cost in [0.0, 0.01] {
        let summary = tree(&primitives, &BuildOptions { node_cost, ..BuildOptions::default() }).summary();
        assert!(summary.depth <= 96 + 48 && summary.references + summary.empty_leaves <= 32 * 200, "{summary:?}");
    }
    let refused = |options: BuildOptions| BspTree::new(&primitives, &options).is_err();
    assert!(refused(BuildOptions { oblique_cost: f64::NAN, ..BuildOptions::default() }));
    assert!(refused(BuildOptions { oblique_prims: 257, ..BuildOptions::default() }));
    assert!(refused(BuildOptions { node_cost: -1.0, ..BuildOptions::default() }));
}
