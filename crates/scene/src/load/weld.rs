//! Vertices at equal positions made one.

use photinus_geometry::Vec3;
use std::collections::HashMap;

/// Distinct positions and which of them each vertex has.
pub(super) struct Welded {
    /// For every vertex the number of its position.
    pub(super) ids: Vec<u32>,
    /// The positions, in the order of their first vertex.
    pub(super) positions: Vec<Vec3>,
}

/// Gives equal positions equal numbers; -0 equals 0.
pub(super) fn weld(positions: &[Vec3]) -> Welded {
    let mut seen: HashMap<[u32; 3], u32> = HashMap::with_capacity(positions.len());
    let mut distinct = Vec::new();
    let ids = positions
        .iter()
        .map(|p| {
            let key = p.to_array().map(|x| (x + 0.0).to_bits());
            *seen.entry(key).or_insert_with(|| {
                distinct.push(*p);
                (distinct.len() - 1) as u32
            })
        })
        .collect();
    Welded { ids, positions: distinct }
}
