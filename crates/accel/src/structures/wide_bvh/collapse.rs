//! From the binary tree to the wide one: which subtrees become nodes and which leaves is chosen at least cost by
//! dynamic programming (Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs", HPG 2017, section 3.1).

use super::binary::{BinaryTree, PARALLEL_PRIMS, scaled_half_area};
use super::layout::{MAX_IDS, WIDTH};
use arrayvec::ArrayVec;
use photinus_geometry::Primitives;

/// Cost of testing the eight boxes of a node, in units of [`BLOCK_COST`].
const NODE_COST: f32 = 1.0;
/// Cost of testing the eight triangles of a block.
const BLOCK_COST: f32 = 1.0;
/// Cost of testing one primitive by its id.
const ID_COST: f32 = 1.0;

/// What is best done with a binary subtree when it may take up so many slots of a node.
#[derive(Clone, Copy)]
pub enum Choice {
    /// One slot: a leaf.
    Leaf,
    /// One slot: a node of its own.
    Node,
    /// So many slots for the first child, the rest for the second.
    Split(u8),
    /// No better than with one slot less.
    Fewer,
}

/// Least costs of a subtree with up to i + 1 slots.
type Costs = [f32; WIDTH - 1];

/// How a subtree is done at these costs.
#[derive(Clone, Copy)]
struct Plan {
    choices: [Choice; WIDTH - 1],
    /// Slots of the first child where the subtree is a node.
    node_split: u8,
}

/// How leaves are stored.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Leaves {
    /// Triangles in blocks, spheres by id.
    Blocks,
    /// Everything by id.
    Ids,
}

/// The binary nodes that fill the slots of a node, and what becomes of them.
pub type Slots = ArrayVec<(usize, Choice), WIDTH>;

/// A tree over primitives.
pub struct Binary<'a> {
    /// The tree.
    pub tree: &'a BinaryTree,
    /// What it is over.
    pub primitives: &'a Primitives,
    leaves: Leaves,
}

/// A binary tree with what is best done with it.
pub struct Collapse<'a> {
    /// What is collapsed.
    pub binary: Binary<'a>,
    plans: Vec<Plan>,
}

impl<'a> Collapse<'a> {
    /// Plans `tree`, which is not empty.
    pub fn new(tree: &'a BinaryTree, primitives: &'a Primitives, leaves: Leaves) -> Self {
        let binary = Binary { tree, primitives, leaves };
        let mut plans = vec![Plan { choices: [Choice::Leaf; WIDTH - 1], node_split: 0 }; tree.nodes.len()];
        binary.plan(0, &mut plans);
        Self { binary, plans }
    }

    /// What fills the slots of a subtree that is a node, in tree order.
    pub fn slots(&self, index: usize) -> Slots {
        let mut slots = Slots::new();
        let node = &self.binary.tree.nodes[index];
        if node.left_count == 0 || (index == 0 && matches!(self.plans[0].choices[0], Choice::Leaf)) {
            slots.push((index, Choice::Leaf));
        } else {
            let [a, b] = self.binary.tree.children(index);
            let k = usize::from(self.plans[index].node_split);
            self.fill(a, k, &mut slots);
            self.fill(b, WIDTH - k, &mut slots);
        }
        slots
    }

    /// Appends the binary nodes that fill up to `slots` slots, in tree order.
    fn fill(&self, index: usize, mut slots: usize, out: &mut Slots) {
        let plan = &self.plans[index];
        while matches!(plan.choices[slots - 1], Choice::Fewer) {
            slots -= 1;
        }
        match plan.choices[slots - 1] {
            Choice::Split(k) => {
                let [a, b] = self.binary.tree.children(index);
                self.fill(a, usize::from(k), out);
                self.fill(b, slots - usize::from(k), out);
            }
            choice => out.push((index, choice)),
        }
    }
}

impl Binary<'_> {
    /// Whether the leaf of a subtree would be a block; the alternative is ids. Mixed subtrees are no leaf.
    pub fn leaf_kind(&self, index: usize) -> Option<Leaves> {
        let node = &self.tree.nodes[index];
        let prims = &self.tree.prims[node.first as usize..(node.first + node.count) as usize];
        if prims.len() > WIDTH {
            return None;
        }
        let is_triangle = |id: u32| (id as usize) < self.primitives.triangle_count();
        if self.leaves == Leaves::Ids || prims.iter().all(|p| !is_triangle(p.id)) {
            (prims.len() <= MAX_IDS).then_some(Leaves::Ids)
        } else {
            prims.iter().all(|p| is_triangle(p.id)).then_some(Leaves::Blocks)
        }
    }

    /// Plans the subtree at `index`, whose places are `plans`, bottom up; returns its costs.
    fn plan(&self, index: usize, plans: &mut [Plan]) -> Costs {
        let node = &self.tree.nodes[index];
        let (own, below) = plans.split_at_mut(1);
        let children = (node.left_count > 0).then(|| {
            let [a, b] = self.tree.children(index);
            let (left, right) = below.split_at_mut(b - a);
            if node.count as usize >= PARALLEL_PRIMS {
                rayon::join(|| self.plan(a, left), || self.plan(b, right))
            } else {
                (self.plan(a, left), self.plan(b, right))
            }
        });
        let (costs, plan) = self.plan_of(index, children);
        own[0] = plan;
        costs
    }

    /// Costs and plan of a subtree, with the costs of its children where it is no leaf.
    fn plan_of(&self, index: usize, children: Option<(Costs, Costs)>) -> (Costs, Plan) {
        let node = &self.tree.nodes[index];
        let area = scaled_half_area(&node.bounds, self.tree.scale);
        let leaf = match self.leaf_kind(index) {
            Some(Leaves::Blocks) => area * BLOCK_COST,
            Some(Leaves::Ids) => area * ID_COST * node.count as f32,
            None => f32::INFINITY,
        };
        let mut costs = [leaf; WIDTH - 1];
        let mut plan = Plan { choices: [Choice::Fewer; WIDTH - 1], node_split: 0 };
        plan.choices[0] = Choice::Leaf;
        let Some((a, b)) = children else { return (costs, plan) };
        let best_split = |slots: usize| {
            (1..slots).filter(|k| *k < WIDTH && slots - k < WIDTH).fold((f32::INFINITY, 1), |best, k| {
                let cost = a[k - 1] + b[slots - k - 1];
                if cost < best.0 { (cost, k) } else { best }
            })
        };
        let (children, node_split) = best_split(WIDTH);
        plan.node_split = node_split as u8;
        let as_node = area * NODE_COST + children;
        // The comparison also takes the node where costs overflow and no leaf is possible.
        if leaf == f32::INFINITY || as_node < leaf {
            costs[0] = as_node;
            plan.choices[0] = Choice::Node;
        }
        for slots in 2..WIDTH {
            let (cost, k) = best_split(slots);
            costs[slots - 1] = costs[slots - 2];
            if cost < costs[slots - 2] {
                costs[slots - 1] = cost;
                plan.choices[slots - 1] = Choice::Split(k as u8);
            }
        }
        (costs, plan)
    }
}
