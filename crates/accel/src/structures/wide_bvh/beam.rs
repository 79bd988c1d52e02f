//! The beam that holds all rays of packets that walk together: what their visits of nodes are decided by.
//!
//! Parameters are distances along the dominant axis, the same for all rays, in the direction in which they go: directions
//! scaled to one along it are one and their shears, whose bounds the packets know.

use super::layout::WIDTH;
use super::packet::{Packet, PacketBounds};
use crate::bounds::SLAB_SLACK;

/// Bounds of packets: no ray of them enters a box earlier, or leaves one later, than the beam.
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
    pub start: f32,
    /// Where the search of the last ray ends.
    pub end: f32,
    /// Whether the rays go forward along the dominant axis.
    pub is_forward: bool,
    /// Axes of the ray-triangle test.
    pub axes: [usize; 3],
    /// Least and greatest shears and starts.
    pub bounds: PacketBounds,
}

/// Slots of a node that a beam enters, and where.
pub struct BeamSlots {
    /// The slots.
    pub slots: [u32; WIDTH],
    /// Entry parameters, none greater than that of any ray.
    pub entries: [f32; WIDTH],
}

impl Beam {
    /// Without rays.
    pub const NONE: Self = Self {
        near: [0; 3],
        far: [0; 3],
        octant: 0,
        near_origin: [0.0; 3],
        far_origin: [0.0; 3],
        near_inv: [[0.0; 2]; 3],
        far_inv: [[0.0; 2]; 3],
        start: 0.0,
        end: 0.0,
        is_forward: true,
        axes: [0, 1, 2],
        bounds: Packet::IDLE.bounds,
    };

    /// The beam of some packets; `None` where they had better go one by one, or alone.
    #[inline(always)]
    pub fn new(packets: &[Packet], tree_size: f32) -> Option<Self> {
        let (first, rest) = packets.split_first()?;
        let mut bounds = first.bounds;
        for packet in rest {
            if packet.octant != first.octant || packet.axes != first.axes {
                return None;
            }
            bounds = bounds.union(&packet.bounds);
        }
        let axes = first.axes.map(|k| k % 3);
        let is_forward = first.octant >> axes[2] & 1 == 0;
        let mut beam = Self { octant: first.octant, is_forward, axes, bounds, ..Self::NONE };
        for k in 0..3 {
            let backward = first.octant >> k & 1 == 1;
            beam.near[k] = (2 * k as u32 + u32::from(backward)) * WIDTH as u32;
            beam.far[k] = (2 * k as u32 + 1 - u32::from(backward)) * WIDTH as u32;
            // Rounding is monotonic: what holds for the ends holds for all between, to the bit.
            let [low, high] = bounds.origin[k];
            (beam.near_origin[k], beam.far_origin[k]) = if backward { (low, high) } else { (high, low) };
        }
        let sign = beam.sign();
        for (k, [low, high]) in axes.into_iter().zip([bounds.shear[0], bounds.shear[1], [1.0; 2]]) {
            let (a, b) = (sign / low, sign / high);
            let inv = [a.min(b), a.max(b)];
            beam.near_inv[k] = inv.map(|inv| inv * (1.0 - SLAB_SLACK));
            beam.far_inv[k] = inv.map(|inv| inv * (1.0 + SLAB_SLACK));
        }
        beam.start = f32::INFINITY;
        for packet in packets {
            let [low, high] = packet.reach;
            beam.start = beam.start.min(if is_forward { low } else { -high });
        }
        beam.shorten(packets);
        let is_finite = beam.far_inv.iter().flatten().all(|inv| inv.is_finite());
        (is_finite && bounds.are_close(tree_size)).then_some(beam)
    }

    /// Lets the beam end with its last ray.
    #[inline(always)]
    pub fn shorten(&mut self, packets: &[Packet]) {
        self.end = f32::NEG_INFINITY;
        for packet in packets {
            let [low, high] = packet.reach;
            self.end = self.end.max(if self.is_forward { high } else { -low });
        }
    }

    /// One or minus one: the way along the dominant axis.
    #[inline(always)]
    pub fn sign(&self) -> f32 {
        if self.is_forward { 1.0 } else { -1.0 }
    }

    /// Where all rays start, along the axes of the ray-triangle test, if they start at one point.
    #[inline(always)]
    pub fn point(&self) -> Option<[f32; 3]> {
        let origin = &self.bounds.origin;
        origin.iter().all(|[low, high]| low == high).then(|| self.axes.map(|k| origin[k % 3][0]))
    }
}
