//! Triangles that the filter left, of the rays of all slots: they are finished together, without a branch that depends on
//! what comes out. Whether a triangle is hit is a coin tossed, and the divisions are long under way when it falls.

use super::kernels::{Four, Kernel, SET_LANES};
use super::layout::WIDTH;
use super::traverse::SLOTS;
use photinus_geometry::Hit;
use photinus_intersect::methods::woop::finish_lanes;

/// Triangles finished at a time.
pub const TOGETHER: usize = 4;

/// All lanes of all slots, and a whole mask to be written.
const ROOM: usize = (SLOTS + 1) * WIDTH;

/// Which slot's ray, and which lane of the block that it is at.
pub struct Candidates {
    slots: [u8; ROOM],
    lanes: [u8; ROOM],
    /// How many there are.
    pub len: usize,
    /// Vertices of those that are finished together, by vertex, axis and place, and their rays' directions.
    sheared: [[f32; TOGETHER]; 9],
    dir_z: [f32; TOGETHER],
}

impl Candidates {
    /// No triangles.
    pub const NONE: Self =
        Self { slots: [0; ROOM], lanes: [0; ROOM], len: 0, sheared: [[0.0; TOGETHER]; 9], dir_z: [1.0; TOGETHER] };

    /// Adds the lanes of a mask.
    #[inline(always)]
    pub fn add(&mut self, slot: u8, mask: u32) {
        let mask = mask as u8;
        self.slots[self.len..][..WIDTH].copy_from_slice(&[slot; WIDTH]);
        self.lanes[self.len..][..WIDTH].copy_from_slice(&SET_LANES[usize::from(mask)]);
        self.len += mask.count_ones() as usize;
    }

    /// Slot and lane of a candidate.
    #[inline(always)]
    pub fn at(&self, i: usize) -> (usize, usize) {
        (usize::from(self.slots[i]) % SLOTS, usize::from(self.lanes[i]) % WIDTH)
    }

    /// Puts a candidate to place `i` of those to be finished: its sheared vertices, and its ray's direction along the
    /// third axis.
    #[inline(always)]
    pub fn shear(&mut self, i: usize, vertices: &[[f32; 3]; 3], dir_z: f32) {
        for (row, value) in self.sheared.iter_mut().zip(vertices.as_flattened()) {
            row[i] = *value;
        }
        self.dir_z[i] = dir_z;
    }

    /// Finishes what was put to all places, the latest and older: which are hits, and their parameters and weights.
    #[inline(always)]
    pub fn finish<K: Kernel>(&self, kernel: K) -> (u8, [[f32; TOGETHER]; 3]) {
        let zeros = kernel.four();
        let mut sheared = [[zeros; 3]; 3];
        for (i, row) in self.sheared.iter().enumerate() {
            sheared[i / 3][i % 3] = zeros.load(row);
        }
        let found = finish_lanes(&sheared, zeros.load(&self.dir_z));
        (found.hits, [found.t.rounded(), found.alpha.rounded(), found.beta.rounded()])
    }
}

/// One of two hits, without a branch.
#[inline(always)]
pub fn choose(first: bool, a: Hit, b: Hit) -> Hit {
    let mask = 0u32.wrapping_sub(u32::from(first));
    let pick = |a: u32, b: u32| (a & mask) | (b & !mask);
    let number = |a: f32, b: f32| f32::from_bits(pick(a.to_bits(), b.to_bits()));
    Hit {
        t: number(a.t, b.t),
        alpha: number(a.alpha, b.alpha),
        beta: number(a.beta, b.beta),
        prim: pick(a.prim, b.prim),
    }
}
