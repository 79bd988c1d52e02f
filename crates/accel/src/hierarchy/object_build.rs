//! The recursion of binary trees that divide objects: a heuristic says how, this says how deep and on which thread.
//!
//! A subtree depends on its own references alone, so the tree is the same on any number of threads.

use super::binned::Binning;
use super::refs::{BuildRef, Built, BuiltKind, PARALLEL_REFS, bounds_of};
use super::rule::Rule;
use photinus_geometry::Aabb;

/// Below this depth nodes are halved by count.
pub(crate) const MAX_HEURISTIC_DEPTH: u32 = 48;
/// No tree has more levels below the root: halves of 2^30 references take 30.
pub(crate) const MAX_DEPTH: usize = MAX_HEURISTIC_DEPTH as usize + 30;

/// How a node is divided.
pub(crate) struct Split<S> {
    /// References of the first side, which were moved to the front; neither side is empty.
    pub first_count: usize,
    /// Axis along which the first side lies below.
    pub axis: usize,
    /// What goes down to each side.
    pub states: [S; 2],
}

/// A way to divide references.
pub(crate) trait Heuristic: Sync {
    /// What goes down the tree beside the references.
    type State: Send;

    /// Divides a node's references, in `bounds`; `None` makes a leaf.
    fn split(&self, refs: &mut [BuildRef], bounds: &Aabb, state: Self::State) -> Option<Split<Self::State>>;

    /// Most references of a leaf where the heuristic is not asked any more.
    fn leaf_size(&self) -> usize;
}

/// Builds the tree over `refs`, of which there is at least one.
pub(crate) fn build<H: Heuristic>(heuristic: &H, refs: &mut [BuildRef], state: H::State) -> Built<Aabb> {
    subtree(heuristic, refs, Some(state), 0)
}

fn subtree<H: Heuristic>(heuristic: &H, refs: &mut [BuildRef], state: Option<H::State>, depth: u32) -> Built<Aabb> {
    let (count, bounds) = (refs.len(), bounds_of(refs));
    let split = match state.filter(|_| depth < MAX_HEURISTIC_DEPTH && count > 1) {
        Some(state) => heuristic.split(refs, &bounds, state).map(|s| (s.first_count, s.axis, s.states.map(Some))),
        None => (count > heuristic.leaf_size()).then_some((count / 2, 0, [None, None])),
    };
    let Some((first_count, axis, [first_state, second_state])) = split else { return Built::leaf(bounds, refs) };
    let (first, second) = refs.split_at_mut(first_count);
    let build_first = || subtree(heuristic, first, first_state, depth + 1);
    let build_second = || subtree(heuristic, second, second_state, depth + 1);
    let (first, second) =
        if count >= PARALLEL_REFS { rayon::join(build_first, build_second) } else { (build_first(), build_second()) };
    Built { volume: bounds, kind: BuiltKind::Inner { axis, children: vec![first, second] } }
}

/// The binned surface-area heuristic with leaves by cost.
pub(crate) struct ByCost(pub Rule);

impl Heuristic for ByCost {
    type State = ();

    fn split(&self, refs: &mut [BuildRef], bounds: &Aabb, (): ()) -> Option<Split<()>> {
        let binning = Binning::new(refs, self.0.bins);
        let best = binning.best(refs)?;
        self.0.takes(best.area_cost, bounds, refs.len()).then(|| Split {
            first_count: binning.divide(refs, &best),
            axis: best.axis,
            states: [(), ()],
        })
    }

    fn leaf_size(&self) -> usize {
        self.0.leaf_size.min(8)
    }
}
