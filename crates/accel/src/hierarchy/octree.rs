//! The division of the thesis's bounding volume hierarchy (section 3.1.2): voxels halved along all axes until few
//! primitives are left, each with a volume around what lies inside of it, not around the voxel.
//!
//! Voxels of which one part alone holds something are passed over. Memory and time stay bounded on any input: no tree
//! has more than [`MAX_DEPTH`] levels or more references than its limit, and voxels whose parts all hold all that they
//! hold are leaves.

use super::clip::{Cell, Clipper};
use super::refs::{BuildRef, Built, BuiltKind, PARALLEL_REFS, bounds_of, gather};
use super::rule::reference_budget;
use super::volume::Fit;
use photinus_geometry::Primitives;
use rayon::prelude::*;

/// Most levels below the root.
pub(crate) const MAX_DEPTH: usize = 24;
/// Places that a walk needs.
pub(crate) const STACK: usize = 7 * MAX_DEPTH + 1;

struct Division<'a> {
    primitives: &'a Primitives,
    leaf_size: usize,
}

/// What lies in a voxel.
struct Voxel<V> {
    cell: Cell,
    /// Primitives that reach into it, ascending.
    ids: Vec<u32>,
    volume: V,
}

/// Builds the tree, of at most `limit` references for each primitive; `None` where none can be hit.
pub(crate) fn build<V: Fit>(primitives: &Primitives, leaf_size: usize, limit: f64) -> Option<Built<V>> {
    let refs: Vec<BuildRef> = gather(primitives);
    let division = Division { primitives, leaf_size };
    let ids: Vec<u32> = refs.iter().map(|r| r.id).collect();
    let root = division.voxel(&ids, Cell::of(&bounds_of(&refs)))?;
    let budget = reference_budget(ids.len(), limit);
    Some(division.node(root, 0, budget))
}

impl Division<'_> {
    /// What of some primitives lies in a cell; `None` where nothing does.
    fn voxel<V: Fit>(&self, ids: &[u32], cell: Cell) -> Option<Voxel<V>> {
        let (mut clipper, mut points) = (Clipper::default(), Vec::new());
        let reaches = |id: &u32| clipper.part(self.primitives, *id as usize, &cell, &mut points);
        let ids: Vec<u32> = ids.iter().copied().filter(reaches).collect();
        (!ids.is_empty()).then(|| Voxel { cell, ids, volume: V::fit(&points) })
    }

    /// The occupied parts of a voxel: several, or none where they would not help.
    fn parts<V: Fit>(&self, voxel: &Voxel<V>) -> Vec<Voxel<V>> {
        let count = voxel.ids.len();
        let mut cell = voxel.cell;
        loop {
            let can_halve = (0..3).any(|k| {
                let middle = f64::midpoint(cell.low[k], cell.high[k]);
                cell.low[k] < middle && middle < cell.high[k]
            });
            if !can_halve {
                return Vec::new();
            }
            let part = |octant: usize| self.voxel(&voxel.ids, cell.octant(octant));
            let parts: Vec<Voxel<V>> = if count >= PARALLEL_REFS {
                (0..8).into_par_iter().filter_map(part).collect()
            } else {
                (0..8).filter_map(part).collect()
            };
            match &parts[..] {
                [only] => cell = only.cell,
                several if several.iter().all(|p| p.ids.len() == count) => return Vec::new(),
                _ => return parts,
            }
        }
    }

    /// The subtree of a voxel, of no more than `budget` references.
    fn node<V: Fit>(&self, voxel: Voxel<V>, depth: usize, budget: usize) -> Built<V> {
        let wanted = voxel.ids.len() > self.leaf_size && depth < MAX_DEPTH;
        let parts = if wanted { self.parts(&voxel) } else { Vec::new() };
        let total: usize = parts.iter().map(|p| p.ids.len()).sum();
        if parts.is_empty() || total > budget {
            return Built { volume: voxel.volume, kind: BuiltKind::Leaf(voxel.ids) };
        }
        // Shares of the budget do not depend on the order in which subtrees are built.
        let child = |part: Voxel<V>| {
            let own = part.ids.len();
            self.node(part, depth + 1, own + (budget - total) * own / total)
        };
        let children = if voxel.ids.len() >= PARALLEL_REFS {
            parts.into_par_iter().map(child).collect()
        } else {
            parts.into_iter().map(child).collect()
        };
        Built { volume: voxel.volume, kind: BuiltKind::Inner { axis: 0, children } }
    }
}
