//! A kd-tree whose planes stand where a search is expected to cost least: Wald, Guenther, Slusallek, "Balancing
//! Considered Harmful: Faster Photon Mapping using the Voxel Volume Heuristic", Computer Graphics Forum 23(3), 2004.
//!
//! A ball of radius r whose middle is anywhere reaches a cell with a chance that goes with the volume of the cell grown by r
//! on all sides; planes are chosen among bins, and a cell is a leaf where testing its photons is cheaper than a plane.

use crate::Photon;
use crate::index::{Index, Indexed, Scan};
use crate::space::{cut, usual_radius};
use crate::store::positions;
use photinus_geometry::{Aabb, Vec3};

pub(crate) const ABOUT: &str = "kd-tree by the voxel volume heuristic, photons in leaves";

/// Places for planes along each axis.
const BINS: usize = 32;
/// What visiting a node costs, in tests of a photon.
const NODE_COST: f32 = 2.0;
/// Levels of nodes; cells below are leaves.
const MOST_LEVELS: usize = 48;

/// A node: a plane and where the node above it stands, or the places of a leaf.
#[derive(Clone, Copy)]
enum Node {
    Plane { axis: u8, plane: f32, above: u32 },
    Leaf { first: u32, end: u32 },
}

/// The tree; the node below a plane follows it.
pub(crate) struct KdVvh {
    bounds: Aabb,
    nodes: Vec<Node>,
}

impl KdVvh {
    /// The search over some photons, for balls of about this radius; by default of the size that holds some dozens.
    pub(crate) fn build(photons: &[Photon], radius: Option<f32>) -> Indexed<Self> {
        let positions = positions(photons);
        let mut ids: Vec<u32> = (0..photons.len() as u32).collect();
        let bounds = Aabb::around(positions.iter().copied());
        let radius = radius.unwrap_or_else(|| usual_radius(&bounds, ids.len()));
        let mut maker = Maker { positions: &positions, radius, nodes: Vec::new(), moved: Vec::new() };
        maker.divide(&mut ids, bounds, 0, 0);
        Indexed::new(photons, (Self { bounds, nodes: maker.nodes }, ids))
    }
}

/// What building a tree needs.
struct Maker<'a> {
    positions: &'a [Vec3],
    radius: f32,
    nodes: Vec<Node>,
    /// Photons above a plane, while a cell is divided.
    moved: Vec<u32>,
}

impl Maker<'_> {
    /// Adds the node of `ids`, which begin at place `first` and lie in `bounds`, and all below it.
    fn divide(&mut self, ids: &mut [u32], bounds: Aabb, first: u32, level: usize) {
        let Some((axis, plane)) = self.plane(ids, &bounds).filter(|_| level < MOST_LEVELS) else {
            self.nodes.push(Node::Leaf { first, end: first + ids.len() as u32 });
            return;
        };
        // Photons keep their order on either side.
        self.moved.clear();
        let mut middle = 0;
        for i in 0..ids.len() {
            if self.positions[ids[i] as usize][axis] < plane {
                ids[middle] = ids[i];
                middle += 1;
            } else {
                self.moved.push(ids[i]);
            }
        }
        ids[middle..].copy_from_slice(&self.moved);
        let node = self.nodes.len();
        self.nodes.push(Node::Plane { axis: axis as u8, plane, above: 0 });
        let (below, above) = ids.split_at_mut(middle);
        let [bounds_below, bounds_above] = cut(bounds, axis, plane);
        self.divide(below, bounds_below, first, level + 1);
        let next = self.nodes.len() as u32;
        self.nodes[node] = Node::Plane { axis: axis as u8, plane, above: next };
        self.divide(above, bounds_above, first + middle as u32, level + 1);
    }

    /// The best plane; `None` where a leaf is better.
    fn plane(&self, ids: &[u32], bounds: &Aabb) -> Option<(usize, f32)> {
        let size = bounds.size();
        // In units of the radius: no volume overflows where photons lie 1e18 apart.
        let grown = (size / self.radius + 2.0).min(Vec3::splat(1e9));
        let mut best = (ids.len() as f32, None);
        for axis in 0..3 {
            let scale = BINS as f32 / size[axis];
            if !(scale > 0.0 && scale.is_finite()) {
                continue;
            }
            let mut counts = [0; BINS];
            for id in ids {
                let bin = (self.positions[*id as usize][axis] - bounds.min[axis]) * scale;
                counts[(bin as usize).min(BINS - 1)] += 1;
            }
            let mut below = 0;
            for (i, count) in counts.iter().enumerate().take(BINS - 1) {
                below += count;
                let above = ids.len() - below;
                let share = |bins: usize| (grown[axis] - 2.0) * (bins as f32 / BINS as f32) + 2.0;
                let cost = share(i + 1) * below as f32 + share(BINS - 1 - i) * above as f32;
                let cost = NODE_COST + cost / grown[axis];
                let plane = bounds.min[axis] + size[axis] * ((i + 1) as f32 / BINS as f32);
                // A plane that rounds to the side of its cell divides nothing.
                if cost < best.0 && bounds.min[axis] < plane && plane < bounds.max[axis] {
                    best = (cost, Some((axis, plane)));
                }
            }
        }
        best.1
    }
}

impl Index for KdVvh {
    const NAME: &'static str = "kd-vvh";

    fn search(&self, scan: &mut impl Scan) {
        let mut stack = Vec::with_capacity(MOST_LEVELS + 1);
        stack.push((0, self.bounds, scan.reach(&self.bounds)));
        while let Some((i, bounds, reach)) = stack.pop() {
            if scan.is_out_of_reach(reach) {
                continue;
            }
            match self.nodes[i] {
                Node::Leaf { first, end } => scan.run(first as usize..end as usize),
                Node::Plane { axis, plane, above } => {
                    let axis = usize::from(axis);
                    let [bounds_below, bounds_above] = cut(bounds, axis, plane);
                    let below = (i + 1, bounds_below, scan.reach(&bounds_below));
                    let above = (above as usize, bounds_above, scan.reach(&bounds_above));
                    let is_below = scan.middle()[axis] < plane;
                    stack.extend(if is_below { [above, below] } else { [below, above] });
                }
            }
        }
    }

    fn bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<Node>()
    }
}
