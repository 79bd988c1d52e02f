//! Writing the wide tree: which binary nodes stand in which slots first, then all nodes and all blocks of triangles, each
//! once and in its place.

use super::binary::{BinaryNode, BinaryTree, PARALLEL_PRIMS, Place};
use super::collapse::Leaves;
use super::doubled::hide_doubled;
use super::layout::{Child, MAX_INDEX, Node, TriangleBlock, WIDTH};
use arrayvec::ArrayVec;
use photinus_geometry::Primitives;
use photinus_memory::HugeArray;
use rayon::prelude::*;

/// The arrays of a wide tree.
pub struct WideArrays {
    /// Nodes; the root is the first.
    pub nodes: HugeArray<Node>,
    /// Triangle blocks; the first is empty.
    pub blocks: HugeArray<TriangleBlock>,
    /// Ids of leaves that are not blocks.
    pub ids: Vec<u32>,
    /// Levels of nodes.
    pub levels: u32,
}

/// Offsets in each of the arrays.
#[derive(Clone, Copy, Default)]
struct Offsets {
    node: usize,
    block: usize,
    id: usize,
}

/// A node to be written: what fills its slots, and the indices of the first child of each kind.
#[derive(Clone, Copy)]
struct Draft {
    place: Place,
    first: Offsets,
}

/// The nodes below a node, children of one side by side, and the leaves in the order of their slots.
#[derive(Default)]
struct Drafts {
    nodes: Vec<Draft>,
    /// Where the primitives of blocks start, and how many they are.
    blocks: Vec<(u32, u32)>,
    ids: Vec<u32>,
    levels: u32,
}

/// Collapses `tree`; `None` where an array outgrows its index.
pub fn collapse(tree: &BinaryTree, primitives: &Primitives) -> Option<WideArrays> {
    if tree.is_empty() {
        let (nodes, blocks) = (HugeArray::new(1, |_| Node::empty()), HugeArray::new(1, |_| TriangleBlock::empty()));
        return Some(WideArrays { nodes, blocks, ids: Vec::new(), levels: 1 });
    }
    let writer = Writer { tree, primitives };
    let root = Draft { place: Place::default(), first: Offsets { node: 1, block: 1, id: 0 } };
    let mut drafts = Drafts { nodes: vec![root], blocks: vec![(0, 0)], ..Drafts::default() };
    writer.draft(0, 0, &mut drafts);
    if drafts.nodes.len().max(drafts.blocks.len()).max(drafts.ids.len()) >= MAX_INDEX {
        return None;
    }
    Some(WideArrays {
        nodes: HugeArray::new(drafts.nodes.len(), |i| writer.node(&drafts.nodes[i])),
        blocks: HugeArray::new(drafts.blocks.len(), |i| writer.block(drafts.blocks[i])),
        ids: drafts.ids,
        levels: drafts.levels,
    })
}

/// A binary tree and what it is over.
struct Writer<'a> {
    tree: &'a BinaryTree,
    primitives: &'a Primitives,
}

impl Writer<'_> {
    /// How a leaf is stored. None is mixed.
    fn leaf_kind(&self, leaf: &BinaryNode) -> Leaves {
        let id = self.tree.prims[leaf.first as usize].id();
        if (id as usize) < self.primitives.triangle_count() { self.tree.leaves } else { Leaves::Ids }
    }

    /// Drafts the node at `index` of `out`, which knows its place, and everything below it.
    fn draft(&self, index: usize, levels: u32, out: &mut Drafts) {
        let place = out.nodes[index].place;
        out.nodes[index].first = out.offsets();
        out.levels = out.levels.max(levels + 1);
        for (child, is_node) in self.tree.slots(place) {
            let node = self.tree.node(child);
            if is_node {
                out.nodes.push(Draft { place: child, first: Offsets::default() });
            } else if self.leaf_kind(node) == Leaves::Ids {
                let ids = out.ids.len();
                let prims = &self.tree.prims[node.first as usize..(node.first + node.count) as usize];
                out.ids.extend(prims.iter().map(|p| p.id()));
                out.ids[ids..].sort_unstable();
            } else {
                out.blocks.push((node.first, node.count));
            }
        }
        let inner = out.nodes[index].first.node..out.nodes.len();
        if (self.tree.node(place).count as usize) < PARALLEL_PRIMS {
            inner.for_each(|index| self.draft(index, levels + 1, out));
            return;
        }
        let part = |child: &mut Draft| {
            let mut part = Drafts { nodes: vec![*child], ..Drafts::default() };
            self.draft(0, levels + 1, &mut part);
            part
        };
        let parts: Vec<_> = out.nodes[inner.clone()].par_iter_mut().map(part).collect();
        for (index, part) in inner.zip(parts) {
            out.append(index, part);
        }
    }

    fn node(&self, draft: &Draft) -> Node {
        let mut next = draft.first;
        let slots = self.tree.slots(draft.place);
        let children: ArrayVec<_, WIDTH> = slots
            .into_iter()
            .map(|(place, is_node)| {
                let node = self.tree.node(place);
                let child = if is_node {
                    next.node += 1;
                    Child::node(next.node - 1)
                } else if self.leaf_kind(node) == Leaves::Ids {
                    next.id += node.count as usize;
                    Child::ids(next.id - node.count as usize, node.count as usize)
                } else {
                    next.block += 1;
                    Child::block(next.block - 1)
                };
                (node.bounds, child)
            })
            .collect();
        Node::new(&children)
    }

    fn block(&self, (first, count): (u32, u32)) -> TriangleBlock {
        let mut block = TriangleBlock::empty();
        let mut ids = [i32::MAX; WIDTH];
        for (id, prim) in ids.iter_mut().zip(&self.tree.prims[first as usize..(first + count) as usize]) {
            *id = prim.id() as i32;
        }
        for id in &ids[..count as usize] {
            // The lane is the number of smaller ids: eight comparisons at once, where sorting would guess.
            let lane = ids.iter().filter(|other| *other < id).count() % WIDTH;
            for (v, p) in self.primitives.triangle(*id as usize).iter().enumerate() {
                for axis in 0..3 {
                    block.vertices[3 * v + axis][lane] = p[axis];
                }
            }
            block.ids[lane] = *id as u32;
        }
        hide_doubled(&mut block);
        block
    }
}

impl Drafts {
    /// Where the next of each goes.
    fn offsets(&self) -> Offsets {
        Offsets { node: self.nodes.len(), block: self.blocks.len(), id: self.ids.len() }
    }

    /// Appends what was drafted by itself: its first node belongs to `index`.
    fn append(&mut self, index: usize, part: Self) {
        let mut base = self.offsets();
        base.node -= 1;
        let mut moved = part.nodes.into_iter().map(|draft| Draft { first: draft.first.plus(base), ..draft });
        if let Some(node) = moved.next() {
            self.nodes[index] = node;
        }
        self.nodes.extend(moved);
        self.blocks.extend(part.blocks);
        self.ids.extend(part.ids);
        self.levels = self.levels.max(part.levels);
    }
}

impl Offsets {
    fn plus(self, other: Self) -> Self {
        Self { node: self.node + other.node, block: self.block + other.block, id: self.id + other.id }
    }
}
