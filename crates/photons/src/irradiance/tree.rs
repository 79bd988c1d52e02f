//! A kd-tree over points with normals that finds the nearest whose normal fits: normals are tested on the way, so that what lies
//! on another surface costs a step and no more.
//!
//! The tree is implicit: the middle of a range is its node, the halves on both sides its children (Bentley, CACM 18(9), 1975,
//! with medians).

use crate::inclusion::distance_sq;
use crate::octahedral::{decode_scaled, encode};
use crate::photon::{NORMAL_MASK, NORMAL_MAX, normal_code};
use photinus_geometry::{Aabb, Vec3};

/// Ranges that are looked through one by one.
const LEAF: usize = 8;

/// A point with a normal.
#[derive(Clone, Copy, Debug)]
struct Node {
    position: Vec3,
    /// The normal, as photons keep theirs, and in the low byte the axis that the range is divided along.
    surface: u32,
    id: u32,
}

/// The tree.
#[derive(Clone, Debug, Default)]
pub(super) struct NormalTree {
    nodes: Vec<Node>,
}

/// A search for the nearest.
struct Nearest {
    position: Vec3,
    normal: Vec3,
    /// Square of the least cosine.
    least_sq: f32,
    best_sq: f32,
    best: Option<u32>,
}

impl NormalTree {
    /// Over points with their normals, of any length but zero; ids are their places in the list.
    pub fn build(points: impl Iterator<Item = (Vec3, Vec3)>) -> Self {
        let node = |(id, (position, normal)): (u32, (Vec3, Vec3))| {
            let [x, y] = encode(normal, NORMAL_MAX);
            Node { position, surface: (x as u32) << 20 | (y as u32 & 0xFFF) << 8, id }
        };
        let mut nodes: Vec<Node> = (0..).zip(points).map(node).collect();
        divide(&mut nodes);
        Self { nodes }
    }

    /// The id of the nearest point within `limit_sq` of `position` (closed) whose normal makes an angle of a cosine of
    /// `least_cosine` (0..1) or more with `normal`, a unit vector; ties go to the least id.
    pub fn nearest(&self, position: Vec3, normal: Vec3, least_cosine: f32, limit_sq: f32) -> Option<u32> {
        let least_sq = least_cosine * least_cosine;
        let mut search = Nearest { position, normal, least_sq, best_sq: limit_sq, best: None };
        search.range(&self.nodes);
        search.best
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<Node>()
    }
}

/// Brings the middle of a range, and of its halves, into their places.
fn divide(nodes: &mut [Node]) {
    if nodes.len() <= LEAF {
        return;
    }
    let size = Aabb::around(nodes.iter().map(|node| node.position)).size();
    let axis = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
    let key = |node: &Node| node.position[axis];
    let middle = nodes.len() / 2;
    nodes.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.id.cmp(&b.id)));
    nodes[middle].surface = nodes[middle].surface & NORMAL_MASK | axis as u32;
    let (below, above) = nodes.split_at_mut(middle);
    divide(below);
    divide(&mut above[1..]);
}

impl Nearest {
    fn range(&mut self, nodes: &[Node]) {
        if nodes.len() <= LEAF {
            nodes.iter().for_each(|node| self.offer(node));
            return;
        }
        let middle = nodes.len() / 2;
        let node = &nodes[middle];
        self.offer(node);
        let axis = (node.surface & !NORMAL_MASK) as usize;
        let apart = self.position[axis] - node.position[axis];
        let (near, far) = match apart < 0.0 {
            true => (&nodes[..middle], &nodes[middle + 1..]),
            false => (&nodes[middle + 1..], &nodes[..middle]),
        };
        self.range(near);
        // Rounding is monotonic: no point of the far side is nearer than this.
        if apart * apart <= self.best_sq {
            self.range(far);
        }
    }

    fn offer(&mut self, node: &Node) {
        let d2 = distance_sq(node.position, self.position);
        let is_nearer = d2 < self.best_sq || (d2 == self.best_sq && self.best.is_none_or(|best| node.id < best));
        if is_nearer && fits(node.surface, self.normal, self.least_sq) {
            (self.best_sq, self.best) = (d2, Some(node.id));
        }
    }
}

/// With v the stored normal of any length, v . n >= c |v|, squared to save the root.
fn fits(surface: u32, normal: Vec3, least_sq: f32) -> bool {
    let v = decode_scaled(normal_code(surface), NORMAL_MAX);
    let dot = (v.x * normal.x + v.y * normal.y) + v.z * normal.z;
    dot > 0.0 && dot * dot >= least_sq * ((v.x * v.x + v.y * v.y) + v.z * v.z)
}

/// The slow answer to [`NormalTree::nearest`]: every point is looked at.
#[cfg(test)]
pub(super) fn nearest_by_brute_force(
    points: &[(Vec3, Vec3)],
    position: Vec3,
    normal: Vec3,
    least_cosine: f32,
    limit_sq: f32,
) -> Option<u32> {
    let mut best: Option<(f32, u32)> = None;
    for (id, (point, own)) in (0..).zip(points) {
        let [x, y] = encode(*own, NORMAL_MAX);
        let d2 = distance_sq(*point, position);
        let is_fitting = fits((x as u32) << 20 | (y as u32 & 0xFFF) << 8, normal, least_cosine * least_cosine);
        if is_fitting && d2 <= limit_sq && best.is_none_or(|(least, _)| d2 < least) {
            best = Some((d2, id));
        }
    }
    best.map(|(_, id)| id)
}
