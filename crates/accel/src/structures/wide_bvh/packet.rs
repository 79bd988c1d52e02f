//! Sixteen rays that run together: what their tests need, by ray, and the beam that holds them all.
//!
//! A picture's rays and those that mirrors turn back start and run side by side. They visit the same nodes, so that a
//! node is read once for all of them (Wald, Slusallek, Benthin, Wagner, "Interactive Rendering with Coherent Ray
//! Tracing", 2001), and bounds of the packet leave out most boxes before any ray is tested (Reshetov, Soupikov, Hurley,
//! "Multi-Level Ray Tracing Algorithm", 2005).

use super::beam::Beam;
use super::kernels::sixteen::Sixteen;
use super::kernels::{Kernel, Reach};
use super::layout::{Node, WIDTH};
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
    /// The least and the greatest of them.
    pub reach: [f32; 2],
    /// Parameters of the nearest hits; infinite where there is none.
    pub best_t: ByRay,
    /// Weights of their second vertices.
    pub best_alpha: ByRay,
    /// Weights of their third vertices.
    pub best_beta: ByRay,
    /// Bits of their primitive ids.
    pub best_prim: ByRay,
    /// Components of the directions along the third axis of the ray-triangle test.
    pub dir_z: ByRay,
    /// Axes of the ray-triangle test.
    pub axes: [usize; 3],
    /// The octant of the directions, as in [`RaySetup`](super::ray_setup::RaySetup).
    pub octant: usize,
    /// Least and greatest shears, and starts by axis.
    pub bounds: PacketBounds,
}

/// Least and greatest of what tells whether rays run closely together.
#[derive(Clone, Copy)]
pub struct PacketBounds {
    /// Least and greatest shears of the ray-triangle test.
    pub shear: [[f32; 2]; 2],
    /// Least and greatest starts, by axis.
    pub origin: [[f32; 2]; 3],
}

const NO_BOUNDS: PacketBounds = PacketBounds { shear: [[0.0; 2]; 2], origin: [[0.0; 2]; 3] };

impl PacketBounds {
    /// Whether rays of these bounds run closely enough together in a tree of this extent.
    #[inline(always)]
    pub fn are_close(&self, tree_size: f32) -> bool {
        let spread = self.shear.iter().all(|[low, high]| high - low <= MOST_SPREAD);
        spread & self.origin.iter().all(|[low, high]| high - low <= MOST_APART * tree_size)
    }

    /// Bounds of both.
    #[inline(always)]
    pub fn union(mut self, other: &Self) -> Self {
        for (a, b) in self.shear.iter_mut().zip(&other.shear).chain(self.origin.iter_mut().zip(&other.origin)) {
            *a = [a[0].min(b[0]), a[1].max(b[1])];
        }
        self
    }
}

/// Whether the last of sixteen rays runs close to the first: most that do not run together are told apart there.
#[inline(always)]
pub fn are_alike(a: &Ray, b: &Ray) -> bool {
    (a.dir.x * b.dir.x > 0.0) & (a.dir.y * b.dir.y > 0.0) & (a.dir.z * b.dir.z > 0.0)
}

impl Packet {
    /// Without rays.
    pub const IDLE: Self = Self {
        origin: [[0.0; PACKET]; 3],
        shear: [[0.0; PACKET]; 2],
        t_min: [0.0; PACKET],
        t_max: [0.0; PACKET],
        reach_low: [0.0; PACKET],
        reach_high: [0.0; PACKET],
        reach: [0.0; 2],
        best_t: [Hit::MISS.t; PACKET],
        best_alpha: [Hit::MISS.alpha; PACKET],
        best_beta: [Hit::MISS.beta; PACKET],
        best_prim: [f32::from_bits(Hit::MISS.prim); PACKET],
        dir_z: [1.0; PACKET],
        axes: [0; 3],
        octant: 0,
        bounds: NO_BOUNDS,
    };

    /// Takes up sixteen rays; false where they had better go alone: too far from each other, of several octants or
    /// dominant axes, along an axis, or with negative parameters. What [`super::ray_setup::RaySetup::set`] computes for each, to the bit.
    #[inline(always)]
    pub fn set<K: Kernel>(&mut self, kernel: K, rays: &[Ray; PACKET], tree_size: f32) -> bool {
        let [ox, oy, oz, t_min, dx, dy, dz, t_max] = kernel.components(rays);
        let (origin, dir, zeros) = ([ox, oy, oz], [dx, dy, dz], kernel.zeros());
        let first = rays[0].dir.abs();
        let kz = if first.x > first.y && first.x > first.z { 0 } else { 1 + usize::from(first.z > first.y) };
        let (kx, ky) = ((kz + 1) % 3, (kz + 2) % 3);
        self.axes = [kx, ky, kz];
        let [x, y, z] = [dir[kx], dir[ky], dir[kz]];
        let infinity = zeros.all(f32::INFINITY);
        let mut fit = x.abs().lt(z.abs()) & y.abs().lt(z.abs()) & zeros.le(t_min) & t_min.le(t_max);
        for k in 0..3 {
            // An axis along which a ray does not move is neither forward nor backward.
            let (forward, backward) = (zeros.lt(dir[k]), dir[k].lt(zeros));
            fit &= if backward & 1 == 1 { backward } else { forward };
            fit &= origin[k].abs().lt(infinity) & dir[k].abs().lt(infinity);
        }
        // Most rays that do not run together are told apart here, before more is spent on them.
        if fit != u16::MAX {
            return false;
        }
        let shear = [x / z, y / z];
        self.bounds.shear = [shear[0].extremes(), shear[1].extremes()];
        for k in 0..3 {
            self.bounds.origin[k] = extremes(origin[k], rays[0].origin[k]);
        }
        if !self.bounds.are_close(tree_size) {
            return false;
        }
        self.octant = (0..3).fold(0, |octant, k| octant | usize::from(rays[0].dir[k] < 0.0) << k);
        for k in 0..3 {
            origin[k].store(&mut self.origin[k]);
        }
        shear[0].store(&mut self.shear[0]);
        shear[1].store(&mut self.shear[1]);
        z.store(&mut self.dir_z);
        t_min.store(&mut self.t_min);
        t_max.store(&mut self.t_max);
        self.best_t = Self::IDLE.best_t;
        (self.best_alpha, self.best_beta) = (Self::IDLE.best_alpha, Self::IDLE.best_beta);
        self.best_prim = Self::IDLE.best_prim;
        let (low, high) = reach(kernel, t_min, t_max, z);
        low.store(&mut self.reach_low);
        high.store(&mut self.reach_high);
        self.reach = [extremes(low, self.reach_low[0])[0], extremes(high, self.reach_high[0])[1]];
        true
    }

    /// Rays that may enter the box in a slot of a node, as a mask.
    #[inline(always)]
    pub fn enter<K: Kernel>(&self, kernel: K, beam: &Beam, node: &Node, slot: usize) -> u16 {
        let zeros = kernel.zeros();
        let [kx, ky, kz] = self.axes.map(|k| k % 3);
        let one = zeros.all(beam.sign());
        let inv = [one / zeros.load(&self.shear[0]), one / zeros.load(&self.shear[1]), one];
        let (low, high) = (zeros.load(&self.reach_low), zeros.load(&self.reach_high));
        let (mut entry, mut exit) = if beam.is_forward { (low, high) } else { (zeros - high, zeros - low) };
        for (k, inv) in [kx, ky, kz].into_iter().zip(inv) {
            let at = |place: u32| zeros.all(node.bounds[place as usize / WIDTH % 6][slot % WIDTH]);
            let origin = zeros.load(&self.origin[k]);
            let near = (at(beam.near[k]) - origin) * (inv * zeros.all(1.0 - SLAB_SLACK));
            let far = (at(beam.far[k]) - origin) * (inv * zeros.all(1.0 + SLAB_SLACK));
            (entry, exit) = (near.max(entry), far.min(exit));
        }
        entry.le(exit)
    }

    /// The nearest hit of a ray.
    #[inline(always)]
    pub fn best(&self, i: usize) -> Hit {
        let prim = self.best_prim[i].to_bits();
        Hit { t: self.best_t[i], alpha: self.best_alpha[i], beta: self.best_beta[i], prim }
    }

    /// Takes up a nearer hit of a ray, whose search ends there or, where any hit will do, altogether.
    pub fn set_best(&mut self, i: usize, hit: Hit, is_end: bool) {
        (self.best_t[i], self.best_alpha[i], self.best_beta[i]) = (hit.t, hit.alpha, hit.beta);
        self.best_prim[i] = f32::from_bits(hit.prim);
        let reach = Reach::new(self.dir_z[i], self.t_min[i], hit.t);
        (self.t_max[i], self.reach_low[i], self.reach_high[i]) = match is_end {
            true => (f32::NEG_INFINITY, f32::INFINITY, f32::NEG_INFINITY),
            false => (hit.t, reach.low, reach.high),
        };
    }

    /// Lets the searches of the rays of a mask end at `t_max`.
    #[inline(always)]
    pub fn set_ends<K: Kernel>(&mut self, kernel: K, rays: u16, t_max: K::Sixteen) {
        let zeros = kernel.zeros();
        t_max.select(rays, zeros.load(&self.t_max)).store(&mut self.t_max);
        let (low, high) = reach(kernel, zeros.load(&self.t_min), t_max, zeros.load(&self.dir_z));
        low.select(rays, zeros.load(&self.reach_low)).store(&mut self.reach_low);
        high.select(rays, zeros.load(&self.reach_high)).store(&mut self.reach_high);
    }

    /// Ends the searches of the rays of a mask: nothing is within their reach.
    #[inline(always)]
    pub fn end<K: Kernel>(&mut self, kernel: K, rays: u16) {
        let zeros = kernel.zeros();
        let (high, low) = (zeros.all(f32::NEG_INFINITY), zeros.all(f32::INFINITY));
        high.select(rays, zeros.load(&self.t_max)).store(&mut self.t_max);
        low.select(rays, zeros.load(&self.reach_low)).store(&mut self.reach_low);
        high.select(rays, zeros.load(&self.reach_high)).store(&mut self.reach_high);
    }

    /// Lets the packet end with its last ray.
    #[inline(always)]
    pub fn shorten<K: Kernel>(&mut self, kernel: K) {
        let zeros = kernel.zeros();
        self.reach = [zeros.load(&self.reach_low).extremes()[0], zeros.load(&self.reach_high).extremes()[1]];
    }
}

/// The least and the greatest of all, of which `first` is one: most often they are all the same.
#[inline(always)]
fn extremes<S: Sixteen>(x: S, first: f32) -> [f32; 2] {
    let all = x.all(first);
    if x.le(all) & all.le(x) == u16::MAX { [first; 2] } else { x.extremes() }
}

/// What [`Reach`] says of each ray; all run the same way along the third axis, of which `z` are the
/// components.
#[inline(always)]
fn reach<K: Kernel>(kernel: K, t_min: K::Sixteen, t_max: K::Sixteen, z: K::Sixteen) -> (K::Sixteen, K::Sixteen) {
    let zeros = kernel.zeros();
    let (a, b) = (t_min * z, t_max * z);
    let (low, high) = if z.lt(zeros) == u16::MAX { (b, a) } else { (a, b) };
    let (slack, least) = (zeros.all(SLAB_SLACK), zeros.all(f32::MIN_POSITIVE));
    (low - (low.abs() * slack + least), high + (high.abs() * slack + least))
}
