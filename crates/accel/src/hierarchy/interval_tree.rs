//! Binary trees whose nodes bound each child along one axis only: bounded kd-trees and bounding interval hierarchies.

use super::object_build::MAX_DEPTH;
use super::refs::{Built, BuiltKind};
use super::slabs::SlabRay;
use crate::bounds::{half_area_f64, size_f64};
use crate::laboratory::LeafVisit;
use crate::structure::StructureSummary;
use photinus_geometry::{Aabb, Ray};
use std::ops::{ControlFlow, Range};

/// Planes of a node across one axis.
pub(crate) trait Planes: Copy + Send + Sync + 'static {
    /// The planes around children of these bounds.
    fn around(children: [&Aabb; 2], axis: usize) -> Self;

    /// The slab that each child lies in; infinite where there is no plane.
    fn slabs(&self) -> [[f32; 2]; 2];
}

/// A node: a leaf, or an interior one whose first child follows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct IntervalNode<P> {
    /// Where the children lie; around nothing in a leaf.
    planes: P,
    /// The second child, or the first reference.
    place: u32,
    /// Axis of the planes, or 3, in the lowest two bits; above them the number of references.
    tag: u32,
}

/// What a node holds.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Holds {
    /// Places of its references.
    Refs(Range<usize>),
    /// Children along an axis.
    Children {
        /// 0 to 2.
        axis: usize,
        /// Their places.
        places: [usize; 2],
    },
}

/// The tree.
pub(crate) struct IntervalTree<P> {
    /// Bounds of everything; empty where the tree is.
    pub bounds: Aabb,
    nodes: Vec<IntervalNode<P>>,
    /// Primitive ids of all leaves, one leaf after the other.
    pub refs: Vec<u32>,
}

/// A subtree that waits, with the part of the ray that it may meet.
#[derive(Clone, Copy)]
struct Waiting {
    place: u32,
    enter: f32,
    leave: f32,
}

impl<P: Planes> IntervalTree<P> {
    /// Lays out a built tree.
    pub fn new(built: Option<Built<Aabb>>) -> Self {
        let mut out = Self { bounds: Aabb::EMPTY, nodes: Vec::new(), refs: Vec::new() };
        if let Some(built) = built {
            out.bounds = built.volume;
            out.add(&built);
        }
        out
    }

    fn add(&mut self, built: &Built<Aabb>) {
        let place = self.nodes.len();
        match &built.kind {
            BuiltKind::Leaf(ids) => {
                let tag = (ids.len() as u32) << 2 | 3;
                self.nodes.push(IntervalNode {
                    planes: P::around([&Aabb::EMPTY; 2], 0),
                    place: self.refs.len() as u32,
                    tag,
                });
                self.refs.extend(ids);
            }
            BuiltKind::Inner { axis, children } => {
                let planes = P::around([&children[0].volume, &children[1].volume], *axis);
                self.nodes.push(IntervalNode { planes, place: 0, tag: *axis as u32 });
                self.add(&children[0]);
                self.nodes[place].place = self.nodes.len() as u32;
                self.add(&children[1]);
            }
        }
    }

    #[inline(always)]
    fn holds(&self, place: usize) -> Holds {
        let node = &self.nodes[place];
        match (node.tag & 3) as usize {
            3 => Holds::Refs(node.place as usize..(node.place + (node.tag >> 2)) as usize),
            axis => Holds::Children { axis, places: [place + 1, node.place as usize] },
        }
    }

    /// See [`crate::laboratory::Leaves::walk`]: nearest entries first.
    #[inline(always)]
    pub fn walk(&self, ray: &Ray, mut node: impl FnMut(), mut leaf: impl FnMut(LeafVisit) -> ControlFlow<(), f32>) {
        let Some(slabs) = SlabRay::new(ray) else { return };
        let mut end = ray.t_max;
        let (mut enter, mut leave) = (ray.t_min, end);
        for axis in 0..3 {
            (enter, leave) = slabs.cut(axis, self.bounds.min[axis], self.bounds.max[axis], enter, leave);
        }
        if self.nodes.is_empty() || !(enter <= leave) {
            return;
        }
        let mut stack = [Waiting { place: 0, enter, leave }; MAX_DEPTH + 1];
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let Waiting { place, enter, leave } = stack[waiting];
            if enter > end {
                continue;
            }
            let (mut place, mut enter, mut leave) = (place as usize, enter, leave.min(end));
            loop {
                let (axis, places) = match self.holds(place) {
                    Holds::Children { axis, places } => (axis, places),
                    Holds::Refs(refs) => {
                        let ControlFlow::Continue(left) = leaf(LeafVisit { refs, exit: f32::NEG_INFINITY }) else {
                            return;
                        };
                        end = left;
                        break;
                    }
                };
                node();
                let [a, b] =
                    self.nodes[place].planes.slabs().map(|[low, high]| slabs.cut(axis, low, high, enter, leave));
                let (meets_a, meets_b) = (a.0 <= a.1, b.0 <= b.1);
                // Where both begin together, that which lies first along the ray goes first.
                let b_first = b.0 < a.0 || (b.0 == a.0 && slabs.is_backward(axis));
                let (near, far) = match (meets_a, meets_b) {
                    (false, false) => break,
                    (true, false) => ((places[0], a), None),
                    (false, true) => ((places[1], b), None),
                    (true, true) if b_first => ((places[1], b), Some((places[0], a))),
                    (true, true) => ((places[0], a), Some((places[1], b))),
                };
                if let Some((place, (enter, leave))) = far {
                    stack[waiting] = Waiting { place: place as u32, enter, leave };
                    waiting += 1;
                }
                (place, (enter, leave)) = near;
            }
        }
    }

    /// Fits all planes anew, from the leaves up, to the bounds of primitives by id.
    pub fn refit(&mut self, bounds: &[Aabb]) {
        let mut boxes = vec![Aabb::EMPTY; self.nodes.len()];
        for place in (0..self.nodes.len()).rev() {
            boxes[place] = match self.holds(place) {
                Holds::Refs(refs) => self.refs[refs].iter().fold(Aabb::EMPTY, |b, id| b.union(bounds[*id as usize])),
                Holds::Children { axis, places: [a, b] } => {
                    self.nodes[place].planes = P::around([&boxes[a], &boxes[b]], axis);
                    boxes[a].union(boxes[b])
                }
            };
        }
        self.bounds = boxes.first().copied().unwrap_or(Aabb::EMPTY);
    }

    /// Hands out every node with its depth and the box that planes leave of it, parents first.
    pub fn visit_cells(&self, mut visit: impl FnMut(u32, &Aabb, &Holds)) {
        if self.nodes.is_empty() {
            return;
        }
        let mut waiting = vec![(0, 0, self.bounds)];
        while let Some((place, depth, cell)) = waiting.pop() {
            let holds = self.holds(place);
            visit(depth, &cell, &holds);
            if let Holds::Children { axis, places } = holds {
                for (child, [low, high]) in places.into_iter().zip(self.nodes[place].planes.slabs()).rev() {
                    let mut part = cell;
                    part.min[axis] = part.min[axis].max(low);
                    part.max[axis] = part.max[axis].min(high);
                    waiting.push((child, depth + 1, part));
                }
            }
        }
    }

    /// Depth, counts, memory and cost.
    pub fn summary(&self, name: &'static str, cost_ratio: f64) -> StructureSummary {
        let mut out = StructureSummary {
            name,
            references: self.refs.len() as u64,
            bytes: (size_of_val(&self.nodes[..]) + size_of_val(&self.refs[..])) as u64,
            ..StructureSummary::default()
        };
        let half_area = |b: &Aabb| half_area_f64(size_f64(b));
        let whole = half_area(&self.bounds);
        self.visit_cells(|depth, cell, holds| {
            out.depth = out.depth.max(depth);
            let share = if whole > 0.0 { half_area(cell) / whole } else { 0.0 };
            match holds {
                Holds::Refs(refs) => {
                    out.leaves += 1;
                    out.sah_cost += share * refs.len() as f64;
                }
                Holds::Children { .. } => {
                    out.nodes += 1;
                    out.sah_cost += share * cost_ratio;
                }
            }
        });
        if out.leaves == 0 {
            out.empty_leaves = 1;
        } else {
            out.prims_per_leaf = out.references as f64 / out.leaves as f64;
        }
        out
    }
}
