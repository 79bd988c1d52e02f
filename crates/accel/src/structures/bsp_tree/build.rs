//! Construction: a kd-tree over the large nodes, planes in any direction in those below.

use super::{Plane, small};
use crate::bounds::{half_area_f64, size_f64};
use crate::options::{BuildError, BuildOptions, Clip, SplitCandidates, check};
use crate::structures::kd_tree::build as kd;
use photinus_geometry::{Aabb, Primitives};

/// Split candidates on each axis of a large node.
const CANDIDATES: usize = 64;
/// Levels whose subtrees are built at the same time.
const PARALLEL_LEVELS: u32 = 8;

/// A subtree.
pub enum Built {
    /// Ids of the primitives in the cell, ascending.
    Leaf(Vec<u32>),
    /// A plane and what lies below and above it.
    Split {
        /// The plane.
        cut: Cut,
        /// Expected cost of a ray that meets the cell, in triangle tests.
        cost: f64,
        /// Below and above.
        children: Box<[Built; 2]>,
    },
}

/// The plane of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cut {
    /// Across an axis.
    Across {
        /// The axis.
        axis: usize,
        /// Where it cuts the axis.
        position: f32,
    },
    /// In any other direction.
    Oblique(Plane),
}

impl Built {
    /// Expected cost of a ray that meets the cell, in triangle tests.
    pub fn cost(&self) -> f64 {
        match self {
            Self::Leaf(ids) => ids.len() as f64,
            Self::Split { cost, .. } => *cost,
        }
    }
}

/// Costs of nodes in triangle tests, and the nodes in which oblique planes are tried.
#[derive(Clone, Copy)]
pub struct Rule {
    /// Of a plane across an axis.
    pub across_cost: f64,
    /// Of any other.
    pub oblique_cost: f64,
    /// In nodes of at most so many primitives.
    pub oblique_prims: usize,
}

/// Builds the tree and returns it with its bounds.
pub fn build(primitives: &Primitives, options: &BuildOptions) -> Result<(Built, Aabb), BuildError> {
    let (factor, prims) = (options.oblique_cost, options.oblique_prims);
    check("the cost of oblique planes", factor, (0.0..=1000.0).contains(&factor), "0 to 1000")?;
    check("the number of primitives for oblique planes", prims, prims <= 256, "0 to 256")?;
    let across_cost = options.cost_ratio()?;
    let rule = Rule { across_cost, oblique_cost: across_cost * factor, oblique_prims: prims as usize };
    let kd_rule = kd::Rule {
        cost_ratio: across_cost,
        candidates: SplitCandidates::Sampled,
        count: CANDIDATES,
        clip: Clip::Exact,
        stop: rule.oblique_prims,
    };
    let (large, bounds) = kd::build(primitives, kd_rule);
    Ok((Builder { primitives, rule }.refine(large, bounds, 0), bounds))
}

struct Builder<'a> {
    primitives: &'a Primitives,
    rule: Rule,
}

impl Builder<'_> {
    /// Continues below the leaves of a kd-tree in `cell`.
    fn refine(&self, built: kd::Built, cell: Aabb, depth: u32) -> Built {
        let kd::Built::Split { axis, position, children } = built else {
            let kd::Built::Leaf(ids) = built else { return Built::Leaf(Vec::new()) };
            let few = ids.len() <= self.rule.oblique_prims;
            return if few { small::build(self.primitives, self.rule, ids, cell) } else { Built::Leaf(ids) };
        };
        let (mut below_cell, mut above_cell) = (cell, cell);
        below_cell.max[axis] = position;
        above_cell.min[axis] = position;
        let [below, above] = *children;
        let build_below = || self.refine(below, below_cell, depth + 1);
        let build_above = || self.refine(above, above_cell, depth + 1);
        let (below, above) = if depth < PARALLEL_LEVELS {
            rayon::join(build_below, build_above)
        } else {
            (build_below(), build_above())
        };
        let part = |b: &Aabb| half_area_f64(size_f64(b)) / half_area_f64(size_f64(&cell));
        let cost = self.rule.across_cost + part(&below_cell) * below.cost() + part(&above_cell) * above.cost();
        Built::Split { cut: Cut::Across { axis, position }, cost, children: Box::new([below, above]) }
    }
}
