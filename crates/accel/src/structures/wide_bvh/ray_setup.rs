//! What the kernels need of a ray, computed once.

use crate::bounds::SLAB_SLACK;
use photinus_geometry::{Aabb, Ray};
use photinus_intersect::RtiMethod;
use photinus_intersect::methods::woop::{Started, Woop};

/// A ray as the slab tests and the triangle filter use it.
#[derive(Clone, Copy, Debug)]
pub struct RaySetup {
    /// The shear of the ray-triangle test.
    pub woop: Started<f32>,
    /// Which of the bounds of each axis the ray enters through: an index into [`super::layout::Node::bounds`]; the
    /// other is this one with its lowest bit flipped.
    pub near_plane: [usize; 3],
    /// Start of the ray for entry parameters.
    pub near_origin: [f32; 3],
    /// Start of the ray for exit parameters.
    pub far_origin: [f32; 3],
    /// Reciprocal direction for entry parameters, a little small.
    pub near_inv: [f32; 3],
    /// Reciprocal direction for exit parameters, a little large.
    pub far_inv: [f32; 3],
    /// Smallest accepted parameter.
    pub t_min: f32,
}

impl RaySetup {
    /// Prepares `ray` for a tree of these bounds; `None` where it can hit nothing.
    ///
    /// An axis along which the ray does not move gets an infinite reciprocal: entry and exit parameters are infinite
    /// with the right signs, or not a number where the ray runs in a face of the box, and kernels leave such axes out.
    /// An axis along which it moves too slowly for a reciprocal gets NaN and is left out always.
    #[inline]
    pub fn new(ray: &Ray, tree_bounds: &Aabb) -> Option<Self> {
        if !(ray.t_min <= ray.t_max) {
            return None;
        }
        let woop = <Woop as RtiMethod<f32>>::start(ray.origin.to_array(), ray.dir.to_array())?;
        let mut setup = Self {
            woop,
            near_plane: [0; 3],
            near_origin: woop.origin,
            far_origin: woop.origin,
            near_inv: [0.0; 3],
            far_inv: [0.0; 3],
            t_min: ray.t_min,
        };
        for axis in 0..3 {
            let d = ray.dir[axis];
            let mut inv = 1.0 / d.abs();
            if inv.is_infinite() && d != 0.0 {
                inv = f32::NAN;
            }
            let inv = if d < 0.0 { -inv } else { inv };
            setup.near_plane[axis] = 2 * axis + usize::from(d < 0.0);
            setup.near_inv[axis] = inv * (1.0 - SLAB_SLACK);
            setup.far_inv[axis] = inv * (1.0 + SLAB_SLACK);
        }
        if ray.t_min < 0.0 {
            setup.widen_for_negative_parameters(tree_bounds);
        }
        Some(setup)
    }

    /// The reciprocals' slack narrows slabs where parameters are negative: behind the origin the slack is taken from
    /// the size of the tree instead.
    #[cold]
    fn widen_for_negative_parameters(&mut self, tree_bounds: &Aabb) {
        for axis in 0..3 {
            let o = self.woop.origin[axis];
            let reach = (tree_bounds.min[axis] - o).abs().max((tree_bounds.max[axis] - o).abs());
            let slack = 4.0 * SLAB_SLACK * reach;
            let forward = self.near_plane[axis] & 1 == 0;
            self.near_origin[axis] = if forward { o + slack } else { o - slack };
            self.far_origin[axis] = if forward { o - slack } else { o + slack };
        }
    }
}
