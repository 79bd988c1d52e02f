//! The recursion: at every node the cheaper of an object and a spatial split, as long as it costs less than a leaf.

use super::spatial::{self, SpatialSplit};
use crate::bounds::{half_area_f64, size_f64};
use crate::hierarchy::binned::Binning;
use crate::hierarchy::object_build::MAX_HEURISTIC_DEPTH;
use crate::hierarchy::refs::{BuildRef, Built, BuiltKind, PARALLEL_REFS, bounds_of, gather};
use crate::hierarchy::rule::{Rule, reference_budget};
use photinus_geometry::{Aabb, Primitives};

/// Leaves hold so many references below the depth to which the heuristic is asked.
const DEEP_LEAF: usize = 8;

struct Builder<'a> {
    primitives: &'a Primitives,
    rule: Rule,
    /// Half area above which an overlap makes spatial splits worth a try.
    overlap: f64,
}

/// Builds the tree; `None` where no primitive can be hit. It holds at most `limit` references for each primitive.
pub(super) fn build(primitives: &Primitives, rule: Rule, alpha: f64, limit: f64) -> Option<Built<Aabb>> {
    let refs = gather(primitives);
    if refs.is_empty() {
        return None;
    }
    let overlap = alpha * half_area_f64(size_f64(&bounds_of(&refs)));
    let budget = reference_budget(refs.len(), limit);
    Some(Builder { primitives, rule, overlap }.node(refs, 0, budget))
}

impl Builder<'_> {
    /// The subtree over `refs`, of no more than `budget` references.
    fn node(&self, mut refs: Vec<BuildRef>, depth: u32, budget: usize) -> Built<Aabb> {
        let (count, bounds) = (refs.len(), bounds_of(&refs));
        let divided = if depth < MAX_HEURISTIC_DEPTH && count > 1 {
            self.divide(&mut refs, &bounds, budget)
        } else {
            (count > self.rule.leaf_size.min(DEEP_LEAF)).then(|| {
                let second = refs.split_off(count / 2);
                (0, [std::mem::take(&mut refs), second])
            })
        };
        let Some((axis, [first, second])) = divided else { return Built::leaf(bounds, &refs) };
        drop(refs);
        // Shares of the budget do not depend on the order in which subtrees are built.
        let total = first.len() + second.len();
        let first_budget = first.len() + (budget - total) * first.len() / total;
        let second_budget = budget - first_budget;
        let build_first = || self.node(first, depth + 1, first_budget);
        let build_second = || self.node(second, depth + 1, second_budget);
        let children = if count >= PARALLEL_REFS {
            let (a, b) = rayon::join(build_first, build_second);
            vec![a, b]
        } else {
            vec![build_first(), build_second()]
        };
        Built { volume: bounds, kind: BuiltKind::Inner { axis, children } }
    }

    /// Both sides of the cheapest division with its axis; `None`, and the references as they were, where a leaf is
    /// cheaper.
    fn divide(&self, refs: &mut Vec<BuildRef>, bounds: &Aabb, budget: usize) -> Option<(usize, [Vec<BuildRef>; 2])> {
        let count = refs.len();
        let binning = Binning::new(refs, self.rule.bins);
        let object = binning.best(refs);
        let object_cost = object.map_or(f64::INFINITY, |o| o.area_cost);
        let overlaps = object.is_none_or(|o| {
            let [a, b] = o.sides;
            let shared = Aabb { min: a.min.max(b.min), max: a.max.min(b.max) };
            !shared.is_empty() && half_area_f64(size_f64(&shared)) > self.overlap
        });
        if overlaps && budget > count {
            let spatial = spatial::best(self.primitives, refs, bounds, self.rule.bins);
            if let Some(split) = spatial.filter(|s| s.area_cost < object_cost) {
                let sides = split.divide(self.primitives, refs);
                let cost = SpatialSplit::cost_of(&sides);
                // Where all reach across, only what is gained in space can be worth it.
                let worth = if sides.iter().all(|side| side.len() < count) {
                    self.rule.takes(cost, bounds, count)
                } else {
                    self.rule.is_cheaper(cost, bounds, count)
                };
                let fits = sides[0].len() + sides[1].len() <= budget;
                if worth && fits && sides.iter().all(|side| !side.is_empty()) && cost < object_cost {
                    return Some((split.axis(), sides));
                }
            }
        }
        let object = object.filter(|o| self.rule.takes(o.area_cost, bounds, count))?;
        let first_count = binning.divide(refs, &object);
        let second = refs.split_off(first_count);
        Some((object.axis, [std::mem::take(refs), second]))
    }
}
