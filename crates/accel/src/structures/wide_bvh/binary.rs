//! A binary tree by the surface-area heuristic over binned centroids: Wald, "On Fast Construction of SAH-based
//! Bounding Volume Hierarchies" (2007), in parallel.
//!
//! Minima, maxima and counts of bins do not depend on the order in which they are gathered, and every subtree knows
//! its place beforehand, so the tree is the same on any number of threads.

use crate::bounds::padded_bounds;
use photinus_geometry::{Aabb, Primitives, Vec3};
use rayon::prelude::*;

/// Bins per axis in large nodes.
const BINS: usize = 16;
/// Subtrees of fewer primitives are built by one thread.
const PARALLEL_PRIMS: usize = 4096;
/// Below this depth nodes are halved by count, which takes 30 levels at most: no tree is deeper than 78.
const MAX_SAH_DEPTH: u32 = 48;

/// A primitive to be placed: its padded bounds and id.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct BuildPrim {
    /// Lower corner.
    pub min: Vec3,
    /// Primitive id.
    pub id: u32,
    /// Upper corner.
    pub max: Vec3,
    padding: u32,
}

impl BuildPrim {
    fn bounds(&self) -> Aabb {
        Aabb { min: self.min, max: self.max }
    }

    fn centroid(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
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
    (0..primitives.len())
        .into_par_iter()
        .with_min_len(1024)
        .filter_map(|id| {
            let b = padded_bounds(primitives, id)?;
            Some(BuildPrim { min: b.min, id: id as u32, max: b.max, padding: 0 })
        })
        .collect()
}

/// Builds the tree.
pub fn build(primitives: &Primitives) -> BinaryTree {
    let mut prims = gather(primitives);
    let leaf = BinaryNode { bounds: Aabb::EMPTY, first: 0, count: 0, left_count: 0 };
    let mut nodes = vec![leaf; (2 * prims.len()).saturating_sub(1)];
    let size = extents(&prims).0.size().max_element();
    let scale = if size > 0.0 && size.is_finite() { (1.0 / size).min(f32::MAX) } else { 1.0 };
    if !prims.is_empty() {
        subtree(&mut prims, 0, &mut nodes, 0, scale);
    }
    BinaryTree { nodes, prims, scale }
}

fn subtree(prims: &mut [BuildPrim], first: u32, nodes: &mut [BinaryNode], depth: u32, scale: f32) {
    let count = prims.len();
    let (bounds, centroids) = extents(prims);
    if count == 1 {
        nodes[0] = BinaryNode { bounds, first, count: 1, left_count: 0 };
        return;
    }
    let left_count = if depth < MAX_SAH_DEPTH { split(prims, &centroids, scale) } else { None }.unwrap_or(count / 2);
    nodes[0] = BinaryNode { bounds, first, count: count as u32, left_count: left_count as u32 };
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
fn extents(prims: &[BuildPrim]) -> (Aabb, Aabb) {
    prims.iter().fold((Aabb::EMPTY, Aabb::EMPTY), |(b, c), p| (b.union(p.bounds()), c.with_point(p.centroid())))
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: u32,
}

const EMPTY_BIN: Bin = Bin { bounds: Aabb::EMPTY, count: 0 };

/// Maps centroids to bins.
struct Binning {
    bins: usize,
    origin: Vec3,
    scale: Vec3,
}

impl Binning {
    fn new(count: usize, centroids: &Aabb) -> Self {
        let bins = (4 + count / 8).min(BINS);
        // A little less than the number of bins, so that the upper end falls into the last one.
        let scale = Vec3::splat(bins as f32 * (1.0 - 1e-6)) / centroids.size();
        Self { bins, origin: centroids.min, scale }
    }

    fn bin(&self, prim: &BuildPrim, axis: usize) -> usize {
        let x = (prim.min[axis] * 0.5 + prim.max[axis] * 0.5 - self.origin[axis]) * self.scale[axis];
        (x as usize).min(self.bins - 1)
    }
}

/// Reorders the primitives by the cheapest split and returns the size of the first part; `None` where no bin border
/// divides them.
fn split(prims: &mut [BuildPrim], centroids: &Aabb, scale: f32) -> Option<usize> {
    let binning = Binning::new(prims.len(), centroids);
    let mut bins = [[EMPTY_BIN; BINS]; 3];
    for p in prims.iter() {
        for axis in 0..3 {
            let bin = &mut bins[axis][binning.bin(p, axis)];
            bin.bounds = bin.bounds.union(p.bounds());
            bin.count += 1;
        }
    }
    let mut best = (f32::INFINITY, 0, 0);
    for (axis, bins) in bins.iter().enumerate() {
        let bins = &bins[..binning.bins];
        let mut right_costs = [0.0; BINS];
        let mut right = EMPTY_BIN;
        for i in (1..bins.len()).rev() {
            right.bounds = right.bounds.union(bins[i].bounds);
            right.count += bins[i].count;
            right_costs[i] = scaled_half_area(&right.bounds, scale) * right.count as f32;
        }
        let mut left = EMPTY_BIN;
        for i in 1..bins.len() {
            left.bounds = left.bounds.union(bins[i - 1].bounds);
            left.count += bins[i - 1].count;
            let cost = scaled_half_area(&left.bounds, scale) * left.count as f32 + right_costs[i];
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
