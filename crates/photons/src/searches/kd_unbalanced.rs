//! The kd-tree that photons grow one after the other, as they come: Bentley, "Multidimensional Binary Search Trees Used
//! for Associative Searching", CACM 18(9), 1975; what is left of Jensen's tree (2001, chapter 6) without its balancing.
//!
//! A node is a photon; those that come later go below it or above it along x, y, z in turns. The tree is written in
//! preorder. Below [`MOST_LEVELS`] levels photons are kept as a list: many at one place would make it as deep as they are
//! many.

use crate::Photon;
use crate::index::{Index, Indexed, Scan};
use crate::space::cut;
use crate::store::positions;
use photinus_geometry::Aabb;

pub(crate) const ABOUT: &str = "kd-tree as photons arrive, unbalanced";

/// Levels of nodes.
const MOST_LEVELS: usize = 64;

/// The tree.
pub(crate) struct KdUnbalanced {
    bounds: Aabb,
    /// By node: where its photons above begin; those below follow it.
    above: Vec<u32>,
    /// By node: where its plane stands.
    planes: Vec<f32>,
}

/// A part of the tree under search.
#[derive(Clone, Copy)]
struct Part {
    first: usize,
    end: usize,
    level: usize,
    bounds: Aabb,
}

impl KdUnbalanced {
    /// The search over some photons.
    pub(crate) fn build(photons: &[Photon]) -> Indexed<Self> {
        let positions = positions(photons);
        let mut ids: Vec<u32> = (0..photons.len() as u32).collect();
        let mut tree = Self {
            bounds: Aabb::around(positions.iter().copied()),
            above: vec![0; ids.len()],
            planes: vec![0.0; ids.len()],
        };
        let mut moved = Vec::new();
        let mut stack = vec![(0, ids.len(), 0)];
        while let Some((first, end, level)) = stack.pop() {
            if end - first <= 1 || level == MOST_LEVELS {
                continue;
            }
            // The first that came is the node; the others keep their order on either side, as if they came one by one.
            let (node, rest) = ids[first..end].split_first_mut().expect("two at least");
            let axis = level % 3;
            let plane = positions[*node as usize][axis];
            moved.clear();
            let mut below = 0;
            for i in 0..rest.len() {
                if positions[rest[i] as usize][axis] < plane {
                    rest[below] = rest[i];
                    below += 1;
                } else {
                    moved.push(rest[i]);
                }
            }
            rest[below..].copy_from_slice(&moved);
            let above = first + 1 + below;
            (tree.above[first], tree.planes[first]) = (above as u32, plane);
            stack.push((first + 1, above, level + 1));
            stack.push((above, end, level + 1));
        }
        Indexed::new(photons, (tree, ids))
    }
}

impl Index for KdUnbalanced {
    const NAME: &'static str = "kd-unbalanced";

    fn search(&self, scan: &mut impl Scan) {
        let mut stack = Vec::with_capacity(MOST_LEVELS + 1);
        let root = Part { first: 0, end: self.planes.len(), level: 0, bounds: self.bounds };
        stack.push((root, scan.reach(&root.bounds)));
        while let Some((part, reach)) = stack.pop() {
            let Part { first, end, level, bounds } = part;
            if first == end || scan.is_out_of_reach(reach) {
                continue;
            }
            if end - first == 1 || level == MOST_LEVELS {
                scan.run(first..end);
                continue;
            }
            let (axis, plane, middle) = (level % 3, self.planes[first], self.above[first] as usize);
            let [below, above] = cut(bounds, axis, plane);
            let below = Part { first: first + 1, end: middle, level: level + 1, bounds: below };
            let above = Part { first: middle, end, level: level + 1, bounds: above };
            scan.run(first..first + 1);
            let is_below = scan.middle()[axis] < plane;
            for part in if is_below { [above, below] } else { [below, above] } {
                stack.push((part, scan.reach(&part.bounds)));
            }
        }
    }

    fn bytes(&self) -> usize {
        self.above.capacity() * size_of::<u32>() + self.planes.capacity() * size_of::<f32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use photinus_geometry::Vec3;

    #[test]
    fn the_tree_is_that_of_insertions() {
        let photon = |x: f32, y: f32| Photon::new(Vec3::new(x, y, 0.0), Vec3::ONE, Vec3::Z, Vec3::Z, 1, false).unwrap();
        // 5 is the root; 2 and 3 come below, 9 and 5 above it; 3 goes above 2 along y.
        let photons = [photon(5.0, 1.0), photon(2.0, 4.0), photon(9.0, 0.0), photon(3.0, 6.0), photon(5.0, 2.0)];
        let search = KdUnbalanced::build(&photons);
        let tree = search.index();
        assert_eq!(tree.above, [3, 2, 0, 4, 0]);
        assert_eq!(tree.planes[..2], [5.0, 4.0]);
    }
}
