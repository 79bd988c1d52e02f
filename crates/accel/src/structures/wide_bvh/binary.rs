//! A binary tree by the surface-area heuristic over binned centroids: Wald, "On Fast Construction of SAH-based
//! Bounding Volume Hierarchies" (2007), in parallel.
//!
//! Minima, maxima and counts of bins do not depend on the order in which they are gathered, and every subtree knows
//! its place beforehand, so the tree is the same on any number of threads.

use crate::bounds::padded_bounds;
use photinus_geometry::{Aabb, Primitives, Vec4};
use rayon::prelude::*;

/// Subtrees of fewer primitives are left to one thread.
pub const PARALLEL_PRIMS: usize = 4096;
/// Below this depth nodes are halved by count, which takes 30 levels at most: no tree is deeper than 78.
const MAX_SAH_DEPTH: u32 = 48;

/// A primitive to be placed.
#[derive(Clone, Copy, Debug)]
pub struct BuildPrim {
    /// Padded bounds.
    bounds: WideBox,
    /// Primitive id.
    pub id: u32,
}

/// A box in vector registers; the fourth lane is zero.
#[derive(Clone, Copy, Debug)]
struct WideBox {
    min: Vec4,
    max: Vec4,
}

impl WideBox {
    const EMPTY: Self = Self { min: Vec4::INFINITY, max: Vec4::NEG_INFINITY };

    fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    fn with_point(self, p: Vec4) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    fn centroid(&self) -> Vec4 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Half the surface area in scaled units.
    fn scaled_half_area(&self, scale: f32) -> f32 {
        scaled_half_area(&self.aabb(), scale)
    }

    fn aabb(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }
}

/// A node over `count` consecutive primitives from `first`.
#[derive(Clone, Copy, Debug)]
pub struct BinaryNode {
    /// Bounds of all of them.
    pub bounds: Aabb,
    /// Where they start in the order of the tree.
    pub first: u32,
    /// How many.
    pub count: u32,
    /// Primitives of the first child; the second holds the rest. 0 in leaves, which hold one primitive.
    pub left_count: u32,
}

/// A binary tree down to single primitives. The subtree of n primitives at index i takes the 2n - 1 places from i:
/// the node, its first child's subtree, its second child's.
pub struct BinaryTree {
    /// The nodes; none where there is no primitive.
    pub nodes: Vec<BinaryNode>,
    /// Primitives in the order of the tree.
    pub prims: Vec<BuildPrim>,
    /// What lengths are multiplied with before areas are taken, so that no scene is too small or too large for them.
    pub scale: f32,
}

/// Half the surface area in scaled units.
#[inline]
pub fn scaled_half_area(b: &Aabb, scale: f32) -> f32 {
    let d = b.size() * scale;
    d.x * d.y + d.y * d.z + d.z * d.x
}

impl BinaryTree {
    /// The children of an interior node.
    pub fn children(&self, index: usize) -> [usize; 2] {
        [index + 1, index + 2 * self.nodes[index].left_count as usize]
    }
}

/// The hittable primitives with their padded bounds, by id.
fn gather(primitives: &Primitives) -> Vec<BuildPrim> {
    const NONE: BuildPrim = BuildPrim { bounds: WideBox::EMPTY, id: u32::MAX };
    let prim = |id: usize| match padded_bounds(primitives, id) {
        Some(b) => BuildPrim { bounds: WideBox { min: b.min.extend(0.0), max: b.max.extend(0.0) }, id: id as u32 },
        None => NONE,
    };
    // A list of known length is written in place; most scenes have nothing to be taken out of it.
    let mut prims: Vec<_> = (0..primitives.len()).into_par_iter().with_min_len(1024).map(prim).collect();
    prims.retain(|prim| prim.id != NONE.id);
    prims
}

/// Builds the tree.
pub fn build(primitives: &Primitives) -> BinaryTree {
    let mut prims = gather(primitives);
    let leaf = BinaryNode { bounds: Aabb::EMPTY, first: 0, count: 0, left_count: 0 };
    let mut nodes = vec![leaf; (2 * prims.len()).saturating_sub(1)];
    let size = extents(&prims).0.aabb().size().max_element();
    let scale = if size > 0.0 && size.is_finite() { (1.0 / size).min(f32::MAX) } else { 1.0 };
    if !prims.is_empty() {
        subtree(&mut prims, 0, &mut nodes, 0, scale);
    }
    BinaryTree { nodes, prims, scale }
}

fn subtree(prims: &mut [BuildPrim], first: u32, nodes: &mut [BinaryNode], depth: u32, scale: f32) {
    let count = prims.len();
    let (bounds, centroids) = extents(prims);
    let mut node = BinaryNode { bounds: bounds.aabb(), first, count: count as u32, left_count: 0 };
    if count == 1 {
        nodes[0] = node;
        return;
    }
    let by_cost = if count > 2 && depth < MAX_SAH_DEPTH { split(prims, &centroids, scale) } else { None };
    let left_count = by_cost.unwrap_or(count / 2);
    node.left_count = left_count as u32;
    nodes[0] = node;
    let (left_prims, right_prims) = prims.split_at_mut(left_count);
    let (left_nodes, right_nodes) = nodes[1..].split_at_mut(2 * left_count - 1);
    let right_first = first + left_count as u32;
    if count >= PARALLEL_PRIMS {
        rayon::join(
            || subtree(left_prims, first, left_nodes, depth + 1, scale),
            || subtree(right_prims, right_first, right_nodes, depth + 1, scale),
        );
    } else {
        subtree(left_prims, first, left_nodes, depth + 1, scale);
        subtree(right_prims, right_first, right_nodes, depth + 1, scale);
    }
}

/// Bounds of the primitives and of their centroids.
fn extents(prims: &[BuildPrim]) -> (WideBox, WideBox) {
    let empty = (WideBox::EMPTY, WideBox::EMPTY);
    prims.iter().fold(empty, |(b, c), p| (b.union(p.bounds), c.with_point(p.bounds.centroid())))
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: WideBox,
    count: u32,
}

const EMPTY_BIN: Bin = Bin { bounds: WideBox::EMPTY, count: 0 };

/// Added to a small number it leaves its integer in the lowest bits, after rounding to the nearest: bins lie
/// around whole numbers, the first and the last of half the width.
const TO_INTEGER: f32 = 12_582_912.0;

/// Maps centroids to bins.
struct Binning<const BINS: usize> {
    origin: Vec4,
    scale: Vec4,
}

impl<const BINS: usize> Binning<BINS> {
    fn new(centroids: &WideBox) -> Self {
        // Along axes on which there is nothing to divide everything falls into the first bin.
        let size = centroids.max - centroids.min;
        let divides = size.cmpgt(Vec4::ZERO) & size.cmplt(Vec4::INFINITY);
        let scale = Vec4::splat((BINS - 1) as f32) / Vec4::select(divides, size, Vec4::INFINITY);
        Self { origin: Vec4::select(divides, centroids.min, Vec4::ZERO), scale }
    }

    /// The bins of a primitive by axis.
    fn bins(&self, prim: &BuildPrim) -> [usize; 3] {
        let [x, y, z, _] = ((prim.bounds.centroid() - self.origin) * self.scale + Vec4::splat(TO_INTEGER)).to_array();
        [x, y, z].map(|x| x.to_bits() as usize % BINS)
    }

    /// The bin of a primitive along one axis: what `bins` says there.
    fn bin(&self, prim: &BuildPrim, axis: usize) -> usize {
        let centroid = prim.bounds.min[axis] * 0.5 + prim.bounds.max[axis] * 0.5;
        ((centroid - self.origin[axis]) * self.scale[axis] + TO_INTEGER).to_bits() as usize % BINS
    }
}

/// Reorders the primitives by the cheapest split and returns the size of the first part; `None` where no bin border
/// divides them. Few primitives need few bins.
fn split(prims: &mut [BuildPrim], centroids: &WideBox, scale: f32) -> Option<usize> {
    match prims.len() {
        ..8 => split_into::<4>(prims, centroids, scale),
        8..64 => split_into::<8>(prims, centroids, scale),
        _ => split_into::<16>(prims, centroids, scale),
    }
}

fn split_into<const BINS: usize>(prims: &mut [BuildPrim], centroids: &WideBox, scale: f32) -> Option<usize> {
    let binning = Binning::<BINS>::new(centroids);
    let mut bins = [[EMPTY_BIN; BINS]; 3];
    for p in prims.iter() {
        for (axis, i) in binning.bins(p).into_iter().enumerate() {
            let bin = &mut bins[axis][i];
            bin.bounds = bin.bounds.union(p.bounds);
            bin.count += 1;
        }
    }
    let mut best = (f32::INFINITY, 0, 0);
    for (axis, bins) in bins.iter().enumerate() {
        let mut right_costs = [0.0; BINS];
        let mut right = EMPTY_BIN;
        for i in (1..BINS).rev() {
            right.bounds = right.bounds.union(bins[i].bounds);
            right.count += bins[i].count;
            right_costs[i] = right.bounds.scaled_half_area(scale) * right.count as f32;
        }
        let mut left = EMPTY_BIN;
        for i in 1..BINS {
            left.bounds = left.bounds.union(bins[i - 1].bounds);
            left.count += bins[i - 1].count;
            let cost = left.bounds.scaled_half_area(scale) * left.count as f32 + right_costs[i];
            if left.count > 0 && (left.count as usize) < prims.len() && cost < best.0 {
                best = (cost, axis, i);
            }
        }
    }
    let (cost, axis, border) = best;
    (cost < f32::INFINITY).then(|| partition(prims, |p| binning.bin(p, axis) < border))
}

/// Moves the primitives for which `is_left` holds to the front and returns how many they are.
fn partition(prims: &mut [BuildPrim], is_left: impl Fn(&BuildPrim) -> bool) -> usize {
    let (mut i, mut j) = (0, prims.len());
    loop {
        while i < j && is_left(&prims[i]) {
            i += 1;
        }
        while i < j && !is_left(&prims[j - 1]) {
            j -= 1;
        }
        if i == j {
            return i;
        }
        prims.swap(i, j - 1);
    }
}
