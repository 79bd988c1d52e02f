//! A tree of bounding volumes in memory: children of a node side by side, leaves as ranges of references.

use super::refs::{Built, BuiltKind};
use super::volume::{Fit, PaddedPoint, Volume};
use crate::bounds::SLAB_SLACK;
use crate::structure::StructureSummary;
use photinus_geometry::{Aabb, Primitives};
use std::ops::{ControlFlow, Range};

/// A node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node<V> {
    /// Bounds everything below.
    pub volume: V,
    /// The first child, or the first reference.
    first: u32,
    /// How many, and in the lowest bit whether it is a leaf.
    tag: u32,
}

/// What a node holds.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Holds {
    /// Places of its references.
    Refs(Range<usize>),
    /// Places of its children.
    Children(Range<usize>),
}

impl<V> Node<V> {
    /// What it holds.
    #[inline(always)]
    pub fn holds(&self) -> Holds {
        let range = self.first as usize..(self.first + (self.tag >> 1)) as usize;
        if self.tag & 1 == 1 { Holds::Refs(range) } else { Holds::Children(range) }
    }
}

/// The trees over a set of primitives; one, or several with their roots at known places. `STACK` places are enough
/// for a walk.
pub(crate) struct VolumeTree<V, const STACK: usize> {
    /// Nodes, parents before children.
    pub nodes: Vec<Node<V>>,
    /// Primitive ids of all leaves; those of a subtree lie side by side.
    pub refs: Vec<u32>,
}

impl<V: Volume, const STACK: usize> VolumeTree<V, STACK> {
    /// No tree.
    pub fn empty() -> Self {
        Self { nodes: Vec::new(), refs: Vec::new() }
    }

    /// One tree, with its root at the first place.
    pub fn new(built: Option<Built<V>>) -> Self {
        let mut out = Self::empty();
        if let Some(built) = built {
            out.add(built);
        }
        out
    }

    /// Appends a tree and returns the place of its root.
    pub fn add(&mut self, built: Built<V>) -> usize {
        let place = self.nodes.len();
        self.nodes.push(Node { volume: built.volume, first: 0, tag: 0 });
        self.fill(place, built.kind);
        place
    }

    fn fill(&mut self, place: usize, kind: BuiltKind<V>) {
        match kind {
            BuiltKind::Leaf(ids) => {
                self.nodes[place].first = self.refs.len() as u32;
                self.nodes[place].tag = (ids.len() as u32) << 1 | 1;
                self.refs.extend(ids);
            }
            BuiltKind::Inner { children, .. } => {
                let first = self.nodes.len();
                self.nodes[place].first = first as u32;
                self.nodes[place].tag = (children.len() as u32) << 1;
                self.nodes.extend(children.iter().map(|c| Node { volume: c.volume, first: 0, tag: 0 }));
                for (i, child) in children.into_iter().enumerate() {
                    self.fill(first + i, child.kind);
                }
            }
        }
    }

    /// Calls `node` at every interior node and `leaf` at every leaf that the ray may hit between its start and `end`,
    /// nearest entries first, until that breaks; it continues with what is left of the ray. Returns what is left in
    /// the end.
    #[inline(always)]
    pub fn walk_from(
        &self,
        root: usize,
        ray: &V::Prepared,
        mut end: f32,
        mut node: impl FnMut(),
        mut leaf: impl FnMut(Range<usize>, f32) -> ControlFlow<(), f32>,
    ) -> ControlFlow<(), f32> {
        let mut stack = [(0u32, 0f32); STACK];
        let mut waiting = 0;
        let Some(mut current) = self.nodes.get(root) else { return ControlFlow::Continue(end) };
        if current.volume.enter(ray, end).is_none() {
            return ControlFlow::Continue(end);
        }
        loop {
            match current.holds() {
                Holds::Refs(refs) => end = leaf(refs, end)?,
                Holds::Children(children) => {
                    node();
                    let base = waiting;
                    for child in children {
                        let Some(enter) = self.nodes[child].volume.enter(ray, end) else { continue };
                        let mut place = waiting;
                        while place > base && stack[place - 1].1 <= enter {
                            stack[place] = stack[place - 1];
                            place -= 1;
                        }
                        stack[place] = (child as u32, enter);
                        waiting += 1;
                    }
                }
            }
            loop {
                if waiting == 0 {
                    return ControlFlow::Continue(end);
                }
                waiting -= 1;
                let (next, enter) = stack[waiting];
                if enter <= end {
                    current = &self.nodes[next as usize];
                    break;
                }
            }
        }
    }

    /// Expected cost of a ray that meets a volume of half area `whole`, by the surface-area heuristic.
    pub fn cost(&self, whole: f64, node_cost: f64, ref_cost: f64) -> f64 {
        let cost = |node: &Node<V>| {
            let share = if whole > 0.0 { node.volume.half_surface() / whole } else { 0.0 };
            // Volumes without end are met always.
            let share = if share.is_finite() { share } else { 1.0 };
            match node.holds() {
                Holds::Refs(refs) => share * refs.len() as f64 * ref_cost,
                Holds::Children(_) => share * node_cost,
            }
        };
        self.nodes.iter().map(cost).sum()
    }

    /// Depth, counts and memory of all trees, and the cost where there is one, in tests of primitives.
    pub fn summary(&self, name: &'static str, cost_ratio: f64) -> StructureSummary {
        let whole = self.nodes.first().map_or(0.0, |root| root.volume.half_surface());
        let mut out = StructureSummary {
            name,
            references: self.refs.len() as u64,
            sah_cost: self.cost(whole, cost_ratio, 1.0),
            bytes: (size_of_val(&self.nodes[..]) + size_of_val(&self.refs[..])) as u64,
            ..StructureSummary::default()
        };
        let mut depths = vec![0u32; self.nodes.len()];
        for (place, node) in self.nodes.iter().enumerate() {
            out.depth = out.depth.max(depths[place]);
            match node.holds() {
                Holds::Refs(_) => out.leaves += 1,
                Holds::Children(children) => {
                    out.nodes += 1;
                    let below = depths[place] + 1;
                    depths[children].fill(below);
                }
            }
        }
        if out.leaves == 0 {
            out.empty_leaves = 1;
        } else {
            out.prims_per_leaf = out.references as f64 / out.leaves as f64;
        }
        out
    }

    /// The references below each node.
    fn spans(&self) -> Vec<Range<usize>> {
        let mut spans = vec![0..0; self.nodes.len()];
        for (place, node) in self.nodes.iter().enumerate().rev() {
            spans[place] = match node.holds() {
                Holds::Refs(refs) => refs,
                Holds::Children(children) => spans[children.start].start..spans[children.end - 1].end,
            };
        }
        spans
    }
}

impl<const STACK: usize> VolumeTree<Aabb, STACK> {
    /// Fits all boxes anew, from the leaves up, to the bounds of primitives by id.
    pub fn refit_boxes(&mut self, bounds: &[Aabb]) {
        for place in (0..self.nodes.len()).rev() {
            self.nodes[place].volume = match self.nodes[place].holds() {
                Holds::Refs(refs) => self.refs[refs].iter().fold(Aabb::EMPTY, |b, id| b.union(bounds[*id as usize])),
                Holds::Children(c) => self.nodes[c].iter().fold(Aabb::EMPTY, |b, child| b.union(child.volume)),
            };
        }
    }
}

impl<V: Fit, const STACK: usize> VolumeTree<V, STACK> {
    /// Fits all volumes anew, each to the whole of the primitives below it; `bounds` are those by id, empty where a
    /// primitive cannot be hit.
    pub fn refit_points(&mut self, primitives: &Primitives, bounds: &[Aabb]) {
        let mut points = Vec::new();
        let spans = self.spans();
        for (node, span) in self.nodes.iter_mut().zip(spans) {
            points.clear();
            for &id in &self.refs[span] {
                points_of(primitives, id as usize, &bounds[id as usize], &mut points);
            }
            // Where nothing can be hit any more, any volume will do.
            if !points.is_empty() {
                node.volume = V::fit(&points);
            }
        }
    }
}

/// Points whose padded hull holds a primitive.
fn points_of(primitives: &Primitives, id: usize, bounds: &Aabb, points: &mut Vec<PaddedPoint>) {
    if bounds.is_empty() {
        return;
    }
    if id < primitives.triangle_count() {
        let size = crate::bounds::size_f64(&Aabb::around(primitives.triangle(id)));
        let pad = f64::from(SLAB_SLACK) * (size[0] + size[1] + size[2]);
        points.extend(primitives.triangle(id).map(|v| PaddedPoint { at: v.to_array().map(f64::from), pad }));
        return;
    }
    let (low, high) = (bounds.min.to_array().map(f64::from), bounds.max.to_array().map(f64::from));
    points.extend((0..8).map(|i| PaddedPoint {
        at: std::array::from_fn(|k| if i >> k & 1 == 0 { low[k] } else { high[k] }),
        pad: 0.0,
    }));
}
