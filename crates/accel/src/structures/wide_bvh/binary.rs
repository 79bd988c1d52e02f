//! A binary tree by the surface-area heuristic, in parallel, planned from the bottom up while it is built.
//!
//! Minima, maxima and counts of bins do not depend on the order in which they are gathered, and the order of the
//! pieces does not depend on who builds them, so the tree is the same on any number of threads.

use super::bins::{BuildPrim, Extents, split};
use super::collapse::{BLOCK_COST, Costs, ID_COST, Leaves, Plan, plan};
use super::layout::{MAX_IDS, WIDTH};
use super::reinsert::{Linked, LinkedTree, reinserted};
use super::visits::Visits;
use crate::bounds::padded_bounds;
use photinus_geometry::{Aabb, Primitives};
use rayon::prelude::*;

/// Subtrees of fewer primitives are left to one thread.
pub const PARALLEL_PRIMS: usize = 4096;
/// Below this depth nodes are halved by count, which takes 30 levels at most: no tree is deeper than 78.
const MAX_SAH_DEPTH: u32 = 48;
/// Visits of the scene, of which so large a part makes a leaf large.
const LARGE_PART: f32 = 1.0 / 256.0;

/// A node over `count` consecutive primitives from `first`.
#[derive(Clone, Copy, Debug)]
pub struct BinaryNode {
    /// Bounds of all of them.
    pub bounds: Aabb,
    /// Where they start in the order of the tree.
    pub first: u32,
    /// How many.
    pub count: u32,
    /// How much further on the second child is, in nodes or, of a node that is a piece by itself, in pieces; the first
    /// child comes next. 0 in leaves.
    second: u32,
    /// What is best done with the subtree.
    pub plan: Plan,
}

impl BinaryNode {
    /// Whether it has no children.
    pub fn is_leaf(&self) -> bool {
        self.second == 0
    }
}

/// Where a node is.
#[derive(Clone, Copy, Default)]
pub struct Place {
    piece: u32,
    index: u32,
}

/// A binary tree down to what is best left a leaf.
pub struct BinaryTree {
    /// The nodes, each followed by its first child's subtree and then its second child's, in pieces: subtrees built by
    /// one thread, and each node above them. None where there is no primitive.
    pieces: Vec<Vec<BinaryNode>>,
    /// Primitives in the order of the tree.
    pub prims: Vec<BuildPrim>,
    /// How leaves are stored.
    pub leaves: Leaves,
}

impl BinaryTree {
    /// How many nodes there are.
    pub fn node_count(&self) -> usize {
        self.pieces.iter().map(Vec::len).sum()
    }

    /// Whether there is no primitive.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Bounds of everything; empty where there is nothing.
    pub fn bounds(&self) -> Aabb {
        if self.is_empty() { Aabb::EMPTY } else { self.node(Place::default()).bounds }
    }

    /// The node at a place, of which the root's is the default.
    #[inline]
    pub fn node(&self, place: Place) -> &BinaryNode {
        &self.pieces[place.piece as usize][place.index as usize]
    }

    /// The children of an interior node.
    #[inline]
    pub fn children(&self, place: Place) -> [Place; 2] {
        let Place { piece, index } = place;
        let node = self.node(place);
        let steps = [1, node.second];
        if node.count as usize >= PARALLEL_PRIMS {
            steps.map(|step| Place { piece: piece + step, index: 0 })
        } else {
            steps.map(|step| Place { piece, index: index + step })
        }
    }
}

/// Half the surface area in scaled units.
#[inline]
pub fn scaled_half_area(b: &Aabb, scale: f32) -> f32 {
    let d = b.size() * scale;
    d.x * d.y + d.y * d.z + d.z * d.x
}

/// The hittable primitives with their padded bounds, by id.
fn gather(primitives: &Primitives) -> Vec<BuildPrim> {
    let prim = |id: usize| match padded_bounds(primitives, id) {
        Some(b) => BuildPrim::new(&b, id as u32),
        None => BuildPrim::new(&Aabb::EMPTY, u32::MAX),
    };
    // A list of known length is written in place; most scenes have nothing to be taken out of it.
    let mut prims: Vec<_> = (0..primitives.len()).into_par_iter().with_min_len(1024).map(prim).collect();
    if prims.par_iter().with_min_len(1024).any(|prim| prim.id() == u32::MAX) {
        prims.retain(|prim| prim.id() != u32::MAX);
    }
    prims
}

/// Builds the tree for these leaves, with so many rounds of reinsertions.
pub fn build(primitives: &Primitives, leaves: Leaves, rounds: u32) -> BinaryTree {
    let mut prims = gather(primitives);
    let extents = prims.par_chunks(PARALLEL_PRIMS).map(Extents::of).reduce(|| Extents::EMPTY, Extents::union);
    let visits = Visits::new(&extents.bounds.aabb());
    let large_visits = LARGE_PART * visits.of(&extents.bounds.aabb());
    let builder = Builder { visits, large_visits, leaves, triangle_count: primitives.triangle_count() as u32 };
    let pieces = if prims.is_empty() { Vec::new() } else { builder.large(&mut prims, 0, 0, &extents).0 };
    let mut tree = BinaryTree { pieces, prims, leaves };
    let linked = if tree.is_empty() || rounds == 0 { None } else { reinserted(&tree, visits, rounds) };
    if let Some(linked) = linked {
        let mut prims = tree.prims.clone();
        tree.pieces = builder.reordered(&linked, LinkedTree::ROOT, &tree.prims, &mut prims, 0).0;
        tree.prims = prims;
    }
    tree
}

/// The pieces of a subtree, and its costs.
type Subtree = (Vec<Vec<BinaryNode>>, Costs);

/// What is the same for all subtrees.
struct Builder {
    visits: Visits,
    /// Leaves visited more often are large.
    large_visits: f32,
    leaves: Leaves,
    triangle_count: u32,
}

impl Builder {
    /// Builds a subtree on all threads: its pieces and costs.
    fn large(&self, prims: &mut [BuildPrim], first: u32, depth: u32, extents: &Extents) -> Subtree {
        if prims.len() < PARALLEL_PRIMS {
            let mut nodes = Vec::with_capacity(prims.len() / 2);
            let costs = self.small(prims, first, depth, extents, &mut nodes);
            return (vec![nodes], costs);
        }
        let count = prims.len() as u32;
        let left_count = self.split(prims, depth, extents, f32::INFINITY).unwrap_or(prims.len() / 2);
        let (left, right) = prims.split_at_mut(left_count);
        let right_first = first + left_count as u32;
        let (a, b) = rayon::join(
            || self.large(left, first, depth + 1, &Extents::of(left)),
            || self.large(right, right_first, depth + 1, &Extents::of(right)),
        );
        self.joined(extents.bounds.aabb(), first, count, a, b)
    }

    /// Lays out a subtree of `linked` and plans it: its pieces and costs. Takes its primitives from `old` to `prims`, which
    /// start at `first`.
    fn reordered(
        &self,
        linked: &LinkedTree,
        index: u32,
        old: &[BuildPrim],
        prims: &mut [BuildPrim],
        first: u32,
    ) -> Subtree {
        let children = linked.children(index).filter(|_| prims.len() >= PARALLEL_PRIMS);
        let Some([a, b]) = children else {
            let mut nodes = Vec::with_capacity(prims.len() / 2);
            let costs = self.small_reordered(linked, index, old, prims, first, &mut nodes);
            return (vec![nodes], costs);
        };
        let (count, left_count) = (prims.len() as u32, linked.node(a).count);
        let (left, right) = prims.split_at_mut(left_count as usize);
        let (a, b) = rayon::join(
            || self.reordered(linked, a, old, left, first),
            || self.reordered(linked, b, old, right, first + left_count),
        );
        self.joined(linked.node(index).bounds, first, count, a, b)
    }

    /// Two subtrees below a node that is a piece by itself, and no leaf.
    fn joined(&self, bounds: Aabb, first: u32, count: u32, (a, a_costs): Subtree, (b, b_costs): Subtree) -> Subtree {
        let (costs, plan) = plan(self.visits.of(&bounds), f32::INFINITY, &a_costs, &b_costs);
        let node = BinaryNode { bounds, first, count, second: 1 + a.len() as u32, plan };
        ([vec![vec![node]], a, b].into_iter().flatten().collect(), costs)
    }

    /// The same of a piece, appended to `nodes`.
    fn small_reordered(
        &self,
        linked: &LinkedTree,
        index: u32,
        old: &[BuildPrim],
        prims: &mut [BuildPrim],
        first: u32,
        nodes: &mut Vec<BinaryNode>,
    ) -> Costs {
        let Linked { bounds, first: old_first, count, .. } = *linked.node(index);
        let place = nodes.len();
        nodes.push(BinaryNode { bounds, first, count, second: 0, plan: Plan::LEAF });
        let Some([a, b]) = linked.children(index) else {
            prims.copy_from_slice(&old[old_first as usize..][..count as usize]);
            return [self.leaf_cost(prims, self.visits.of(&bounds)); WIDTH];
        };
        let left_count = linked.node(a).count;
        let (left, right) = prims.split_at_mut(left_count as usize);
        let a = self.small_reordered(linked, a, old, left, first, nodes);
        nodes[place].second = (nodes.len() - place) as u32;
        let b = self.small_reordered(linked, b, old, right, first + left_count, nodes);
        let visits = self.visits.of(&bounds);
        let (costs, plan) = plan(visits, self.leaf_cost(prims, visits), &a, &b);
        nodes[place].plan = plan;
        costs
    }

    /// Appends a subtree to `nodes` and returns its costs.
    fn small(
        &self,
        prims: &mut [BuildPrim],
        first: u32,
        depth: u32,
        extents: &Extents,
        nodes: &mut Vec<BinaryNode>,
    ) -> Costs {
        let bounds = extents.bounds.aabb();
        let visits = self.visits.of(&bounds);
        let leaf = self.leaf_cost(prims, visits);
        let index = nodes.len();
        nodes.push(BinaryNode { bounds, first, count: prims.len() as u32, second: 0, plan: Plan::LEAF });
        if prims.len() == 1 {
            return [leaf; WIDTH];
        }
        // Large leaves are few, and differ: six walls are best alone, though any two parts of them are as large as the room.
        let most = if visits > self.large_visits { f32::INFINITY } else { leaf };
        let left_count = match self.split(prims, depth, extents, most) {
            Some(count) => count,
            // Finer splits seldom pay where the cheapest one does not: that costs less than a thousandth.
            None if leaf < f32::INFINITY => return [leaf; WIDTH],
            None => prims.len() / 2,
        };
        let (left, right) = prims.split_at_mut(left_count);
        let (a, b) = (Extents::of(left), Extents::of(right));
        let a = self.small(left, first, depth + 1, &a, nodes);
        nodes[index].second = (nodes.len() - index) as u32;
        let b = self.small(right, first + left_count as u32, depth + 1, &b, nodes);
        let (costs, plan) = plan(visits, leaf, &a, &b);
        nodes[index].plan = plan;
        costs
    }

    /// Reorders the primitives, more than one, by the cheapest split and returns the size of the first part; `None` where
    /// there is no split that pays.
    fn split(&self, prims: &mut [BuildPrim], depth: u32, extents: &Extents, most: f32) -> Option<usize> {
        let by_cost = if depth < MAX_SAH_DEPTH { split(prims, extents, self.visits.scale, most) } else { None };
        by_cost.filter(|left| (1..prims.len()).contains(left))
    }

    /// Cost of a leaf of these primitives, visited so often; infinite where they make none. Mixed ones do not.
    fn leaf_cost(&self, prims: &[BuildPrim], visits: f32) -> f32 {
        if prims.len() > WIDTH {
            return f32::INFINITY;
        }
        let triangles = prims.iter().filter(|p| p.id() < self.triangle_count).count();
        let are_ids = self.leaves == Leaves::Ids || triangles == 0;
        match (are_ids, prims.len()) {
            (true, count @ ..=MAX_IDS) => visits * ID_COST * count as f32,
            (false, count) if count == triangles => visits * BLOCK_COST,
            _ => f32::INFINITY,
        }
    }
}
