//! A left-balanced kd-tree without pointers: Jensen, "Realistic Image Synthesis Using Photon Mapping" (2001), chapter
//! 6, the search of the thesis's renderer.
//!
//! Node i has the children 2i + 1 (below) and 2i + 2 (above); every level but the last is full and the last is filled
//! from the left, so that n photons need exactly n nodes. Each node splits its photons at their median along the axis
//! in which their box is longest.

use crate::inclusion::{PreparedQuery, distance_sq, radius_sq};
use crate::nearest::{NearestHeap, Ties};
use crate::results::ResultSet;
use crate::visiting::{gather_batch_by_visiting, gather_counted_by_visiting};
use crate::{GatherQuery, Gathered, Kernel, Neighbor, Photon, Region, Search, SearchSummary};
use photinus_geometry::{Aabb, Vec3};
use photinus_profile::SearchCounters;
use rayon::prelude::*;
use std::sync::OnceLock;

pub(crate) const ABOUT: &str = "left-balanced implicit kd-tree of the thesis";

/// The split axis lies above the id.
const AXIS_SHIFT: u32 = 30;
/// The id's bits of a node.
const ID_MASK: u32 = (1 << AXIS_SHIFT) - 1;
/// Subtrees of fewer photons are built by one task.
const PHOTONS_A_TASK: usize = 8192;
/// Deepest stack: one entry a level of at most 2^30 nodes.
const STACK: usize = 32;

/// What a traversal reads.
#[derive(Clone, Copy, Debug)]
struct Node {
    position: Vec3,
    axis_and_id: u32,
}

/// What only found photons need: flux, direction and surface word.
type Payload = [u32; 3];

/// The finished tree.
pub(crate) struct KdBalanced {
    nodes: Vec<Node>,
    payloads: Vec<Payload>,
    /// The node of each id; made when first asked for.
    node_of: OnceLock<Vec<u32>>,
}

impl Node {
    fn axis(self) -> usize {
        (self.axis_and_id >> AXIS_SHIFT) as usize
    }

    fn id(self) -> u32 {
        self.axis_and_id & ID_MASK
    }
}

impl KdBalanced {
    /// `photons` are at most 2^30.
    pub(crate) fn new(photons: &[Photon]) -> Self {
        let count = photons.len();
        let mut in_order: Vec<Node> =
            (0u32..).zip(photons).map(|(id, p)| Node { position: p.position(), axis_and_id: id }).collect();
        let bounds = in_order.par_iter().with_min_len(PHOTONS_A_TASK).map(|n| n.position);
        let bounds = bounds.fold(|| Aabb::EMPTY, Aabb::with_point).reduce(|| Aabb::EMPTY, Aabb::union);
        balance(&mut in_order, bounds);
        let mut nodes = vec![Node { position: Vec3::ZERO, axis_and_id: 0 }; count];
        let mut payloads = vec![[0; 3]; count];
        nodes.par_iter_mut().zip(&mut payloads).with_min_len(PHOTONS_A_TASK).enumerate().for_each(|(i, (node, p))| {
            *node = in_order[rank(i, count)];
            let [_, _, _, flux, direction, surface] = photons[node.id() as usize].to_words();
            *p = [flux, direction, surface];
        });
        Self { nodes, payloads, node_of: OnceLock::new() }
    }

    /// Calls `visit` with node index and squared distance of photons within the squared radius that `visit` returns
    /// each time; the first is `r2`. Returns the photons tested.
    #[inline]
    fn traverse(&self, position: Vec3, mut r2: f32, mut visit: impl FnMut(usize, f32) -> f32) -> u64 {
        let mut stack = [(0usize, 0f32); STACK];
        let mut depth = 0;
        let mut tested = 0;
        let mut i = 0;
        if !(r2 >= 0.0) {
            return 0;
        }
        loop {
            // Down to a leaf, keeping the sides that the query's middle is not on.
            while i < self.nodes.len() {
                let node = self.nodes[i];
                tested += 1;
                let d2 = distance_sq(node.position, position);
                if d2 <= r2 {
                    r2 = visit(i, d2);
                }
                let axis = node.axis();
                let d = position[axis] - node.position[axis];
                let (near, far) = if d < 0.0 { (2 * i + 1, 2 * i + 2) } else { (2 * i + 2, 2 * i + 1) };
                // The square of one difference, rounded, is at most the rounded sum of three squares.
                if far < self.nodes.len() && d * d <= r2 {
                    stack[depth] = (far, d * d);
                    depth += 1;
                }
                i = near;
            }
            loop {
                if depth == 0 {
                    return tested;
                }
                depth -= 1;
                if stack[depth].1 <= r2 {
                    i = stack[depth].0;
                    break;
                }
            }
        }
    }

    fn photon_at(&self, node: usize) -> Photon {
        let [flux, direction, surface] = self.payloads[node];
        Photon::from_parts(self.nodes[node].position.to_array(), flux, direction, surface)
    }

    fn visit_counting(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32)) -> u64 {
        let prepared = PreparedQuery::new(query, Kernel::Constant);
        self.traverse(query.position, prepared.r2, |node, d2| {
            if prepared.accepts(self.payloads[node][2]) {
                visit(&self.photon_at(node), d2);
            }
            prepared.r2
        })
    }
}

/// Nodes below the root of a left-balanced tree of `count` (at least one) nodes.
fn below_count(count: usize) -> usize {
    let full = 1 << count.ilog2();
    // The last level's nodes: the half that lies below takes them first.
    let last = count - (full - 1);
    (full - 1) / 2 + last.min(full / 2)
}

/// Place in order (below, node, above) of node `i` in a left-balanced tree of `count` nodes.
fn rank(i: usize, count: usize) -> usize {
    let (mut first, mut count) = (0, count);
    // The bits of i + 1 below its highest are the way down from the root.
    let path = i + 1;
    for level in (0..path.ilog2()).rev() {
        let below = below_count(count);
        if path >> level & 1 == 0 {
            count = below;
        } else {
            first += below + 1;
            count -= below + 1;
        }
    }
    first + below_count(count)
}

/// Puts nodes into the order of a left-balanced tree, with their split axes. `bounds` is the box of the photons' cell:
/// their own box cut by the splits above.
fn balance(nodes: &mut [Node], bounds: Aabb) {
    if nodes.len() <= 1 {
        return;
    }
    let size = bounds.size();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let middle = below_count(nodes.len());
    nodes.select_nth_unstable_by(middle, |a, b| {
        a.position[axis].total_cmp(&b.position[axis]).then(a.axis_and_id.cmp(&b.axis_and_id))
    });
    let (below, rest) = nodes.split_at_mut(middle);
    let (node, above) = rest.split_first_mut().expect("the middle lies inside");
    let (mut bounds_below, mut bounds_above) = (bounds, bounds);
    bounds_below.max[axis] = node.position[axis];
    bounds_above.min[axis] = node.position[axis];
    node.axis_and_id |= (axis as u32) << AXIS_SHIFT;
    if below.len() > PHOTONS_A_TASK {
        rayon::join(|| balance(below, bounds_below), || balance(above, bounds_above));
    } else {
        balance(below, bounds_below);
        balance(above, bounds_above);
    }
}

impl Search for KdBalanced {
    fn gather(&self, queries: &[GatherQuery], kernel: Kernel, out: &mut [Gathered]) {
        gather_batch_by_visiting(self, queries, kernel, out);
    }

    fn gather_counted(
        &self,
        queries: &[GatherQuery],
        kernel: Kernel,
        out: &mut [Gathered],
        counters: &mut SearchCounters,
    ) {
        gather_counted_by_visiting(self, queries, kernel, out, counters);
    }

    fn visit(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32)) {
        self.visit_counting(query, visit);
    }

    fn visit_counted(&self, query: &GatherQuery, visit: &mut dyn FnMut(&Photon, f32), counters: &mut SearchCounters) {
        let mut photons_found = 0;
        let photons_tested = self.visit_counting(query, &mut |photon, d2| {
            photons_found += 1;
            visit(photon, d2);
        });
        *counters += SearchCounters { searches: 1, photons_tested, photons_found };
    }

    fn collect_nearest_counted(
        &self,
        query: &GatherQuery,
        k: u32,
        found: &mut Vec<(Photon, f32)>,
        counters: &mut SearchCounters,
    ) {
        let prepared = PreparedQuery::new(query, Kernel::Constant);
        let mut nearest = Vec::with_capacity(k.min(1024) as usize);
        let mut ties = Ties::default();
        let mut heap = NearestHeap::new(&mut nearest, k as usize, prepared.r2);
        let photons_tested = self.traverse(query.position, heap.limit(), |node, distance_sq| {
            if prepared.accepts(self.payloads[node][2]) {
                heap.offer_with_ties(Neighbor { distance_sq, photon: node as u32 }, &mut ties);
            }
            heap.limit()
        });
        found.clear();
        found.extend(nearest.iter().chain(ties.all()).map(|n| (self.photon_at(n.photon as usize), n.distance_sq)));
        *counters += SearchCounters { searches: 1, photons_tested, photons_found: found.len() as u64 };
    }

    fn search(&self, region: &Region, results: &mut dyn ResultSet) -> u64 {
        if !region.is_valid() {
            return 0;
        }
        let middle = region.middle();
        self.traverse(middle, results.limit().min(region.radius_sq()), |node, d2| {
            if region.holds(self.nodes[node].position, middle).is_some() {
                results.add(self.nodes[node].id(), &self.photon_at(node), d2);
            }
            results.limit().min(region.radius_sq())
        })
    }

    fn within_radius(&self, position: Vec3, radius: f32, found: &mut Vec<Neighbor>) {
        let r2 = radius_sq(position, radius);
        found.clear();
        self.traverse(position, r2, |node, distance_sq| {
            found.push(Neighbor { distance_sq, photon: self.nodes[node].id() });
            r2
        });
        found.sort_unstable_by_key(|n| n.photon);
    }

    fn nearest(&self, position: Vec3, k: usize, radius: f32, found: &mut Vec<Neighbor>) {
        let mut heap = NearestHeap::new(found, k, radius_sq(position, radius));
        self.traverse(position, heap.limit(), |node, distance_sq| {
            heap.offer(Neighbor { distance_sq, photon: self.nodes[node].id() });
            heap.limit()
        });
        heap.finish();
    }

    fn photon(&self, id: u32) -> Photon {
        let node_of = self.node_of.get_or_init(|| {
            let mut node_of = vec![0; self.nodes.len()];
            for (i, node) in (0u32..).zip(&self.nodes) {
                node_of[node.id() as usize] = i;
            }
            node_of
        });
        self.photon_at(node_of[id as usize] as usize)
    }

    fn summary(&self) -> SearchSummary {
        let bytes = self.nodes.capacity() * size_of::<Node>()
            + self.payloads.capacity() * size_of::<Payload>()
            + self.node_of.get().map_or(0, |n| n.capacity() * size_of::<u32>());
        SearchSummary { name: "kd-balanced", photons: self.nodes.len() as u64, bytes: bytes as u64, kernels: "" }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rule against its definition: levels full but the last, the last filled from the left.
    #[test]
    fn ranks_are_those_of_a_walk_in_order() {
        fn walk(i: usize, count: usize, order: &mut Vec<usize>) {
            if i < count {
                walk(2 * i + 1, count, order);
                order.push(i);
                walk(2 * i + 2, count, order);
            }
        }
        for count in (1..70).chain([1000, 1023, 1024, 1025]) {
            let mut order = Vec::new();
            walk(0, count, &mut order);
            for (place, i) in order.into_iter().enumerate() {
                assert_eq!(rank(i, count), place, "node {i} of {count}");
            }
        }
    }
}
