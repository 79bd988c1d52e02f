//! From the binary tree to the wide one: which subtrees become nodes and which leaves is chosen at least cost by
//! dynamic programming (Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs", HPG 2017, section 3.1).

use super::binary::{BinaryTree, Place};
use super::layout::WIDTH;
use arrayvec::ArrayVec;

/// Cost of testing the eight boxes of a node, in units of [`BLOCK_COST`].
pub const NODE_COST: f32 = 1.0;
/// Cost of testing the eight triangles of a block.
pub const BLOCK_COST: f32 = 1.0;
/// Cost of testing one primitive by its id.
pub const ID_COST: f32 = 1.0;

/// How leaves are stored.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Leaves {
    /// Triangles in blocks, spheres by id.
    Blocks,
    /// Everything by id.
    Ids,
}

/// Least costs of a subtree with up to i + 1 slots of a node; the last is not asked for.
pub type Costs = [f32; WIDTH];

/// What is best done with a subtree for each number of slots that it may take up: three bits for each number from two
/// upwards, the slots of its first child, or 0 where it is no better than with one fewer.
#[derive(Clone, Copy, Debug)]
pub struct Plan(u32);

impl Plan {
    /// A leaf, however many slots there are.
    pub const LEAF: Self = Self(0);
    /// Set where one slot holds a node and no leaf.
    const NODE: u32 = 1 << 31;

    /// Whether a subtree in one slot is a node of its own; a leaf otherwise.
    pub fn is_node(self) -> bool {
        self.0 & Self::NODE != 0
    }

    /// Slots of the first child where the subtree is split over up to `slots`, more than one; 0 where fewer are as good.
    fn first_slots(self, slots: usize) -> usize {
        (self.0 >> (3 * (slots - 2))) as usize & 7
    }
}

/// Costs and plan of a subtree visited so often, with the costs of its children and of making it a leaf, infinite where
/// it makes none.
pub fn plan(visits: f32, leaf: f32, a: &Costs, b: &Costs) -> (Costs, Plan) {
    const LAST: usize = WIDTH - 1;
    // Costs by slots less one, for all numbers of slots at once: the second child's are moved by the first child's slots.
    let mut moved = [f32::INFINITY; 2 * WIDTH];
    moved[WIDTH..2 * WIDTH - 1].copy_from_slice(&b[..LAST]);
    let (mut costs, mut first_slots) = ([f32::INFINITY; WIDTH], [0u32; WIDTH]);
    for k in 1..WIDTH {
        for i in 0..WIDTH {
            let cost = a[k - 1] + moved[WIDTH + i - k];
            let is_less = cost < costs[i];
            costs[i] = if is_less { cost } else { costs[i] };
            first_slots[i] = if is_less { k as u32 } else { first_slots[i] };
        }
    }
    // Where costs overflow all are as good, and a node still needs its children.
    let mut bits = first_slots[LAST].max(1) << (3 * (LAST - 1));
    let as_node = visits * NODE_COST + costs[LAST];
    costs[0] = leaf;
    // The comparison also takes the node where costs overflow and no leaf is possible.
    if leaf == f32::INFINITY || as_node < leaf {
        costs[0] = as_node;
        bits |= Plan::NODE;
    }
    for i in 1..LAST {
        if costs[i] < costs[i - 1] {
            bits |= first_slots[i] << (3 * (i - 1));
        } else {
            costs[i] = costs[i - 1];
        }
    }
    (costs, Plan(bits))
}

/// The binary nodes that fill the slots of a node, and whether they are nodes of their own.
pub type Slots = ArrayVec<(Place, bool), WIDTH>;

impl BinaryTree {
    /// What fills the slots of a subtree that is a node, in tree order; the root is one even if it is best left a leaf.
    pub fn slots(&self, place: Place) -> Slots {
        let mut slots = Slots::new();
        if self.node(place).plan.is_node() {
            self.split(place, WIDTH, &mut slots);
        } else {
            slots.push((place, false));
        }
        slots
    }

    fn split(&self, place: Place, slots: usize, out: &mut Slots) {
        let first_slots = self.node(place).plan.first_slots(slots);
        let [a, b] = self.children(place);
        self.fill(a, first_slots, out);
        self.fill(b, slots - first_slots, out);
    }

    /// Appends the binary nodes that fill up to `slots` slots, in tree order.
    fn fill(&self, place: Place, mut slots: usize, out: &mut Slots) {
        let plan = self.node(place).plan;
        while slots > 1 && plan.first_slots(slots) == 0 {
            slots -= 1;
        }
        if slots > 1 {
            self.split(place, slots, out);
        } else {
            out.push((place, plan.is_node()));
        }
    }
}
