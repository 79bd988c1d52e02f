//! The surface-area heuristic over binned middles: Wald, "On Fast Construction of SAH-based Bounding Volume
//! Hierarchies", RT 2007, section 3.
//!
//! Areas are taken in doubles, so that no scene is too small or too large for them.

use super::refs::{BuildRef, partition};
use super::rule::{MAX_BINS, Rule};
use crate::bounds::{half_area_f64, size_f64};
use arrayvec::ArrayVec;
use photinus_geometry::Aabb;

/// A way to divide a node's references by their middles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObjectSplit {
    /// Half areas times counts of both sides, summed.
    pub area_cost: f64,
    /// Axis of the border.
    pub axis: usize,
    /// The first bin of the second side.
    pub border: usize,
    /// Bounds of the sides.
    pub sides: [Aabb; 2],
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: usize,
}

const EMPTY_BIN: Bin = Bin { bounds: Aabb::EMPTY, count: 0 };

/// Maps middles to bins along every axis.
pub(crate) struct Binning {
    origin: [f32; 3],
    scale: [f32; 3],
    bins: usize,
}

impl Binning {
    /// Bins between the extremes of the middles; few references need few.
    pub fn new(refs: &[BuildRef], bins: usize) -> Self {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for r in refs {
            for axis in 0..3 {
                let c = r.centroid(axis);
                low[axis] = low[axis].min(c);
                high[axis] = high[axis].max(c);
            }
        }
        let bins = bins.min(refs.len().max(4)).min(MAX_BINS);
        // Along axes on which nothing can be divided everything falls into the first bin.
        let scale = std::array::from_fn(|axis| {
            let scale = bins as f32 / (high[axis] - low[axis]);
            if scale.is_finite() { scale } else { 0.0 }
        });
        Self { origin: low, scale, bins }
    }

    /// The bin of a reference along an axis.
    #[inline(always)]
    pub fn bin(&self, r: &BuildRef, axis: usize) -> usize {
        (((r.centroid(axis) - self.origin[axis]) * self.scale[axis]) as usize).min(self.bins - 1)
    }

    /// The cheapest border between bins that leaves something on both sides; of equals the first.
    pub fn best(&self, refs: &[BuildRef]) -> Option<ObjectSplit> {
        let mut best: Option<ObjectSplit> = None;
        for axis in 0..3 {
            if self.scale[axis] == 0.0 {
                continue;
            }
            let mut bins: ArrayVec<Bin, MAX_BINS> = std::iter::repeat_n(EMPTY_BIN, self.bins).collect();
            for r in refs {
                let bin = &mut bins[self.bin(r, axis)];
                bin.bounds = bin.bounds.union(r.bounds);
                bin.count += 1;
            }
            let mut above: ArrayVec<Bin, MAX_BINS> = bins.clone();
            for i in (0..self.bins - 1).rev() {
                above[i].bounds = above[i].bounds.union(above[i + 1].bounds);
                above[i].count += above[i + 1].count;
            }
            let mut below = EMPTY_BIN;
            for border in 1..self.bins {
                below.bounds = below.bounds.union(bins[border - 1].bounds);
                below.count += bins[border - 1].count;
                let above = &above[border];
                if below.count == 0 || above.count == 0 {
                    continue;
                }
                let cost = |bin: &Bin| half_area_f64(size_f64(&bin.bounds)) * bin.count as f64;
                let area_cost = cost(&below) + cost(above);
                if best.is_none_or(|b| area_cost < b.area_cost) {
                    best = Some(ObjectSplit { area_cost, axis, border, sides: [below.bounds, above.bounds] });
                }
            }
        }
        best
    }

    /// Moves the first side of a split to the front and returns its size.
    pub fn divide(&self, refs: &mut [BuildRef], split: &ObjectSplit) -> usize {
        partition(refs, |r| self.bin(r, split.axis) < split.border)
    }
}

impl Rule {
    /// Whether a split of that [`ObjectSplit::area_cost`] is worth a node, against a leaf.
    pub fn takes(&self, area_cost: f64, bounds: &Aabb, count: usize) -> bool {
        count > self.leaf_size || self.is_cheaper(area_cost, bounds, count)
    }

    /// Whether it costs less than the leaf.
    pub fn is_cheaper(&self, area_cost: f64, bounds: &Aabb, count: usize) -> bool {
        let area = half_area_f64(size_f64(bounds));
        area > 0.0 && self.cost_ratio + area_cost / area < count as f64
    }
}
