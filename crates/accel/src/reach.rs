//! How far along its dominant axis a ray may still hit: what triangle filters leave out what is out of reach with.

use crate::bounds::SLAB_SLACK;

/// What is left of a ray's interval, along its dominant axis from its start, a little widened: triangles all below
/// `low` or all above `high` are out of reach. Weights of vertices are never negative, so t is never outside of what
/// the vertices span.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// The lower end.
    pub low: f32,
    /// The upper end.
    pub high: f32,
}

impl Reach {
    /// The reach of parameters from `t_min` to `t_max`.
    #[inline(always)]
    pub fn new(dir_z: f32, t_min: f32, t_max: f32) -> Self {
        let (a, b) = (t_min * dir_z, t_max * dir_z);
        let (low, high) = if dir_z < 0.0 { (b, a) } else { (a, b) };
        // The smallest normal number covers products that round in the last places there are.
        let slack = |x: f32| x.abs() * SLAB_SLACK + f32::MIN_POSITIVE;
        Self { low: low - slack(low), high: high + slack(high) }
    }
}
