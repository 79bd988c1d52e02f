//! A bounding volume hierarchy over photons: two children a node, each with the box of its photons, split at the median
//! along the box's longest axis.

use crate::Photon;
use crate::index::{Index, Indexed, Scan};
use crate::store::positions;
use photinus_geometry::{Aabb, Vec3};

pub(crate) const ABOUT: &str = "bounding volume hierarchy, leaves of eight photons";

/// Most photons of a leaf.
const LEAF: usize = 8;

/// Deepest stack: halves of at most 2^30 photons.
const STACK: usize = 32;

/// A box, and the run of places that it holds; of an inner node the second child, too: the first follows its parent.
struct Node {
    bounds: Aabb,
    first: u32,
    count: u32,
    /// Zero of a leaf.
    second: u32,
}

/// The hierarchy.
pub(crate) struct Bvh {
    nodes: Vec<Node>,
}

impl Bvh {
    /// The search over some photons.
    pub(crate) fn build(photons: &[Photon]) -> Indexed<Self> {
        let positions = positions(photons);
        let mut ids: Vec<u32> = (0..photons.len() as u32).collect();
        let mut nodes = Vec::new();
        if !ids.is_empty() {
            divide(&mut nodes, &positions, &mut ids, 0);
        }
        Indexed::new(photons, (Self { nodes }, ids))
    }
}

/// Adds the node of `ids`, which begin at place `first`, and all below it.
fn divide(nodes: &mut Vec<Node>, positions: &[Vec3], ids: &mut [u32], first: u32) {
    let bounds = Aabb::around(ids.iter().map(|id| positions[*id as usize]));
    let node = nodes.len();
    nodes.push(Node { bounds, first, count: ids.len() as u32, second: 0 });
    if ids.len() <= LEAF {
        return;
    }
    let size = bounds.size();
    let axis = (0..3).fold(0, |longest, axis| if size[axis] > size[longest] { axis } else { longest });
    let middle = ids.len() / 2;
    ids.select_nth_unstable_by(middle, |a, b| {
        positions[*a as usize][axis].total_cmp(&positions[*b as usize][axis]).then(a.cmp(b))
    });
    let (below, above) = ids.split_at_mut(middle);
    divide(nodes, positions, below, first);
    nodes[node].second = nodes.len() as u32;
    divide(nodes, positions, above, first + middle as u32);
}

impl Index for Bvh {
    const NAME: &'static str = "bvh";

    fn search(&self, scan: &mut impl Scan) {
        let mut stack = [(0, 0.0); STACK];
        stack[0] = (0, scan.reach(&self.nodes[0].bounds));
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let (i, reach) = stack[top];
            if scan.is_out_of_reach(reach) {
                continue;
            }
            let node = &self.nodes[i];
            if node.second == 0 {
                scan.run(node.first as usize..(node.first + node.count) as usize);
                continue;
            }
            let children = [i + 1, node.second as usize];
            let [a, b] = children.map(|child| (child, scan.reach(&self.nodes[child].bounds)));
            // The nearer is taken first.
            (stack[top], stack[top + 1]) = if a.1 <= b.1 { (b, a) } else { (a, b) };
            top += 2;
        }
    }

    fn bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<Node>()
    }
}
