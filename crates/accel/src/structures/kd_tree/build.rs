//! Construction: at every node the split of least expected cost, as long as it costs less than a leaf.
//!
//! The surface-area heuristic (MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", 1990) takes
//! the chance that a ray which meets a cell also meets a part of it as the ratio of their areas. With node cost C_n,
//! triangle cost C_t and n primitives a leaf costs `C_t n`, a split `C_n + C_t (p_below n_below + p_above n_above)`.
//! Only the ratio C_n / C_t enters.
//!
//! Bounds are sorted once per axis; every split divides the sorted lists without disturbing their order (after Wald
//! and Havran, "On Building Fast kd-Trees for Ray Tracing, and on Doing That in O(N log N)", 2006). Where triangles are
//! cut (section 4.1 there, "perfect splits"), those that a plane divides get new bounds on either side, which are sorted
//! among themselves and merged into the lists.

use super::quadratic;
use crate::bounds::{half_area_f64, padded_bounds, size_f64};
use crate::fragment::bounds_within;
use crate::options::{Clip, SplitCandidates};
use photinus_geometry::{Aabb, Primitives};
use rayon::prelude::*;

/// Deepest level below the root: no tree by cost comes near it, save where nodes cost nothing.
pub const MAX_DEPTH: u32 = 96;
/// Leaves and references together stay below this many for each primitive.
const MAX_REFERENCES_PER_PRIM: usize = 32;
/// Subtrees of fewer primitives are built by one thread.
const PARALLEL_PRIMS: usize = 2048;

/// A subtree.
pub enum Built {
    /// Ids of the primitives in the cell, ascending.
    Leaf(Vec<u32>),
    /// A plane and what lies below and above it.
    Split {
        /// Axis that the plane is perpendicular to.
        axis: usize,
        /// Where it cuts the axis.
        position: f32,
        /// Below and above.
        children: Box<[Built; 2]>,
    },
}

/// What the split of a node is chosen by.
#[derive(Clone, Copy)]
pub struct Rule {
    /// Node cost over triangle cost.
    pub cost_ratio: f64,
    /// Where nodes may be split.
    pub candidates: SplitCandidates,
    /// See [`crate::BuildOptions::candidate_count`].
    pub count: usize,
    /// What of a triangle counts.
    pub clip: Clip,
    /// Nodes of no more primitives are leaves.
    pub stop: usize,
}

/// One bound of a primitive along an axis, with the place of the primitive among those of the node.
type Bound = (f32, u32);

/// The primitives of a node, by lower and by upper bound along each axis, ascending.
struct Lists {
    lows: [Vec<Bound>; 3],
    highs: [Vec<Bound>; 3],
}

/// The primitives of a node where triangles are cut: what a place in the lists stands for.
struct Pieces {
    ids: Vec<u32>,
    /// Bounds of what lies of each in the cell.
    boxes: Vec<Aabb>,
}

struct Builder<'a> {
    primitives: &'a Primitives,
    rule: Rule,
    /// Padded bounds by id; where triangles are not cut, ids are the places in the lists.
    boxes: Vec<Aabb>,
}

fn by_value(a: &Bound, b: &Bound) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

struct Split {
    cost: f64,
    axis: usize,
    position: f32,
    below: usize,
    above: usize,
}

/// Builds the tree and returns it with its bounds.
pub fn build(primitives: &Primitives, rule: Rule) -> (Built, Aabb) {
    let boxes: Vec<Option<Aabb>> =
        (0..primitives.len()).into_par_iter().with_min_len(1024).map(|id| padded_bounds(primitives, id)).collect();
    let ids = || boxes.iter().enumerate().filter_map(|(id, b)| Some((id as u32, (*b)?)));
    let bounds = ids().fold(Aabb::EMPTY, |b, (_, c)| b.union(c));
    let sorted = |value: fn(&Aabb, usize) -> f32, axis: usize| {
        let mut list: Vec<Bound> = ids().map(|(id, b)| (value(&b, axis), id)).collect();
        list.par_sort_unstable_by(by_value);
        list
    };
    let lists = Lists {
        lows: std::array::from_fn(|axis| sorted(|b, axis| b.min[axis], axis)),
        highs: std::array::from_fn(|axis| sorted(|b, axis| b.max[axis], axis)),
    };
    let budget = lists.lows[0].len() * MAX_REFERENCES_PER_PRIM;
    let boxes: Vec<Aabb> = boxes.into_iter().map(|b| b.unwrap_or(Aabb::EMPTY)).collect();
    let pieces = match rule.clip {
        Clip::Box => None,
        Clip::Exact => Some(Pieces { ids: (0..boxes.len() as u32).collect(), boxes: boxes.clone() }),
    };
    (Builder { primitives, rule, boxes }.node(lists, pieces, bounds, 0, budget), bounds)
}

impl Builder<'_> {
    /// The subtree over `lists` in `cell`, of no more than `budget` leaves and references.
    fn node(&self, lists: Lists, pieces: Option<Pieces>, cell: Aabb, depth: u32, budget: usize) -> Built {
        let count = lists.lows[0].len();
        let split = if depth < MAX_DEPTH && count > self.rule.stop { self.best_split(&lists, &cell) } else { None };
        let leaf = |lists: Lists, pieces: Option<Pieces>| {
            let places = lists.lows[0].iter().map(|b| b.1);
            let mut ids: Vec<u32> = match &pieces {
                None => places.collect(),
                Some(pieces) => places.map(|place| pieces.ids[place as usize]).collect(),
            };
            ids.sort_unstable();
            Built::Leaf(ids)
        };
        let Some(split) = split.filter(|s| s.below.max(1) + s.above.max(1) <= budget) else {
            return leaf(lists, pieces);
        };
        let Split { axis, position, .. } = split;
        let (mut below_cell, mut above_cell) = (cell, cell);
        below_cell.max[axis] = position;
        above_cell.min[axis] = position;
        let [(below, below_pieces), (above, above_pieces)] = match pieces {
            None => self.divide(lists, &split).map(|lists| (lists, None)),
            Some(pieces) => [false, true].map(|up| {
                let cell = if up { &above_cell } else { &below_cell };
                let (lists, pieces) = self.divide_exactly(&lists, &pieces, &split, up, cell);
                (lists, Some(pieces))
            }),
        };
        // Shares of the budget do not depend on the order in which subtrees are built.
        let (b, a) = (split.below.max(1), split.above.max(1));
        let below_budget = b + (budget - b - a) * b / (b + a);
        let above_budget = budget - below_budget;
        let build_below = || self.node(below, below_pieces, below_cell, depth + 1, below_budget);
        let build_above = || self.node(above, above_pieces, above_cell, depth + 1, above_budget);
        let (below, above) = if count >= PARALLEL_PRIMS {
            rayon::join(build_below, build_above)
        } else {
            (build_below(), build_above())
        };
        Built::Split { axis, position, children: Box::new([below, above]) }
    }

    /// What reaches to one side of the plane, into `cell`, with the triangles that the plane divides cut to it. What
    /// proves to lie beside the cell is left out.
    fn divide_exactly(&self, lists: &Lists, pieces: &Pieces, split: &Split, up: bool, cell: &Aabb) -> (Lists, Pieces) {
        /// The place of a primitive that is not there.
        const GONE: u32 = u32::MAX;
        let Split { axis, position, .. } = *split;
        let mut out = Pieces { ids: Vec::new(), boxes: Vec::new() };
        // Where each primitive goes, and whether its bounds are as they were.
        let mut places = vec![(GONE, false); pieces.ids.len()];
        let mut cut = Vec::new();
        // In the order of a list of this node, not of all that the pieces hold: those without bounds are on none.
        for (_, place) in &lists.lows[0] {
            let (id, b) = (pieces.ids[*place as usize], pieces.boxes[*place as usize]);
            let (below, above) = (b.min[axis] < position, b.max[axis] > position);
            if !(if up { above } else { below }) {
                continue;
            }
            let divided = below && above;
            let left = if divided { bounds_within(self.primitives, id as usize, cell, &b) } else { Some(b) };
            let Some(left) = left else { continue };
            let new = out.ids.len() as u32;
            places[*place as usize] = (new, !divided);
            if divided {
                cut.push((new, left));
            }
            out.ids.push(id);
            out.boxes.push(left);
        }
        let merged = |list: &[Bound], value: &dyn Fn(&Aabb) -> f32| {
            let mut fresh: Vec<Bound> = cut.iter().map(|(place, b)| (value(b), *place)).collect();
            fresh.sort_unstable_by(by_value);
            let kept = list.iter().filter_map(|bound| match places[bound.1 as usize] {
                (place, true) => Some((bound.0, place)),
                _ => None,
            });
            merge(kept, fresh)
        };
        let lists = Lists {
            lows: std::array::from_fn(|k| merged(&lists.lows[k], &|b| b.min[k])),
            highs: std::array::from_fn(|k| merged(&lists.highs[k], &|b| b.max[k])),
        };
        (lists, out)
    }

    /// Primitives that reach below the plane, and above it.
    fn divide(&self, lists: Lists, split: &Split) -> [Lists; 2] {
        let Split { axis, position, .. } = *split;
        let halves = |list: Vec<Bound>| {
            let (mut below, mut above) = (Vec::with_capacity(split.below), Vec::with_capacity(split.above));
            for bound in list {
                let b = &self.boxes[bound.1 as usize];
                if b.min[axis] < position {
                    below.push(bound);
                }
                if b.max[axis] > position {
                    above.push(bound);
                }
            }
            (below, above)
        };
        let [(x0, x1), (y0, y1), (z0, z1)] = lists.lows.map(halves);
        let [(u0, u1), (v0, v1), (w0, w1)] = lists.highs.map(halves);
        [Lists { lows: [x0, y0, z0], highs: [u0, v0, w0] }, Lists { lows: [x1, y1, z1], highs: [u1, v1, w1] }]
    }

    /// The cheapest split of a node, if it is cheaper than a leaf; of equals that on the lowest axis, lowest there.
    fn best_split(&self, lists: &Lists, cell: &Aabb) -> Option<Split> {
        let count = lists.lows[0].len();
        let mut best = Split { cost: count as f64, axis: 0, position: 0.0, below: 0, above: 0 };
        let size = size_f64(cell);
        let inv_area = 1.0 / half_area_f64(size);
        for axis in 0..3 {
            let (low, high) = (cell.min[axis], cell.max[axis]);
            let (u, v) = (size[(axis + 1) % 3], size[(axis + 2) % 3]);
            let mut consider = |position: f32, below: usize, above: usize| {
                if !(position > low && position < high) {
                    return;
                }
                let part = |length: f64| (u * v + length * (u + v)) * inv_area;
                let p_below = part(f64::from(position) - f64::from(low));
                let p_above = part(f64::from(high) - f64::from(position));
                let cost = self.rule.cost_ratio + p_below * below as f64 + p_above * above as f64;
                if cost < best.cost {
                    best = Split { cost, axis, position, below, above };
                }
            };
            let (lows, highs) = (&lists.lows[axis], &lists.highs[axis]);
            let below = |p: f32| lows.partition_point(|b| b.0 < p);
            let above = |p: f32| count - highs.partition_point(|b| b.0 <= p);
            match self.rule.candidates {
                SplitCandidates::Uniform => {
                    let step = (f64::from(high) - f64::from(low)) / (self.rule.count + 1) as f64;
                    for i in 1..=self.rule.count {
                        let p = (f64::from(low) + step * i as f64) as f32;
                        consider(p, below(p), above(p));
                    }
                }
                SplitCandidates::Sampled if count > self.rule.count => {
                    let in_cell =
                        |list: &[Bound]| list.partition_point(|b| b.0 <= low)..list.partition_point(|b| b.0 < high);
                    let (l, h) = (&lows[in_cell(lows)], &highs[in_cell(highs)]);
                    for i in 0..self.rule.count {
                        // The middle of each of so many equal parts of the ordered bounds.
                        let rank = (l.len() + h.len()) * (2 * i + 1) / (2 * self.rule.count);
                        if let Some(p) = ranked(l, h, rank) {
                            consider(p, below(p), above(p));
                        }
                    }
                }
                SplitCandidates::Quadratic if count > quadratic::FEW => {
                    quadratic::candidates([low, high], [u, v], |p| [below(p), above(p)], consider);
                }
                SplitCandidates::Bounds | SplitCandidates::Sampled | SplitCandidates::Quadratic => {
                    sweep(lows, highs, consider);
                }
            }
        }
        (best.cost < count as f64).then_some(best)
    }
}

/// One ascending list of two.
fn merge(a: impl Iterator<Item = Bound>, b: Vec<Bound>) -> Vec<Bound> {
    let (mut out, mut b) = (Vec::with_capacity(b.len() + a.size_hint().0), b.into_iter().peekable());
    for bound in a {
        while let Some(other) = b.next_if(|other| other.0 < bound.0) {
            out.push(other);
        }
        out.push(bound);
    }
    out.extend(b);
    out
}

/// Every distinct bound in order, with how many primitives reach below and above it.
fn sweep(lows: &[Bound], highs: &[Bound], mut consider: impl FnMut(f32, usize, usize)) {
    let (mut low, mut high) = (0, 0);
    loop {
        let position = match (lows.get(low), highs.get(high)) {
            (Some(l), Some(h)) => l.0.min(h.0),
            (None, Some(h)) => h.0,
            // Every lower bound has an upper one that is larger.
            (_, None) => return,
        };
        let below = low;
        while high < highs.len() && highs[high].0 <= position {
            high += 1;
        }
        while low < lows.len() && lows[low].0 <= position {
            low += 1;
        }
        consider(position, below, highs.len() - high);
    }
}

/// The value of that rank, from zero, in the union of two ascending lists.
fn ranked(a: &[Bound], b: &[Bound], rank: usize) -> Option<f32> {
    if rank >= a.len() + b.len() {
        return None;
    }
    // The least number of values taken from `a` such that the rest, from `b`, are not above the next of `a`.
    let (mut from, mut to) = (rank.saturating_sub(b.len()), rank.min(a.len()));
    while from < to {
        let i = usize::midpoint(from, to);
        if a[i].0 < b[rank - i - 1].0 {
            from = i + 1;
        } else {
            to = i;
        }
    }
    let (next_a, next_b) = (a.get(from), b.get(rank - from));
    match (next_a, next_b) {
        (Some(x), Some(y)) => Some(x.0.min(y.0)),
        (x, y) => x.or(y).map(|v| v.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_those_of_the_sorted_union() {
        for (a, b) in [(vec![], vec![3.0]), (vec![1.0, 2.0, 2.0, 9.0], vec![0.5, 2.0, 4.0]), (vec![5.0, 6.0], vec![])] {
            let list = |v: &[f32]| v.iter().map(|x| (*x, 0)).collect::<Vec<Bound>>();
            let mut all: Vec<f32> = a.iter().chain(&b).copied().collect();
            all.sort_by(f32::total_cmp);
            for (rank, x) in all.iter().enumerate() {
                assert_eq!(ranked(&list(&a), &list(&b), rank), Some(*x));
            }
            assert_eq!(ranked(&list(&a), &list(&b), all.len()), None);
        }
    }

    #[test]
    fn the_sweep_counts_what_reaches_each_side() {
        let boxes = [(0.0f32, 1.0f32), (0.5, 2.0), (1.0, 3.0), (1.0, 1.5)];
        let mut lows: Vec<Bound> = boxes.iter().map(|b| (b.0, 0)).collect();
        let mut highs: Vec<Bound> = boxes.iter().map(|b| (b.1, 0)).collect();
        lows.sort_by(|a, b| a.0.total_cmp(&b.0));
        highs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut seen = Vec::new();
        sweep(&lows, &highs, |p, below, above| {
            assert_eq!(below, boxes.iter().filter(|b| b.0 < p).count());
            assert_eq!(above, boxes.iter().filter(|b| b.1 > p).count());
            seen.push(p);
        });
        assert_eq!(seen, [0.0, 0.5, 1.0, 1.5, 2.0, 3.0]);
    }
}
