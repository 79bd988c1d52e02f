//! Spatial splits: the cheapest plane by chopped bins (section 4.2 of the paper), and the division of references,
//! which takes back splits that are dearer than none (section 4.4, "reference unsplitting").

use crate::bounds::{half_area_f64, size_f64};
use crate::hierarchy::clip::Clipper;
use crate::hierarchy::refs::{BuildRef, PARALLEL_REFS, bounds_of};
use crate::hierarchy::rule::MAX_BINS;
use arrayvec::ArrayVec;
use photinus_geometry::{Aabb, Primitives};

/// A plane that divides a node's space.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpatialSplit {
    /// Half areas times counts of both sides, summed.
    pub area_cost: f64,
    axis: usize,
    position: f64,
    sides: [Side; 2],
}

/// What a side of a plane holds.
#[derive(Clone, Copy, Debug)]
struct Side {
    bounds: Aabb,
    count: usize,
}

/// What is counted between two planes.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    /// References whose lowest bin this is, and whose highest.
    begins: usize,
    ends: usize,
}

fn area(b: &Aabb) -> f64 {
    half_area_f64(size_f64(b))
}

/// The cheapest plane between bins of equal width; none where nothing lies on one side of each.
pub(super) fn best(
    primitives: &Primitives,
    refs: &[BuildRef],
    bounds: &Aabb,
    bin_count: usize,
) -> Option<SpatialSplit> {
    let along = |axis: usize| best_along(primitives, refs, bounds, bin_count, axis);
    let found: [Option<SpatialSplit>; 3] = if refs.len() >= PARALLEL_REFS {
        let (x, (y, z)) = rayon::join(|| along(0), || rayon::join(|| along(1), || along(2)));
        [x, y, z]
    } else {
        [along(0), along(1), along(2)]
    };
    let cheaper = |a: SpatialSplit, b: SpatialSplit| if b.area_cost < a.area_cost { b } else { a };
    found.into_iter().flatten().reduce(cheaper)
}

/// The same across one axis.
fn best_along(
    primitives: &Primitives,
    refs: &[BuildRef],
    bounds: &Aabb,
    bin_count: usize,
    axis: usize,
) -> Option<SpatialSplit> {
    let mut clipper = Clipper::default();
    let mut best: Option<SpatialSplit> = None;
    let (low, high) = (f64::from(bounds.min[axis]), f64::from(bounds.max[axis]));
    let width = (high - low) / bin_count as f64;
    if !(width > 0.0) {
        return None;
    }
    // Planes by index; those at both ends let everything through.
    let plane = |i: usize| match i {
        0 => f64::NEG_INFINITY,
        i if i == bin_count => f64::INFINITY,
        i => low + width * i as f64,
    };
    let bin_of = |x: f32| (((f64::from(x) - low) / width) as usize).min(bin_count - 1);
    let empty = Bin { bounds: Aabb::EMPTY, begins: 0, ends: 0 };
    let mut bins: ArrayVec<Bin, MAX_BINS> = std::iter::repeat_n(empty, bin_count).collect();
    for r in refs {
        let (first, last) = (bin_of(r.bounds.min[axis]), bin_of(r.bounds.max[axis]));
        bins[first].begins += 1;
        bins[last].ends += 1;
        if first == last {
            bins[first].bounds = bins[first].bounds.union(r.bounds);
            continue;
        }
        for i in first..=last {
            let slab = [plane(i), plane(i + 1)];
            if let Some(part) = clipper.slab(primitives, r.id as usize, &r.bounds, axis, slab) {
                bins[i].bounds = bins[i].bounds.union(part);
            }
        }
    }
    let mut above: ArrayVec<Side, MAX_BINS> = ArrayVec::new();
    let mut side = Side { bounds: Aabb::EMPTY, count: 0 };
    for bin in bins.iter().rev() {
        side = Side { bounds: side.bounds.union(bin.bounds), count: side.count + bin.ends };
        above.push(side);
    }
    let mut below = Side { bounds: Aabb::EMPTY, count: 0 };
    for border in 1..bin_count {
        let bin = &bins[border - 1];
        below = Side { bounds: below.bounds.union(bin.bounds), count: below.count + bin.begins };
        let above = above[bin_count - 1 - border];
        if below.count == 0 || above.count == 0 {
            continue;
        }
        let area_cost = area(&below.bounds) * below.count as f64 + area(&above.bounds) * above.count as f64;
        if best.is_none_or(|b| area_cost < b.area_cost) {
            best = Some(SpatialSplit { area_cost, axis, position: plane(border), sides: [below, above] });
        }
    }
    best
}

impl SpatialSplit {
    /// Axis of the plane.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// References of both sides. One that reaches across is in both with the parts of its bounds, or whole in one where
    /// that is cheaper.
    pub fn divide(&self, primitives: &Primitives, refs: &[BuildRef]) -> [Vec<BuildRef>; 2] {
        let mut clipper = Clipper::default();
        let Self { axis, position, sides: [mut below, mut above], .. } = *self;
        let (mut first, mut second) = (Vec::with_capacity(below.count), Vec::with_capacity(above.count));
        for r in refs {
            let mut part = |slab| {
                let bounds = clipper.slab(primitives, r.id as usize, &r.bounds, axis, slab)?;
                Some(BuildRef { bounds, id: r.id })
            };
            let reaches_below = f64::from(r.bounds.min[axis]) < position;
            let reaches_above = f64::from(r.bounds.max[axis]) > position;
            let low = reaches_below.then(|| part([f64::NEG_INFINITY, position])).flatten();
            let high = reaches_above.then(|| part([position, f64::INFINITY])).flatten();
            let (Some(low), Some(high)) = (low, high) else {
                // What lies in the plane itself goes below it; so does what rounding took from both sides.
                if low.is_none() && reaches_above {
                    second.push(*r)
                } else {
                    first.push(*r)
                }
                continue;
            };
            let (a, b) = (area(&below.bounds), area(&above.bounds));
            let (n, m) = (below.count as f64, above.count as f64);
            let whole_below = area(&below.bounds.union(r.bounds));
            let whole_above = area(&above.bounds.union(r.bounds));
            let both = a * n + b * m;
            let only_below = whole_below * n + b * (m - 1.0);
            let only_above = a * (n - 1.0) + whole_above * m;
            if only_below < both && only_below <= only_above && above.count > 1 {
                below.bounds = below.bounds.union(r.bounds);
                above.count -= 1;
                first.push(*r);
            } else if only_above < both && below.count > 1 {
                above.bounds = above.bounds.union(r.bounds);
                below.count -= 1;
                second.push(*r);
            } else {
                first.push(low);
                second.push(high);
            }
        }
        [first, second]
    }

    /// What the division costs as it came out.
    pub fn cost_of(sides: &[Vec<BuildRef>; 2]) -> f64 {
        sides.iter().map(|side| area(&bounds_of(side)) * side.len() as f64).sum()
    }
}
