//! Writing the wide tree: which binary nodes stand in which slots first, then all nodes and all blocks of triangles, each
//! once and in its place.

use super::binary::{BinaryTree, PARALLEL_PRIMS};
use super::collapse::Leaves;
use super::layout::{Child, MAX_INDEX, Node, TriangleBlock, WIDTH};
use arrayvec::ArrayVec;
use photinus_geometry::Primitives;
use rayon::prelude::*;

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
struct Places {
    node: usize,
    block: usize,
    id: usize,
}

/// A node to be written: what fills its slots, and the places of the first child of each kind.
#[derive(Clone, Copy)]
struct Draft {
    index: u32,
    first: Places,
}

/// The nodes below a node, children of one side by side, and the leaves in the order of their slots.
#[derive(Default)]
struct Drafts {
    nodes: Vec<Draft>,
    /// Binary nodes that become blocks.
    blocks: Vec<u32>,
    ids: Vec<u32>,
    levels: u32,
}

/// Collapses `tree`; `None` where an array outgrows its index.
pub fn collapse(tree: &BinaryTree, primitives: &Primitives) -> Option<WideArrays> {
    if tree.nodes.is_empty() {
        let (nodes, blocks) = (vec![Node::empty()], vec![TriangleBlock::empty()]);
        return Some(WideArrays { nodes, blocks, ids: Vec::new(), levels: 1 });
    }
    let writer = Writer { tree, primitives };
    let root = Draft { index: 0, first: Places { node: 1, block: 1, id: 0 } };
    let mut drafts = Drafts { nodes: vec![root], blocks: vec![u32::MAX], ..Drafts::default() };
    writer.draft(0, 0, &mut drafts);
    if drafts.nodes.len().max(drafts.blocks.len()).max(drafts.ids.len()) >= MAX_INDEX {
        return None;
    }
    Some(WideArrays {
        nodes: drafts.nodes.par_iter().with_min_len(64).map(|draft| writer.node(draft)).collect(),
        blocks: drafts.blocks.par_iter().with_min_len(64).map(|index| writer.block(*index)).collect(),
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
    /// How the leaf at `index` is stored. No leaf is mixed.
    fn leaf_kind(&self, index: usize) -> Leaves {
        let id = self.tree.prims[self.tree.nodes[index].first as usize].id();
        if (id as usize) < self.primitives.triangle_count() { self.tree.leaves } else { Leaves::Ids }
    }

    /// Primitives of the leaf at `index`, ascending.
    fn leaf_ids(&self, index: usize) -> ArrayVec<u32, WIDTH> {
        let node = &self.tree.nodes[index];
        let range = node.first as usize..(node.first + node.count) as usize;
        let mut ids: ArrayVec<_, WIDTH> = self.tree.prims[range].iter().map(|p| p.id()).collect();
        ids.sort_unstable();
        ids
    }

    /// Drafts the node at `place` of `out`, a binary node, and everything below it.
    fn draft(&self, place: usize, levels: u32, out: &mut Drafts) {
        let index = out.nodes[place].index as usize;
        out.nodes[place].first = out.places();
        out.levels = out.levels.max(levels + 1);
        for (child, is_node) in self.tree.slots(index) {
            if is_node {
                out.nodes.push(Draft { index: child as u32, first: Places::default() });
            } else if self.leaf_kind(child) == Leaves::Ids {
                out.ids.extend(self.leaf_ids(child));
            } else {
                out.blocks.push(child as u32);
            }
        }
        let inner = out.nodes[place].first.node..out.nodes.len();
        if (self.tree.nodes[index].count as usize) < PARALLEL_PRIMS {
            inner.for_each(|place| self.draft(place, levels + 1, out));
            return;
        }
        let part = |child: &mut Draft| {
            let mut part = Drafts { nodes: vec![*child], ..Drafts::default() };
            self.draft(0, levels + 1, &mut part);
            part
        };
        let parts: Vec<_> = out.nodes[inner.clone()].par_iter_mut().map(part).collect();
        for (place, part) in inner.zip(parts) {
            out.append(place, part);
        }
    }

    fn node(&self, draft: &Draft) -> Node {
        let mut next = draft.first;
        let slots = self.tree.slots(draft.index as usize);
        let children: ArrayVec<_, WIDTH> = slots
            .into_iter()
            .map(|(index, is_node)| {
                let node = &self.tree.nodes[index];
                let child = if is_node {
                    next.node += 1;
                    Child::node(next.node - 1)
                } else if self.leaf_kind(index) == Leaves::Ids {
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

    fn block(&self, index: u32) -> TriangleBlock {
        let mut block = TriangleBlock::empty();
        if index == u32::MAX {
            return block;
        }
        for (lane, &id) in self.leaf_ids(index as usize).iter().enumerate() {
            for (v, p) in self.primitives.triangle(id as usize).iter().enumerate() {
                for axis in 0..3 {
                    block.vertices[3 * v + axis][lane] = p[axis];
                }
            }
            block.ids[lane] = id;
        }
        block
    }
}

impl Drafts {
    /// Where the next of each goes.
    fn places(&self) -> Places {
        Places { node: self.nodes.len(), block: self.blocks.len(), id: self.ids.len() }
    }

    /// Appends what was drafted by itself: its first node belongs to `place`.
    fn append(&mut self, place: usize, part: Self) {
        let mut base = self.places();
        base.node -= 1;
        let moved = |draft: &Draft| Draft { index: draft.index, first: draft.first.plus(base) };
        self.nodes[place] = moved(&part.nodes[0]);
        self.nodes.extend(part.nodes[1..].iter().map(moved));
        self.blocks.extend(part.blocks);
        self.ids.extend(part.ids);
        self.levels = self.levels.max(part.levels);
    }
}

impl Places {
    fn plus(self, other: Self) -> Self {
        Self { node: self.node + other.node, block: self.block + other.block, id: self.id + other.id }
    }
}
