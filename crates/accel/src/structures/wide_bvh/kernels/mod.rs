//! The two tests of the hot loop, eight lanes wide, once per instruction set.
//!
//! Both are filters: a box may be entered in vain, and a triangle that passes is finished in doubles by
//! [`photinus_intersect::methods::woop::finish`]. They let through all that can be hit, so the results do not depend
//! on the kernel; and they compute the same operations in the same order, so that neither does the work.

#[cfg(target_arch = "x86_64")]
pub mod avx2;
#[cfg(target_arch = "x86_64")]
pub mod avx512;
#[cfg(target_arch = "x86_64")]
mod eight;
#[cfg(target_arch = "x86_64")]
mod four;
pub mod scalar;
pub mod sixteen;

use super::beam::{Beam, BeamSlots};
use super::layout::{Child, Node, TriangleBlock, WIDTH};
use super::packet::{PACKET, Packet};
use super::ray_setup::RaySetup;
pub use crate::reach::Reach;
use photinus_geometry::Ray;
use photinus_intersect::doubles::{self, Doubles};
use sixteen::Sixteen;

/// A kernel: the tests of one instruction set. Having one proves that the machine can run it.
pub trait Kernel: Copy {
    /// A number for each ray of a packet.
    type Sixteen: Sixteen;
    /// Doubles in registers that leave other tests their ports.
    type Four: Four;

    /// Writes the children of `node` that the ray may enter at a parameter up to `t_max` to `out`, from far to near,
    /// and returns how many they are; what lies behind them in `out` is left undefined.
    fn node(self, ray: &RaySetup, node: &Node, t_max: f32, out: Lanes<'_>) -> usize;

    /// Triangles of `block` that the ray may hit within its reach, as a mask of lanes.
    fn block(self, ray: &RaySetup, reach: &Reach, block: &TriangleBlock) -> u32;

    /// Of eight places of a stack those that the ray enters at `t_max` at most, in front and in order, and which they are
    /// as a mask; what lies behind them is left undefined.
    fn keep(self, from: Lanes<'_>, t_max: f32) -> ([f32; WIDTH], [Child; WIDTH], u8);

    /// Writes the slots of `node` that the beam may enter, and where, to `out`, from far to near, and returns how many they
    /// are; what lies behind them is left undefined.
    fn beam(self, beam: &Beam, node: &Node, out: &mut BeamSlots) -> usize;

    /// Triangles of `block` that any ray of the packet may hit within its reach, as a mask of lanes: those that do not lie
    /// on one side of all rays, of which bounds in the same arithmetic, whose rounding is monotonic, are sure.
    fn packet_block(self, packet: &Packet, block: &TriangleBlock) -> u32;

    /// Zeros, from which the numbers of packets are made.
    fn zeros(self) -> Self::Sixteen;

    /// Zeros, from which doubles are made.
    fn four(self) -> Self::Four;

    /// The rays' components by ray, in the order in which a ray holds them.
    fn components(self, rays: &[Ray; PACKET]) -> [Self::Sixteen; 8];

    /// Asks for so many cache lines from `start` on to be near soon.
    fn prefetch(self, start: *const u8, lines: usize);
}

/// Four doubles.
pub trait Four: Doubles {
    /// Numbers from memory, into the registers of `self`; exact.
    fn load(self, from: &[f32; 4]) -> Self;

    /// The nearest numbers.
    fn rounded(self) -> [f32; 4];
}

impl Four for doubles::Lanes<4> {
    #[inline(always)]
    fn load(self, from: &[f32; 4]) -> Self {
        Self(from.map(f64::from))
    }

    #[inline(always)]
    fn rounded(self) -> [f32; 4] {
        self.0.map(|x| x as f32)
    }
}

/// For each mask of eight lanes the indices of those that are set, in front.
pub static SET_LANES: [[u8; WIDTH]; 256] = {
    let mut table = [[0; WIDTH]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < WIDTH {
            if mask >> lane & 1 == 1 {
                table[mask][count] = lane as u8;
                count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
};

/// Eight places of a stack: where the ray enters, and what.
pub struct Lanes<'a> {
    /// Entry parameters.
    pub entries: &'a mut [f32; WIDTH],
    /// Children.
    pub children: &'a mut [Child; WIDTH],
}
