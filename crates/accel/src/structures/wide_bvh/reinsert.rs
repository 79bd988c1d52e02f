//! Moves subtrees of a finished binary tree to where rays visit its boxes least: Meister and Bittner, "Parallel Reinsertion
//! for Bounding Volume Hierarchy Optimization", Eurographics 2018.
//!
//! Binning sees middles only: what is large ends up deep among small things and blows up every box above it. The best
//! places of all subtrees that are worth it are searched on all threads in a tree that stands still (section 3.1); then
//! they are moved one after the other, those that gain most first, as long as nothing near them has moved before. So
//! the tree is the same on any number of threads.

use super::binary::{BinaryTree, Place};
use super::visits::Visits;
use arrayvec::ArrayVec;
use photinus_geometry::Aabb;
use rayon::prelude::*;

/// One in so many nodes may be moved, those that are visited most: the others gain little, and take most of the time.
const ONE_IN: usize = 4;
/// After a search of all those, searches of those only that were to move and were in each other's way.
const RETRIES: usize = 3;
/// Nodes looked at for the best place of one subtree. Where all boxes overlap a search would else look at the whole tree.
const MOST_TRIED: usize = 256;
/// Children that wait in a search; what finds no room is not searched.
const WAITING: usize = 64;
/// A move that gains a smaller part of what is taken out would be rounding.
const LEAST_GAIN: f32 = 1e-5;
/// A tree of more levels is not taken.
const MAX_DEPTH: u32 = 78;

/// Stands where there is no node.
const NONE: u32 = u32::MAX;

/// A node that knows its neighbours. The root is the first.
#[derive(Clone, Copy)]
pub struct Linked {
    /// Bounds of what is below.
    pub bounds: Aabb,
    /// How often rays visit it.
    visits: f32,
    parent: u32,
    /// None in leaves.
    children: [u32; 2],
    /// Where the primitives of a leaf start in the order of the tree that it was.
    pub first: u32,
    /// Primitives below.
    pub count: u32,
}

/// The tree while it changes.
pub struct LinkedTree {
    nodes: Vec<Linked>,
    visits: Visits,
}

/// The subtree at `from` becomes the sibling of that at `to`.
#[derive(Clone, Copy)]
struct Move {
    gain: f32,
    from: u32,
    to: u32,
}

/// The tree after so many rounds of moves; `None` where it would grow too deep.
pub fn reinserted(tree: &BinaryTree, visits: Visits, rounds: u32) -> Option<LinkedTree> {
    let mut linked = LinkedTree::new(tree, visits);
    let least_visits = linked.least_visits();
    let mut locked = vec![false; linked.nodes.len()];
    for _ in 0..rounds {
        let mut moves = linked.search_all((1..linked.nodes.len() as u32).into_par_iter(), least_visits);
        for _ in 0..RETRIES {
            linked.apply_all(&mut moves, &mut locked);
            moves = linked.search_all(moves.par_iter().map(|m| m.from), 0.0);
        }
        linked.apply_all(&mut moves, &mut locked);
    }
    linked.is_shallow().then_some(linked)
}

impl LinkedTree {
    fn new(tree: &BinaryTree, visits: Visits) -> Self {
        let mut out = Self { nodes: Vec::with_capacity(tree.node_count()), visits };
        let mut waiting = vec![(Place::default(), 0, 0)];
        while let Some((place, parent, side)) = waiting.pop() {
            let (node, index) = (tree.node(place), out.nodes.len() as u32);
            let (bounds, visits) = (node.bounds, visits.of(&node.bounds));
            let (first, count) = (node.first, node.count);
            out.nodes.push(Linked { bounds, visits, parent, children: [NONE; 2], first, count });
            if index > 0 {
                out.node_mut(parent).children[side] = index;
            }
            if !node.is_leaf() {
                let [a, b] = tree.children(place);
                waiting.extend([(b, index, 1), (a, index, 0)]);
            }
        }
        out
    }

    /// The root.
    pub const ROOT: u32 = 0;

    /// The node at `index`.
    pub fn node(&self, index: u32) -> &Linked {
        &self.nodes[index as usize]
    }

    fn node_mut(&mut self, index: u32) -> &mut Linked {
        &mut self.nodes[index as usize]
    }

    fn sibling(&self, index: u32) -> u32 {
        let [a, b] = self.node(self.node(index).parent).children;
        if a == index { b } else { a }
    }

    /// How often the nodes that are moved are visited at least.
    fn least_visits(&self) -> f32 {
        let mut visits: Vec<f32> = self.nodes.iter().map(|node| node.visits).collect();
        let rank = (visits.len() - 1) / ONE_IN;
        *visits.select_nth_unstable_by(rank, |a, b| b.total_cmp(a)).1
    }

    /// The best moves of those of the nodes that are visited as often as that, those that gain most first.
    fn search_all(&self, nodes: impl IndexedParallelIterator<Item = u32>, least: f32) -> Vec<Move> {
        let is_large = |index: &u32| self.node(*index).visits >= least;
        let mut moves: Vec<_> =
            nodes.with_min_len(256).filter(is_large).filter_map(|index| self.search(index)).collect();
        moves.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));
        moves
    }

    /// Where the subtree at `from` would make the visits of all nodes fewest; `None` where that is where it is.
    ///
    /// With it goes its parent, whose place its sibling takes. From there up, one ancestor after the other, it is tried
    /// below all that the ancestor holds otherwise, as far as it could gain more than at the best place so far: below a
    /// node it gains at most what is left when the node has grown, less its own visits.
    fn search(&self, from: u32) -> Option<Move> {
        let own = *self.node(from);
        let parent = own.parent;
        if parent == 0 {
            return None;
        }
        let sibling = self.sibling(from);
        let mut best = Move { gain: self.node(parent).visits * LEAST_GAIN, from, to: NONE };
        // What the ancestors below the pivot lose, and the bounds of what is left of the last of them.
        let mut saved = self.node(parent).visits;
        let mut left = self.node(sibling).bounds;
        let (mut pivot, mut beside) = (parent, sibling);
        let mut waiting = ArrayVec::<(f32, u32), WAITING>::new();
        let mut tried = 0;
        loop {
            waiting.push((saved, beside));
            while let Some((saved, index)) = waiting.pop() {
                tried += 1;
                if saved - own.visits <= best.gain || tried > MOST_TRIED {
                    continue;
                }
                let node = self.node(index);
                let gain = saved - self.visits.of(&node.bounds.union(own.bounds));
                if gain > best.gain && index != sibling {
                    best = Move { gain, from, to: index };
                }
                let saved = gain + node.visits;
                if node.children[0] != NONE && saved - own.visits > best.gain {
                    for child in node.children {
                        let _ = waiting.try_push((saved, child));
                    }
                }
            }
            if pivot == 0 || tried > MOST_TRIED {
                return (best.to != NONE).then_some(best);
            }
            if pivot != parent {
                left = left.union(self.node(beside).bounds);
                saved += self.node(pivot).visits - self.visits.of(&left);
            }
            beside = self.sibling(pivot);
            pivot = self.node(pivot).parent;
        }
    }

    /// Does what moves it can, in their order, and leaves those that it cannot do.
    fn apply_all(&mut self, moves: &mut Vec<Move>, locked: &mut [bool]) {
        locked.fill(false);
        moves.retain(|m| !self.apply(*m, locked));
    }

    /// Moves a subtree, if neither it nor its new place has changed since the search, and locks what changes.
    fn apply(&mut self, Move { from, to, .. }: Move, locked: &mut [bool]) -> bool {
        let parent = self.node(from).parent;
        let sibling = self.sibling(from);
        let above = self.node(parent).parent;
        let changed = [from, to, parent, sibling, above, self.node(to).parent];
        if parent == 0 || changed.iter().any(|index| locked[*index as usize]) {
            return false;
        }
        // A move before this one may have brought the new place below the subtree.
        let mut up = to;
        while up != 0 {
            if up == from {
                return false;
            }
            up = self.node(up).parent;
        }
        changed.iter().for_each(|index| locked[*index as usize] = true);
        self.replace(parent, sibling);
        self.refit(above);
        let above = self.node(to).parent;
        self.replace(to, parent);
        self.node_mut(parent).children = [to, from];
        for child in [to, from] {
            self.node_mut(child).parent = parent;
        }
        self.update(parent);
        self.refit(above);
        true
    }

    /// Puts node `new` where `old` is below its parent.
    fn replace(&mut self, old: u32, new: u32) {
        let parent = self.node(old).parent;
        let children = &mut self.node_mut(parent).children;
        children[usize::from(children[1] == old)] = new;
        self.node_mut(new).parent = parent;
    }

    /// What a node says of what is below, by its children.
    fn update(&mut self, index: u32) {
        let [a, b] = self.node(index).children.map(|child| *self.node(child));
        let bounds = a.bounds.union(b.bounds);
        let visits = self.visits.of(&bounds);
        let node = self.node_mut(index);
        (node.bounds, node.visits) = (bounds, visits);
        node.count = a.count + b.count;
    }

    /// The same of a node and all above it.
    fn refit(&mut self, mut index: u32) {
        self.update(index);
        while index != 0 {
            index = self.node(index).parent;
            self.update(index);
        }
    }

    /// The children of a node; `None` of a leaf.
    pub fn children(&self, index: u32) -> Option<[u32; 2]> {
        let children = self.node(index).children;
        (children[0] != NONE).then_some(children)
    }

    fn is_shallow(&self) -> bool {
        let mut waiting = vec![(Self::ROOT, 0)];
        while let Some((index, depth)) = waiting.pop() {
            if depth > MAX_DEPTH {
                return false;
            }
            waiting.extend(self.children(index).into_iter().flatten().map(|child| (child, depth + 1)));
        }
        true
    }
}
