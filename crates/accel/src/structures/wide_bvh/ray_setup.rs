//! What the kernels need of a ray, computed once.

use super::layout::WIDTH;
use crate::bounds::SLAB_SLACK;
use photinus_geometry::{Aabb, Ray};
use photinus_intersect::RtiMethod;
use photinus_intersect::methods::woop::{Started, Woop};

/// A ray as the slab tests and the triangle filter use it.
#[derive(Clone, Copy, Debug)]
pub struct RaySetup {
    /// The shear of the ray-triangle test.
    pub woop: Started<f32>,
    /// Where the bounds that the ray enters through start for each axis, in floats from the start of
    /// [`super::layout::Node::bounds`].
    pub near: [u32; 3],
    /// The same for those that it leaves through.
    pub far: [u32; 3],
    /// The octant of the direction, as [`super::layout::Node::order`] counts them.
    pub octant: usize,
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
    /// Stands where there is no ray.
    pub const IDLE: Self = Self {
        woop: Started { origin: [0.0; 3], axes: [0, 1, 2], shear: [0.0; 2], dir_z: 1.0 },
        near: [0; 3],
        far: [0; 3],
        octant: 0,
        near_origin: [0.0; 3],
        far_origin: [0.0; 3],
        near_inv: [0.0; 3],
        far_inv: [0.0; 3],
        t_min: 0.0,
    };

    /// Prepares `ray` for a tree of these bounds; false where it can hit nothing.
    ///
    /// An axis along which the ray does not move gets an infinite reciprocal: entry and exit parameters are infinite
    /// with the right signs, or not a number where the ray runs in a face of the box, and kernels leave such axes out.
    /// An axis along which it moves too slowly for a reciprocal gets NaN and is left out always.
    #[inline(always)]
    pub fn set(&mut self, ray: &Ray, tree_bounds: &Aabb) -> bool {
        let woop = <Woop as RtiMethod<f32>>::start(ray.origin.to_array(), ray.dir.to_array());
        let (Some(woop), true) = (woop, ray.t_min <= ray.t_max) else { return false };
        self.woop = woop;
        self.near_origin = woop.origin;
        self.far_origin = woop.origin;
        self.t_min = ray.t_min;
        self.octant = 0;
        for axis in 0..3 {
            let d = ray.dir[axis];
            let inv = 1.0 / d;
            let inv = if inv.is_infinite() && d != 0.0 { f32::NAN } else { inv };
            let backward = u32::from(inv < 0.0);
            self.near[axis] = (2 * axis as u32 + backward) * WIDTH as u32;
            self.far[axis] = (2 * axis as u32 + 1 - backward) * WIDTH as u32;
            self.octant |= (backward as usize) << axis;
            self.near_inv[axis] = inv * (1.0 - SLAB_SLACK);
            self.far_inv[axis] = inv * (1.0 + SLAB_SLACK);
        }
        if ray.t_min < 0.0 {
            self.widen_for_negative_parameters(tree_bounds);
        }
        true
    }

    /// The reciprocals' slack narrows slabs where parameters are negative: behind the origin the slack is taken from
    /// the size of the tree instead.
    #[cold]
    fn widen_for_negative_parameters(&mut self, tree_bounds: &Aabb) {
        for axis in 0..3 {
            let o = self.woop.origin[axis];
            let reach = (tree_bounds.min[axis] - o).abs().max((tree_bounds.max[axis] - o).abs());
            let slack = 4.0 * SLAB_SLACK * reach;
            let forward = self.near[axis] < self.far[axis];
            self.near_origin[axis] = if forward { o + slack } else { o - slack };
            self.far_origin[axis] = if forward { o - slack } else { o + slack };
        }
    }
}
