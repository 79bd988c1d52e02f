//! Which primitives a structure was built over, so that it is fitted to the same ones elsewhere and to no others.

use crate::bounds::padded_bounds;
use crate::structure::RefitError;
use photinus_geometry::{Aabb, Primitives};
use rayon::prelude::*;

/// Counts and indices of primitives, whatever their places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shape {
    triangles: usize,
    spheres: usize,
    /// Vertices that the indices reach.
    vertices: usize,
    /// Hash of the indices: FNV-1a over words.
    indices: u64,
}

impl Shape {
    /// The shape of some primitives.
    pub fn of(primitives: &Primitives) -> Self {
        let (mut vertices, mut indices) = (0, 0xcbf2_9ce4_8422_2325_u64);
        for index in primitives.triangles.iter().flatten() {
            vertices = vertices.max(*index as usize + 1);
            indices = (indices ^ u64::from(*index)).wrapping_mul(0x100_0000_01b3);
        }
        Self { triangles: primitives.triangle_count(), spheres: primitives.spheres.len(), vertices, indices }
    }

    /// Padded bounds by id of primitives that moved, empty where one cannot be hit; `held` are the ids that the
    /// structure's leaves hold.
    ///
    /// # Errors
    /// [`RefitError::OtherPrimitives`] where they are of another shape, or where one that the structure left out
    /// because nothing could hit it can be hit now.
    pub fn moved(
        &self,
        primitives: &Primitives,
        held: &[u32],
        structure: &'static str,
    ) -> Result<Vec<Aabb>, RefitError> {
        let other = || RefitError::OtherPrimitives { structure };
        if Self::of(primitives) != *self || primitives.positions.len() < self.vertices {
            return Err(other());
        }
        let bounds: Vec<Aabb> = (0..primitives.len())
            .into_par_iter()
            .with_min_len(1024)
            .map(|id| padded_bounds(primitives, id).unwrap_or(Aabb::EMPTY))
            .collect();
        let mut is_held = vec![false; bounds.len()];
        held.iter().for_each(|id| is_held[*id as usize] = true);
        let lost = bounds.iter().zip(&is_held).any(|(b, held)| !held && !b.is_empty());
        if lost { Err(other()) } else { Ok(bounds) }
    }
}
