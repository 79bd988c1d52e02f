//! Finished trees, walked from end to end: what every node promises about those below it.

use super::interval_tree::{self, IntervalTree, Planes};
use super::object_build::{self, ByCost};
use super::octree;
use super::refs::{Built, gather};
use super::rule::Rule;
use super::volume_tree::{Holds, VolumeTree};
use crate::bounds::padded_bounds;
use photinus_geometry::{Aabb, Primitives, Sphere, Vec3};
use photinus_num::{Sampler, StreamKind};

/// Triangles of very different sizes, some in one place, and spheres.
fn scene(seed: u64, count: u32) -> Primitives {
    let mut out = Primitives::default();
    for i in 0..count {
        let mut s = Sampler::new(seed, StreamKind::Test, 0, i);
        let mut vec3 = || Vec3::new(s.next_1d(), s.next_1d(), s.next_1d());
        let size = [0.01, 0.05, 0.6][i as usize % 3];
        let (a, b, c) = (vec3(), vec3(), vec3());
        if i % 20 == 0 {
            out.spheres.push(Sphere { center: a, radius: size * 0.5 });
        }
        out.positions.extend([a, a + size * b, a + size * c]);
        out.triangles.push(if i % 50 == 49 { [0, 1, 2] } else { [3 * i, 3 * i + 1, 3 * i + 2] });
    }
    out
}

const RULE: Rule = Rule { cost_ratio: 1.0, bins: 16, leaf_size: usize::MAX };

fn built(primitives: &Primitives, rule: Rule) -> Built<Aabb> {
    object_build::build(&ByCost(rule), &mut gather(primitives), ())
}

fn holds(outer: &Aabb, inner: &Aabb) -> bool {
    outer.contains(inner.min) && outer.contains(inner.max)
}

/// Boxes hold the boxes below them and the whole primitives of their leaves; every primitive is in one leaf.
#[test]
fn boxes_nest_and_hold_every_primitive_once() {
    let primitives = scene(1, 3000);
    for leaf_size in [1, 4, usize::MAX] {
        let rule = Rule { leaf_size, ..RULE };
        let tree = VolumeTree::<Aabb, 80>::new(Some(built(&primitives, rule)));
        let mut ids = tree.refs.clone();
        ids.sort_unstable();
        assert_eq!(ids, (0..primitives.len() as u32).collect::<Vec<_>>());
        let mut largest = 0;
        for node in &tree.nodes {
            match node.holds() {
                Holds::Children(children) => {
                    assert_eq!(children.len(), 2);
                    assert!(tree.nodes[children].iter().all(|child| holds(&node.volume, &child.volume)));
                }
                Holds::Refs(refs) => {
                    largest = largest.max(refs.len());
                    assert!(tree.refs[refs.clone()].is_sorted());
                    for id in &tree.refs[refs] {
                        assert!(holds(&node.volume, &padded_bounds(&primitives, *id as usize).unwrap()));
                    }
                }
            }
        }
        // The sixty equal triangles cannot be divided.
        assert!(largest <= leaf_size.max(61), "{largest} for {leaf_size}");
    }
}

#[derive(Clone, Copy)]
struct Four([[f32; 2]; 2]);

impl Planes for Four {
    fn around(children: [&Aabb; 2], axis: usize) -> Self {
        Self(children.map(|b| [b.min[axis], b.max[axis]]))
    }

    fn slabs(&self) -> [[f32; 2]; 2] {
        self.0
    }
}

/// What planes leave of the bounds holds the whole primitives of each leaf, also after a refit.
#[test]
fn planes_leave_room_for_every_primitive() {
    let mut primitives = scene(2, 2000);
    let mut tree = IntervalTree::<Four>::new(Some(built(&primitives, RULE)));
    for _ in 0..2 {
        let mut seen = 0;
        tree.visit_cells(|_, cell, held| {
            let interval_tree::Holds::Refs(refs) = held else { return };
            for id in &tree.refs[refs.clone()] {
                seen += 1;
                assert!(holds(cell, &padded_bounds(&primitives, *id as usize).unwrap()), "{id}");
            }
        });
        assert_eq!(seen, primitives.len());
        primitives.positions.iter_mut().for_each(|p| *p = Vec3::new(p.z * 3.0, p.x, p.y + 0.1 * p.x));
        let bounds: Vec<Aabb> = (0..primitives.len()).map(|id| padded_bounds(&primitives, id).unwrap()).collect();
        tree.refit(&bounds);
    }
}

/// Voxels hold parts: boxes nest up to padding, leaves keep their limit, and a tighter limit of references makes fewer.
#[test]
fn voxels_keep_their_limits() {
    let primitives = scene(3, 2000);
    let mut last = usize::MAX;
    for limit in [64.0, 4.0, 1.0] {
        let tree = VolumeTree::<Aabb, { octree::STACK }>::new(octree::build(&primitives, 8, limit));
        assert!(tree.refs.len() as f64 <= limit * primitives.len() as f64 && tree.refs.len() < last);
        last = tree.refs.len();
        for node in &tree.nodes {
            if let Holds::Children(children) = node.holds() {
                assert!((2..=8).contains(&children.len()));
                let slack = Vec3::splat(1e-5);
                let room = Aabb { min: node.volume.min - slack, max: node.volume.max + slack };
                assert!(tree.nodes[children].iter().all(|child| holds(&room, &child.volume)));
            }
        }
    }
}
