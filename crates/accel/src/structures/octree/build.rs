//! Construction: cells are divided in their middle along all three axes.

use crate::bounds::padded_bounds;
use crate::fragment::bounds_within;
use crate::options::Clip;
use photinus_geometry::{Aabb, Primitives, Vec3};
use rayon::prelude::*;

/// Empty leaves and references together stay below this many for each primitive.
const MAX_REFERENCES_PER_PRIM: usize = 32;
/// Subtrees of fewer primitives are built by one thread.
const PARALLEL_PRIMS: usize = 2048;

/// A subtree.
pub enum Built {
    /// Ids of the primitives in the cell, ascending.
    Leaf(Vec<u32>),
    /// The eight parts: bit 0 of the index says whether it lies above in x, bit 1 in y, bit 2 in z.
    Interior(Vec<Built>),
}

/// When a node is divided.
#[derive(Clone, Copy)]
pub struct Rule {
    /// Nodes of more primitives are.
    pub leaf_size: usize,
    /// Nodes above this level are.
    pub max_depth: u32,
    /// What of a primitive belongs to a cell.
    pub clip: Clip,
}

/// The middle of an interval.
#[inline(always)]
pub fn middle_of(low: f32, high: f32) -> f32 {
    low * 0.5 + high * 0.5
}

/// The middle of a cell.
fn middle(cell: &Aabb) -> Vec3 {
    Vec3::from(std::array::from_fn(|k| middle_of(cell.min[k], cell.max[k])))
}

/// One of the eight parts of a cell.
pub fn part(cell: &Aabb, index: usize) -> Aabb {
    let (mut out, middle) = (*cell, middle(cell));
    for axis in 0..3 {
        *if index >> axis & 1 == 1 { &mut out.min[axis] } else { &mut out.max[axis] } = middle[axis];
    }
    out
}

/// A primitive with the bounds of what lies of it in the cell.
type Prim = (u32, Aabb);

/// Builds the tree and returns it with the bounds of the primitives and the root's cell.
pub fn build(primitives: &Primitives, rule: Rule) -> (Built, Aabb, Aabb) {
    let prims: Vec<Prim> = (0..primitives.len())
        .into_par_iter()
        .with_min_len(1024)
        .filter_map(|id| Some((id as u32, padded_bounds(primitives, id)?)))
        .collect();
    let bounds = prims.iter().fold(Aabb::EMPTY, |b, (_, c)| b.union(*c));
    let cube = if bounds.is_empty() { bounds } else { cube(&bounds) };
    let budget = prims.len() * MAX_REFERENCES_PER_PRIM;
    (Builder { primitives, rule }.node(prims, &cube, 0, budget), bounds, cube)
}

/// The cube around a box, as far as floats reach.
fn cube(bounds: &Aabb) -> Aabb {
    let half = (bounds.max * 0.5 - bounds.min * 0.5).max_element();
    let center = middle(bounds);
    let (min, max) = (bounds.min.min(center - half), bounds.max.max(center + half));
    Aabb { min: min.max(Vec3::MIN), max: max.min(Vec3::MAX) }
}

struct Builder<'a> {
    primitives: &'a Primitives,
    rule: Rule,
}

impl Builder<'_> {
    /// The subtree over `prims` in `cell`, of no more than `budget` empty leaves and references.
    fn node(&self, prims: Vec<Prim>, cell: &Aabb, depth: u32, budget: usize) -> Built {
        let leaf = |prims: Vec<Prim>| Built::Leaf(prims.into_iter().map(|p| p.0).collect());
        let middle = middle(cell);
        let divisible = middle.cmpgt(cell.min).all() && middle.cmplt(cell.max).all();
        if prims.len() <= self.rule.leaf_size || depth >= self.rule.max_depth || !divisible {
            return leaf(prims);
        }
        let parts: [Vec<Prim>; 8] = std::array::from_fn(|i| self.within(&prims, &part(cell, i), i, middle));
        let sizes: [usize; 8] = std::array::from_fn(|i| parts[i].len().max(1));
        let sum: usize = sizes.iter().sum();
        // A ray that meets the cell meets each part with a chance of a quarter, by their areas: parts that hold four
        // times as much together save no test.
        let held: usize = parts.iter().map(Vec::len).sum();
        if sum > budget || held >= 4 * prims.len() {
            return leaf(prims);
        }
        let parallel = prims.len() >= PARALLEL_PRIMS;
        drop(prims);
        let child = |(i, part_prims): (usize, Vec<Prim>)| {
            // Shares of the budget do not depend on the order in which subtrees are built.
            let share = sizes[i] + (budget - sum) * sizes[i] / sum;
            self.node(part_prims, &part(cell, i), depth + 1, share)
        };
        let children = Vec::from(parts).into_iter().enumerate();
        Built::Interior(if parallel {
            children.collect::<Vec<_>>().into_par_iter().map(child).collect()
        } else {
            children.map(child).collect()
        })
    }

    /// The primitives that reach into one of the eight parts of a cell.
    fn within(&self, prims: &[Prim], cell: &Aabb, index: usize, middle: Vec3) -> Vec<Prim> {
        let reaches =
            |b: &Aabb| (0..3).all(|k| if index >> k & 1 == 1 { b.max[k] >= middle[k] } else { b.min[k] <= middle[k] });
        let reaching = prims.iter().filter(|(_, b)| reaches(b));
        match self.rule.clip {
            Clip::Box => reaching.copied().collect(),
            Clip::Exact => reaching
                .filter_map(|(id, b)| {
                    // What lies in the part wholly needs no knife.
                    let inside = cell.min.cmple(b.min).all() && cell.max.cmpge(b.max).all();
                    let left = if inside { Some(*b) } else { bounds_within(self.primitives, *id as usize, cell, b) };
                    Some((*id, left?))
                })
                .collect(),
        }
    }
}
