//! The primitives while a tree is built over them, and the tree before it is laid out in memory.

use crate::bounds::padded_bounds;
use photinus_geometry::{Aabb, Primitives};
use rayon::prelude::*;

/// Subtrees of fewer references are built by one thread.
pub(crate) const PARALLEL_REFS: usize = 4096;

/// A primitive, or the part of one that a subtree answers for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BuildRef {
    /// Bounds of the part, padded as [`crate::bounds::pad`] pads the whole.
    pub bounds: Aabb,
    /// Primitive id.
    pub id: u32,
}

impl BuildRef {
    /// The middle of the bounds along an axis.
    pub fn centroid(&self, axis: usize) -> f32 {
        self.bounds.min[axis] * 0.5 + self.bounds.max[axis] * 0.5
    }
}

/// The hittable primitives, by id.
pub(crate) fn gather(primitives: &Primitives) -> Vec<BuildRef> {
    (0..primitives.len())
        .into_par_iter()
        .with_min_len(1024)
        .filter_map(|id| padded_bounds(primitives, id).map(|bounds| BuildRef { bounds, id: id as u32 }))
        .collect()
}

/// The bounds of all of them.
pub(crate) fn bounds_of(refs: &[BuildRef]) -> Aabb {
    refs.iter().fold(Aabb::EMPTY, |b, r| b.union(r.bounds))
}

/// A subtree.
pub(crate) struct Built<V> {
    /// Bounds everything below.
    pub volume: V,
    /// What is below.
    pub kind: BuiltKind<V>,
}

/// What a subtree consists of.
pub(crate) enum BuiltKind<V> {
    /// Ids of primitives, ascending; at least one.
    Leaf(Vec<u32>),
    /// Children, at least two; of two, the axis along which the first lies below.
    Inner {
        /// 0 to 2.
        axis: usize,
        /// The subtrees.
        children: Vec<Built<V>>,
    },
}

impl<V> Built<V> {
    /// A leaf over these references.
    pub fn leaf(volume: V, refs: &[BuildRef]) -> Self {
        let mut ids: Vec<u32> = refs.iter().map(|r| r.id).collect();
        ids.sort_unstable();
        Self { volume, kind: BuiltKind::Leaf(ids) }
    }
}

/// Moves the references for which `is_first` holds to the front and returns how many they are.
pub(crate) fn partition(refs: &mut [BuildRef], is_first: impl Fn(&BuildRef) -> bool) -> usize {
    let (mut i, mut j) = (0, refs.len());
    loop {
        while i < j && is_first(&refs[i]) {
            i += 1;
        }
        while i < j && !is_first(&refs[j - 1]) {
            j -= 1;
        }
        if i == j {
            return i;
        }
        refs.swap(i, j - 1);
    }
}
