//! An R-tree (Guttman, "R-Trees: A Dynamic Index Structure for Spatial Searching", SIGMOD 1984), loaded at once by tiles:
//! Leutenegger, Lopez, Edgington, "STR: A Simple and Efficient Algorithm for R-Tree Packing", ICDE 1997.

use crate::Photon;
use crate::index::{Index, Indexed, Scan};
use crate::store::positions;
use photinus_geometry::{Aabb, Vec3};

pub(crate) const ABOUT: &str = "R-tree of sixteen entries a node, loaded by tiles";

/// Entries of a node: children, or photons of a leaf.
const FAN_OUT: usize = 16;

/// An entry: a bounding box, and what lies in it: entries `first..first + count` of the level below, or photons.
#[derive(Clone, Copy)]
struct Entry {
    bounds: Aabb,
    first: u32,
    count: u32,
}

/// The tree, level by level: of the lowest the entries are leaves.
pub(crate) struct RTree {
    levels: Vec<Vec<Entry>>,
}

impl RTree {
    /// The search over some photons.
    pub(crate) fn build(photons: &[Photon]) -> Indexed<Self> {
        let positions = positions(photons);
        let mut ids: Vec<u32> = (0..photons.len() as u32).collect();
        tile(&mut ids, &|id| positions[id as usize]);
        let bounds = |ids: &[u32]| Aabb::around(ids.iter().map(|id| positions[*id as usize]));
        let mut levels = vec![pack(&ids, bounds)];
        while let Some(last) = levels.last()
            && last.len() > FAN_OUT
        {
            // Entries of a level are put into order as photons are; those of the level below keep theirs.
            let mut order: Vec<u32> = (0..last.len() as u32).collect();
            tile(&mut order, &|i| last[i as usize].bounds.center());
            let last: Vec<Entry> = order.iter().map(|i| last[*i as usize]).collect();
            let next = pack(&last, |entries| entries.iter().fold(Aabb::EMPTY, |b, e| b.union(e.bounds)));
            let level = levels.len() - 1;
            levels[level] = last;
            levels.push(next);
        }
        Indexed::new(photons, (Self { levels }, ids))
    }
}

/// Sorts into tiles: slabs by x, columns of a slab by y, runs of a column by z, so that each run of [`FAN_OUT`] is a tile.
fn tile(items: &mut [u32], at: &impl Fn(u32) -> Vec3) {
    let tiles = items.len().div_ceil(FAN_OUT);
    let side = libm::cbrt(tiles as f64).ceil().max(1.0) as usize;
    let by = |items: &mut [u32], axis: usize| {
        items.sort_unstable_by(|a, b| at(*a)[axis].total_cmp(&at(*b)[axis]).then(a.cmp(b)));
    };
    by(items, 0);
    for slab in items.chunks_mut((side * side * FAN_OUT).max(1)) {
        by(slab, 1);
        for column in slab.chunks_mut(side * FAN_OUT) {
            by(column, 2);
        }
    }
}

/// An entry for each [`FAN_OUT`] items.
fn pack<T>(items: &[T], bounds: impl Fn(&[T]) -> Aabb) -> Vec<Entry> {
    let entry = |(i, items): (usize, &[T])| Entry {
        bounds: bounds(items),
        first: (i * FAN_OUT) as u32,
        count: items.len() as u32,
    };
    items.chunks(FAN_OUT).enumerate().map(entry).collect()
}

/// A node's entries that are not out of reach, from far to near.
struct Order {
    entries: [(f32, usize); FAN_OUT],
    len: usize,
}

impl Order {
    #[inline]
    fn new(entries: &[Entry], first: usize, scan: &impl Scan) -> Self {
        let mut out = Self { entries: [(0.0, 0); FAN_OUT], len: 0 };
        for (i, entry) in entries.iter().enumerate() {
            let reach = scan.reach(&entry.bounds);
            if !scan.is_out_of_reach(reach) {
                out.entries[out.len] = (reach, first + i);
                out.len += 1;
            }
        }
        out.entries[..out.len].sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
        out
    }
}

impl RTree {
    /// Searches entries `first..first + count` of a level.
    fn visit(&self, level: usize, first: usize, count: usize, scan: &mut impl Scan) {
        let order = Order::new(&self.levels[level][first..first + count], first, scan);
        for (reach, i) in order.entries[..order.len].iter().rev() {
            if scan.is_out_of_reach(*reach) {
                return;
            }
            let entry = self.levels[level][*i];
            let (first, count) = (entry.first as usize, entry.count as usize);
            match level.checked_sub(1) {
                Some(below) => self.visit(below, first, count, scan),
                None => scan.run(first..first + count),
            }
        }
    }
}

impl Index for RTree {
    const NAME: &'static str = "r-tree";

    fn search(&self, scan: &mut impl Scan) {
        let top = self.levels.len() - 1;
        self.visit(top, 0, self.levels[top].len(), scan);
    }

    fn bytes(&self) -> usize {
        self.levels.iter().map(|level| level.capacity() * size_of::<Entry>()).sum()
    }
}
