//! An octree over photons: a cube around all, divided into eight where it holds many, and so on (Glassner, "Space
//! Subdivision for Fast Ray Tracing", IEEE CG&A 4(10), 1984, of points instead of triangles).

use crate::Photon;
use crate::index::{Index, Indexed, Scan};
use crate::store::positions;
use photinus_geometry::{Aabb, Vec3};

pub(crate) const ABOUT: &str = "octree, leaves of sixteen photons";

/// Most photons of a leaf above the last level.
const LEAF: usize = 16;
/// Levels of cubes; those below are leaves, however many photons lie in them.
const MOST_LEVELS: usize = 24;

/// A cube that holds photons: their places, and its children, which lie together by octant; empty octants have none.
#[derive(Clone, Copy)]
struct Node {
    first: u32,
    end: u32,
    children: u32,
    /// A bit for each octant with a child; none of a leaf.
    octants: u8,
}

/// The octree.
pub(crate) struct Octree {
    cube: Aabb,
    nodes: Vec<Node>,
}

impl Octree {
    /// The search over some photons.
    pub(crate) fn build(photons: &[Photon]) -> Indexed<Self> {
        let positions = positions(photons);
        let mut ids: Vec<u32> = (0..photons.len() as u32).collect();
        let bounds = Aabb::around(positions.iter().copied());
        let cube = Aabb { min: bounds.min, max: bounds.max.max(bounds.min + Vec3::splat(bounds.size().max_element())) };
        let mut nodes = vec![Node { first: 0, end: ids.len() as u32, children: 0, octants: 0 }];
        let mut moved = Vec::new();
        let mut stack = vec![(0, cube, 0)];
        while let Some((i, cube, level)) = stack.pop() {
            let Node { first, end, .. } = nodes[i];
            let (first, end) = (first as usize, end as usize);
            if end - first <= LEAF || level == MOST_LEVELS {
                continue;
            }
            let middle = cube.center();
            let octant_of = |id: u32| octant(positions[id as usize], middle);
            // Sorted by octant, in one pass each way.
            let mut counts = [0; 9];
            for id in &ids[first..end] {
                counts[octant_of(*id) + 1] += 1;
            }
            for k in 0..8 {
                counts[k + 1] += counts[k];
            }
            let starts = counts;
            moved.clear();
            moved.extend_from_slice(&ids[first..end]);
            for id in &moved {
                let next = &mut counts[octant_of(*id)];
                ids[first + *next] = *id;
                *next += 1;
            }
            nodes[i].children = nodes.len() as u32;
            for k in (0..8).filter(|k| starts[*k] < starts[*k + 1]) {
                nodes[i].octants |= 1 << k;
                stack.push((nodes.len(), part(&cube, middle, k), level + 1));
                let (first, end) = ((first + starts[k]) as u32, (first + starts[k + 1]) as u32);
                nodes.push(Node { first, end, children: 0, octants: 0 });
            }
        }
        Indexed::new(photons, (Self { cube, nodes }, ids))
    }
}

/// The octant of a point: a bit for each axis along which it lies above the middle, x in the lowest.
#[inline]
fn octant(p: Vec3, middle: Vec3) -> usize {
    p.cmpge(middle).bitmask() as usize
}

/// A cube's part in an octant.
#[inline]
fn part(cube: &Aabb, middle: Vec3, octant: usize) -> Aabb {
    let mut out = *cube;
    for axis in 0..3 {
        if octant >> axis & 1 == 1 {
            out.min[axis] = middle[axis];
        } else {
            out.max[axis] = middle[axis];
        }
    }
    out
}

impl Index for Octree {
    const NAME: &'static str = "octree";

    fn search(&self, scan: &mut impl Scan) {
        let mut stack = Vec::with_capacity(8 * MOST_LEVELS);
        stack.push((0, self.cube, scan.reach(&self.cube)));
        while let Some((i, cube, reach)) = stack.pop() {
            if scan.is_out_of_reach(reach) {
                continue;
            }
            let node = self.nodes[i];
            if node.octants == 0 {
                scan.run(node.first as usize..node.end as usize);
                continue;
            }
            let middle = cube.center();
            let nearest = octant(scan.middle(), middle);
            // From the octant across to that of the query's middle.
            for k in (0..8).map(|k| k ^ nearest ^ 7).filter(|k| node.octants >> k & 1 == 1) {
                let before = (node.octants & ((1 << k) - 1)).count_ones();
                let part = part(&cube, middle, k);
                stack.push(((node.children + before) as usize, part, scan.reach(&part)));
            }
        }
    }

    fn bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<Node>()
    }
}
