//! The two tests of the hot loop, eight lanes wide, once per instruction set.
//!
//! Both are filters: a box may be entered in vain, and a triangle that passes is finished in doubles by
//! [`photinus_intersect::methods::woop::finish`]. They let through all that can be hit, so the results do not depend
//! on the kernel; and they compute the same operations in the same order, so that neither does the work.

#[cfg(target_arch = "x86_64")]
pub mod avx2;
#[cfg(target_arch = "x86_64")]
pub mod avx512;
pub mod scalar;

use super::layout::{Child, Node, TriangleBlock, WIDTH};
use super::packet::{Beam, BeamSlots, ByRay, Packet};
use super::ray_setup::RaySetup;
pub use crate::reach::Reach;

/// A kernel: the tests of one instruction set. Having one proves that the machine can run it.
pub trait Kernel: Copy {
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

    /// Rays of the packet that may enter the box in `slot`, as a mask.
    fn packet_box(self, packet: &Packet, node: &Node, slot: usize) -> u16;

    /// Rays of the packet that may hit the triangle in `lane` within their reach, as a mask; what [`Kernel::block`] says of
    /// them one by one. Its vertices, sheared for each ray, go to `sheared`, by vertex and axis.
    fn packet_triangle(self, packet: &Packet, block: &TriangleBlock, lane: usize, sheared: &mut [ByRay; 9]) -> u16;

    /// The least and the greatest of all; undefined where one is not a number.
    fn extremes(self, x: &ByRay) -> [f32; 2];

    /// Asks for the five cache lines from `start`, a node or a block, to be near soon.
    fn prefetch(self, start: *const u8);
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
