//! Sixteen rays that run together: what their tests need, by ray, and the beam that holds them all.
//!
//! A picture's rays and those that mirrors turn back start and run side by side. They visit the same nodes, so that a
//! node is read once for all of them (Wald, Slusallek, Benthin, Wagner, "Interactive Rendering with Coherent Ray
//! Tracing", 2001), and bounds of the packet leave out most boxes before any ray is tested (Reshetov, Soupikov, Hurley,
//! "Multi-Level Ray Tracing Algorithm", 2005).

use super::kernels::{Kernel, Reach};
use super::layout::WIDTH;
use crate::bounds::SLAB_SLACK;
use photinus_geometry::{Hit, Ray};

/// Rays of a packet.
pub const PACKET: usize = 16;

/// Directions, scaled to one along their dominant axis, may differ by so much: rays that spread more visit too much of
/// what only one of them needs.
const MOST_SPREAD: f32 = 0.25;
/// The same of their starts, as a share of the tree's largest extent.
const MOST_APART: f32 = 1.0 / 32.0;

/// A number for each ray.
pub type ByRay = [f32; PACKET];

/// Rays of one octant and one dominant axis.
#[repr(C, align(64))]
pub struct Packet {
    /// Starts, by axis.
    pub origin: [ByRay; 3],
    /// Reciprocal directions for entry parameters, by axis.
    pub near_inv: [ByRay; 3],
    /// The same for exit parameters.
    pub far_inv: [ByRay; 3],
    /// Shears of the ray-triangle test.
    pub shear: [ByRay; 2],
    /// Smallest accepted parameters.
    pub t_min: ByRay,
    /// Where the search ends: the end of the ray or its nearest hit; minus infinity where it has ended.
    pub t_max: ByRay,
    /// Reaches of what is left of the rays, lower ends.
    pub reach_low: ByRay,
    /// Upper ends.
    pub reach_high: ByRay,
    /// Nearest hits.
    pub best: [Hit; PACKET],
    /// Components of the directions along the third axis of the ray-triangle test.
    pub dir_z: ByRay,
    /// Axes of the ray-triangle test.
    pub axes: [usize; 3],
    /// Least and greatest shears, and starts by axis.
    pub bounds: PacketBounds,
    /// All rays together.
    pub beam: Beam,
}

/// Least and greatest of what tells whether rays run closely together.
#[derive(Clone, Copy)]
pub struct PacketBounds {
    shear: [[f32; 2]; 2],
    origin: [[f32; 2]; 3],
}

const NO_BOUNDS: PacketBounds = PacketBounds { shear: [[0.0; 2]; 2], origin: [[0.0; 2]; 3] };

impl PacketBounds {
    /// Whether rays of these bounds run closely enough together in a tree of this extent.
    #[inline(always)]
    fn are_close(&self, tree_size: f32) -> bool {
        let spread = self.shear.iter().all(|[low, high]| high - low <= MOST_SPREAD);
        spread & self.origin.iter().all(|[low, high]| high - low <= MOST_APART * tree_size)
    }

    #[inline(always)]
    fn union(mut self, other: &Self) -> Self {
        for (a, b) in self.shear.iter_mut().zip(&other.shear).chain(self.origin.iter_mut().zip(&other.origin)) {
            *a = [a[0].min(b[0]), a[1].max(b[1])];
        }
        self
    }
}

/// Bounds of a packet: no ray of it enters a box earlier, or leaves one later, than the beam.
#[derive(Clone, Copy)]
pub struct Beam {
    /// Places of the bounds that rays enter and leave through, and the octant, as in
    /// [`RaySetup`](super::ray_setup::RaySetup).
    pub near: [u32; 3],
    /// See `near`.
    pub far: [u32; 3],
    /// See `near`.
    pub octant: usize,
    /// Starts from which entry parameters are least, by axis.
    pub near_origin: [f32; 3],
    /// Starts from which exit parameters are greatest.
    pub far_origin: [f32; 3],
    /// Least and greatest reciprocal directions for entry parameters.
    pub near_inv: [[f32; 2]; 3],
    /// The same for exit parameters.
    pub far_inv: [[f32; 2]; 3],
    /// Smallest accepted parameter of any ray.
    pub t_min: f32,
    /// Where the search of the last ray ends.
    pub t_max: f32,
}

const NO_BEAM: Beam = Beam {
    near: [0; 3],
    far: [0; 3],
    octant: 0,
    near_origin: [0.0; 3],
    far_origin: [0.0; 3],
    near_inv: [[0.0; 2]; 3],
    far_inv: [[0.0; 2]; 3],
    t_min: 0.0,
    t_max: 0.0,
};

/// Slots of a node that a beam enters, and where.
pub struct BeamSlots {
    /// The slots.
    pub slots: [u32; WIDTH],
    /// Entry parameters, none greater than that of any ray.
    pub entries: [f32; WIDTH],
}

/// Whether the last of sixteen rays runs close to the first: most that do not run together are told apart there.
#[inline(always)]
pub fn are_alike(a: &Ray, b: &Ray) -> bool {
    (a.dir.x * b.dir.x > 0.0) & (a.dir.y * b.dir.y > 0.0) & (a.dir.z * b.dir.z > 0.0)
}

/// Whether a condition holds for all rays.
#[inline(always)]
fn all(holds: impl Fn(usize) -> bool) -> bool {
    let mut every = 0;
    for i in 0..PACKET {
        every |= u16::from(holds(i)) << i;
    }
    every == u16::MAX
}

impl Packet {
    /// Without rays.
    pub const IDLE: Self = Self {
        origin: [[0.0; PACKET]; 3],
        near_inv: [[0.0; PACKET]; 3],
        far_inv: [[0.0; PACKET]; 3],
        shear: [[0.0; PACKET]; 2],
        t_min: [0.0; PACKET],
        t_max: [0.0; PACKET],
        reach_low: [0.0; PACKET],
        reach_high: [0.0; PACKET],
        best: [Hit::MISS; PACKET],
        dir_z: [1.0; PACKET],
        axes: [0; 3],
        bounds: NO_BOUNDS,
        beam: NO_BEAM,
    };

    /// Takes up sixteen rays; false where they had better go alone: too far from each other, of several octants or
    /// dominant axes, along an axis, or with negative parameters. What [`super::ray_setup::RaySetup::set`] computes for each, to the bit.
    #[inline(always)]
    pub fn set<K: Kernel>(&mut self, kernel: K, rays: &[Ray; PACKET], tree_size: f32) -> bool {
        let mut dir = [[0.0; PACKET]; 3];
        for (i, ray) in rays.iter().enumerate() {
            for axis in 0..3 {
                self.origin[axis][i] = ray.origin[axis];
                dir[axis][i] = ray.dir[axis];
            }
            (self.t_min[i], self.t_max[i]) = (ray.t_min, ray.t_max);
        }
        let first = rays[0].dir.abs();
        let kz = if first.x > first.y && first.x > first.z { 0 } else { 1 + usize::from(first.z > first.y) };
        let (kx, ky) = ((kz + 1) % 3, (kz + 2) % 3);
        self.axes = [kx, ky, kz];
        let [x, y, z] = [&dir[kx], &dir[ky], &dir[kz]];
        if !all(|i| z[i].abs() > x[i].abs() && z[i].abs() > y[i].abs() && self.t_min[i] >= 0.0) {
            return false;
        }
        self.beam.octant = 0;
        for axis in 0..3 {
            let backward = dir[axis][0] < 0.0;
            let mut inv = [0.0; PACKET];
            for i in 0..PACKET {
                inv[i] = 1.0 / dir[axis][i];
                self.near_inv[axis][i] = inv[i] * (1.0 - SLAB_SLACK);
                self.far_inv[axis][i] = inv[i] * (1.0 + SLAB_SLACK);
            }
            let is_finite = all(|i| self.far_inv[axis][i].abs() < f32::INFINITY);
            let is_one_way = all(|i| (inv[i] < 0.0) == backward);
            self.bounds.origin[axis] = kernel.extremes(&self.origin[axis]);
            if !(is_finite && is_one_way) {
                return false;
            }
            self.beam.near[axis] = (2 * axis as u32 + u32::from(backward)) * WIDTH as u32;
            self.beam.far[axis] = (2 * axis as u32 + 1 - u32::from(backward)) * WIDTH as u32;
            self.beam.octant |= usize::from(backward) << axis;
        }
        for i in 0..PACKET {
            self.shear[0][i] = x[i] / z[i];
            self.shear[1][i] = y[i] / z[i];
        }
        let mut is_fit = all(|i| self.t_min[i] <= self.t_max[i]);
        self.bounds.shear = [kernel.extremes(&self.shear[0]), kernel.extremes(&self.shear[1])];
        is_fit &= self.bounds.are_close(tree_size);
        for axis in 0..3 {
            is_fit &= all(|i| self.origin[axis][i].abs() < f32::INFINITY && dir[axis][i].abs() < f32::INFINITY);
        }
        if !is_fit {
            return false;
        }
        self.dir_z = *z;
        self.best = [Hit::MISS; PACKET];
        for i in 0..PACKET {
            let reach = Reach::new(self.dir_z[i], self.t_min[i], self.t_max[i]);
            (self.reach_low[i], self.reach_high[i]) = (reach.low, reach.high);
        }
        self.set_beam(kernel);
        true
    }

    /// Ends the search of ray `i` at `t_max`.
    #[inline(always)]
    pub fn set_end(&mut self, i: usize, t_max: f32) {
        self.t_max[i] = t_max;
        let reach = Reach::new(self.dir_z[i], self.t_min[i], t_max);
        (self.reach_low[i], self.reach_high[i]) = (reach.low, reach.high);
    }

    /// Lets the beam end with its last ray.
    #[inline(always)]
    pub fn shorten_beam<K: Kernel>(&mut self, kernel: K) {
        [_, self.beam.t_max] = kernel.extremes(&self.t_max);
    }

    #[inline(always)]
    fn set_beam<K: Kernel>(&mut self, kernel: K) {
        for axis in 0..3 {
            let [low, high] = self.bounds.origin[axis];
            // Rounding is monotonic: what holds for the ends holds for all between, to the bit.
            let forward = self.beam.near[axis] < self.beam.far[axis];
            self.beam.near_origin[axis] = if forward { high } else { low };
            self.beam.far_origin[axis] = if forward { low } else { high };
            self.beam.near_inv[axis] = kernel.extremes(&self.near_inv[axis]);
            self.beam.far_inv[axis] = kernel.extremes(&self.far_inv[axis]);
        }
        [self.beam.t_min, _] = kernel.extremes(&self.t_min);
        self.shorten_beam(kernel);
    }
}

/// The beam of several packets; `None` where they had better go one by one.
#[inline(always)]
pub fn common_beam(packets: &[Packet], tree_size: f32) -> Option<Beam> {
    let (first, rest) = packets.split_first()?;
    let (mut beam, mut bounds) = (first.beam, first.bounds);
    for packet in rest {
        if packet.beam.octant != beam.octant || packet.axes != first.axes {
            return None;
        }
        bounds = bounds.union(&packet.bounds);
        for axis in 0..3 {
            let forward = beam.near[axis] < beam.far[axis];
            let later = |a: f32, b: f32| if forward { a.max(b) } else { a.min(b) };
            let sooner = |a: f32, b: f32| if forward { a.min(b) } else { a.max(b) };
            let outer = |a: [f32; 2], b: [f32; 2]| [a[0].min(b[0]), a[1].max(b[1])];
            beam.near_origin[axis] = later(beam.near_origin[axis], packet.beam.near_origin[axis]);
            beam.far_origin[axis] = sooner(beam.far_origin[axis], packet.beam.far_origin[axis]);
            beam.near_inv[axis] = outer(beam.near_inv[axis], packet.beam.near_inv[axis]);
            beam.far_inv[axis] = outer(beam.far_inv[axis], packet.beam.far_inv[axis]);
        }
        beam.t_min = beam.t_min.min(packet.beam.t_min);
        beam.t_max = beam.t_max.max(packet.beam.t_max);
    }
    bounds.are_close(tree_size).then_some(beam)
}
