//! Writing the wide tree: sizes of subtrees first, so that each has its place in the arrays and several threads write
//! at once.

use super::binary::{BinaryTree, PARALLEL_PRIMS};
use super::collapse::{Choice, Collapse, Leaves};
use super::layout::{Child, MAX_INDEX, Node, TriangleBlock, WIDTH};
use arrayvec::ArrayVec;
use photinus_geometry::Primitives;
use rayon::prelude::*;
use std::mem::take;

/// The arrays of a wide tree.
pub struct WideArrays {
    /// Nodes; the root is the first.
    pub nodes: Vec<Node>,
    /// Triangle blocks; the first is empty.
    pub blocks: Vec<TriangleBlock>,
    /// Ids of leaves that are not blocks.
    pub ids: Vec<u32>,
    /// Levels of nodes.
    pub levels: u32,
}

/// Places in each of the arrays.
#[derive(Clone, Copy, Default)]
struct Sizes {
    nodes: usize,
    blocks: usize,
    ids: usize,
}

/// What the subtree below a node takes, and in large ones what each of the nodes in its slots does.
#[derive(Default)]
struct Extent {
    sizes: Sizes,
    levels: u32,
    parts: Vec<Self>,
}

/// Places that are still to be written.
struct Room<'a> {
    nodes: &'a mut [Node],
    blocks: &'a mut [TriangleBlock],
    ids: &'a mut [u32],
    /// Where they start in the arrays.
    at: Sizes,
}

impl<'a> Room<'a> {
    fn take_nodes(&mut self, count: usize) -> &'a mut [Node] {
        let (taken, left) = take(&mut self.nodes).split_at_mut(count);
        self.nodes = left;
        self.at.nodes += count;
        taken
    }

    fn take_blocks(&mut self, count: usize) -> &'a mut [TriangleBlock] {
        let (taken, left) = take(&mut self.blocks).split_at_mut(count);
        self.blocks = left;
        self.at.blocks += count;
        taken
    }

    fn take_ids(&mut self, count: usize) -> &'a mut [u32] {
        let (taken, left) = take(&mut self.ids).split_at_mut(count);
        self.ids = left;
        self.at.ids += count;
        taken
    }

    fn split_off(&mut self, sizes: Sizes) -> Self {
        let at = self.at;
        let (nodes, blocks) = (self.take_nodes(sizes.nodes), self.take_blocks(sizes.blocks));
        Self { nodes, blocks, ids: self.take_ids(sizes.ids), at }
    }
}

/// Collapses `tree`; `None` where an array outgrows its index.
pub fn collapse(tree: &BinaryTree, primitives: &Primitives, leaves: Leaves) -> Option<WideArrays> {
    if tree.nodes.is_empty() {
        let (nodes, blocks) = (vec![Node::empty()], vec![TriangleBlock::empty()]);
        return Some(WideArrays { nodes, blocks, ids: Vec::new(), levels: 1 });
    }
    let collapse = Collapse::new(tree, primitives, leaves);
    let extent = collapse.measure(0);
    let Sizes { nodes, blocks, ids } = extent.sizes;
    if nodes.max(blocks).max(ids) >= MAX_INDEX {
        return None;
    }
    let mut out = WideArrays {
        nodes: rayon::iter::repeat_n(Node::empty(), 1 + nodes).collect(),
        blocks: rayon::iter::repeat_n(TriangleBlock::empty(), 1 + blocks).collect(),
        ids: vec![0; ids],
        levels: extent.levels,
    };
    let [root, nodes @ ..] = &mut out.nodes[..] else { return None };
    let at = Sizes { nodes: 1, blocks: 1, ids: 0 };
    let mut room = Room { nodes, blocks: &mut out.blocks[1..], ids: &mut out.ids, at };
    collapse.write(0, root, &mut room, &extent.parts);
    Some(out)
}

impl Collapse<'_> {
    /// What the subtree at `index`, a node, takes beside its own place.
    fn measure(&self, index: usize) -> Extent {
        let mut out = Extent::default();
        let mut inner = ArrayVec::<_, WIDTH>::new();
        for (child, choice) in self.slots(index) {
            if matches!(choice, Choice::Node) {
                inner.push(child);
            } else if self.binary.leaf_kind(child) == Some(Leaves::Ids) {
                out.sizes.ids += self.binary.tree.nodes[child].count as usize;
            } else {
                out.sizes.blocks += 1;
            }
        }
        out.sizes.nodes += inner.len();
        let is_large = self.binary.tree.nodes[index].count as usize >= PARALLEL_PRIMS;
        if is_large {
            out.parts = inner.par_iter().map(|child| self.measure(*child)).collect();
            out.parts.iter().for_each(|part| out.levels = out.levels.max(part.levels));
            let sizes = out.parts.iter().map(|part| part.sizes);
            out.sizes = sizes.fold(out.sizes, Sizes::plus);
        } else {
            for child in inner {
                let part = self.measure(child);
                out.levels = out.levels.max(part.levels);
                out.sizes = out.sizes.plus(part.sizes);
            }
        }
        out.levels += 1;
        out
    }

    /// Writes the subtree at `index` to `place` and into the room: large ones, which have parts, on all threads.
    fn write(&self, index: usize, place: &mut Node, room: &mut Room<'_>, parts: &[Extent]) {
        let slots = self.slots(index);
        // Children of a node lie side by side.
        let mut next = room.at.nodes;
        let interior = slots.iter().filter(|(_, choice)| matches!(choice, Choice::Node)).count();
        let places = room.take_nodes(interior);
        let mut inner = ArrayVec::<_, WIDTH>::new();
        let mut children = ArrayVec::<_, WIDTH>::new();
        for (child, choice) in slots {
            let reference = if matches!(choice, Choice::Node) {
                inner.push(child);
                next += 1;
                Child::node(next - 1)
            } else {
                self.write_leaf(child, room)
            };
            children.push((self.binary.tree.nodes[child].bounds, reference));
        }
        *place = Node::new(&children);
        if parts.is_empty() {
            for (child, place) in inner.into_iter().zip(places) {
                self.write(child, place, room, &[]);
            }
            return;
        }
        let inner = inner.into_iter().zip(places).zip(parts);
        let mut tasks: Vec<_> = inner.map(|(task, part)| (task, part, room.split_off(part.sizes))).collect();
        tasks.par_iter_mut().for_each(|((child, place), part, room)| self.write(*child, place, room, &part.parts));
    }

    fn write_leaf(&self, index: usize, room: &mut Room<'_>) -> Child {
        let binary = &self.binary;
        let node = &binary.tree.nodes[index];
        let range = node.first as usize..(node.first + node.count) as usize;
        let mut ids: ArrayVec<u32, WIDTH> = binary.tree.prims[range].iter().map(|p| p.id).collect();
        ids.sort_unstable();
        if binary.leaf_kind(index) == Some(Leaves::Ids) {
            let first = room.at.ids;
            room.take_ids(ids.len()).copy_from_slice(&ids);
            return Child::ids(first, ids.len());
        }
        let first = room.at.blocks;
        for block in room.take_blocks(1) {
            for (lane, &id) in ids.iter().enumerate() {
                for (v, p) in binary.primitives.triangle(id as usize).iter().enumerate() {
                    for axis in 0..3 {
                        block.vertices[3 * v + axis][lane] = p[axis];
                    }
                }
                block.ids[lane] = id;
            }
        }
        Child::block(first)
    }
}

impl Sizes {
    fn plus(self, other: Self) -> Self {
        Self { nodes: self.nodes + other.nodes, blocks: self.blocks + other.blocks, ids: self.ids + other.ids }
    }
}
