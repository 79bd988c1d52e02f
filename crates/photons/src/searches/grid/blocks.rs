//! Photons sixteen at a time, field by field: the form that the vector kernels read; and the blocks' boxes and normals.

use super::facing;
use crate::Photon;
use photinus_geometry::{Aabb, Vec3};
use rayon::prelude::*;

/// Blocks that are worth a task of their own.
pub(crate) const BLOCKS_A_TASK: usize = 1 << 11;
/// Photons in a block: the virtual lanes of every kernel.
pub(crate) const LANES: usize = 16;

/// Sixteen photons. Lanes past the last photon hold NaN positions, which no query finds.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Block {
    pub(crate) x: [f32; LANES],
    pub(crate) y: [f32; LANES],
    pub(crate) z: [f32; LANES],
    pub(crate) flux: [u32; LANES],
    pub(crate) surface: [u32; LANES],
    pub(crate) direction: [u32; LANES],
}

const _: () = assert!(size_of::<Block>() == LANES * size_of::<Photon>());

impl Block {
    pub(crate) const EMPTY: Self = Self {
        x: [f32::NAN; LANES],
        y: [f32::NAN; LANES],
        z: [f32::NAN; LANES],
        flux: [0; LANES],
        surface: [0; LANES],
        direction: [0; LANES],
    };

    /// The least and the largest position: a block has at least one photon.
    #[inline]
    pub(crate) fn bounds(&self) -> Aabb {
        // In halves, which vectors do lane by lane. A comparison with the NaN of an empty lane is false and takes the
        // other: lanes are empty from the last down, so that lane 0 never is.
        let fold = |lanes: &[f32; LANES]| {
            let (mut least, mut most) = (*lanes, *lanes);
            let mut half = LANES / 2;
            while half > 0 {
                for i in 0..half {
                    least[i] = if least[i + half] < least[i] { least[i + half] } else { least[i] };
                    most[i] = if most[i + half] > most[i] { most[i + half] } else { most[i] };
                }
                half /= 2;
            }
            (least[0], most[0])
        };
        let (x, y, z) = (fold(&self.x), fold(&self.y), fold(&self.z));
        Aabb { min: Vec3::new(x.0, y.0, z.0), max: Vec3::new(x.1, y.1, z.1) }
    }

    /// Puts the words of a photon into a lane.
    #[inline]
    pub(crate) fn set(&mut self, lane: usize, [x, y, z, flux, direction, surface]: [u32; 6]) {
        self.x[lane] = f32::from_bits(x);
        self.y[lane] = f32::from_bits(y);
        self.z[lane] = f32::from_bits(z);
        self.flux[lane] = flux;
        self.direction[lane] = direction;
        self.surface[lane] = surface;
    }

    /// The photon of a lane.
    #[inline]
    pub(crate) fn photon(&self, lane: usize) -> Photon {
        Photon::from_parts(
            [self.x[lane], self.y[lane], self.z[lane]],
            self.flux[lane],
            self.direction[lane],
            self.surface[lane],
        )
    }

    /// Squared distance of each lane's photon from `position`; NaN for an empty lane.
    #[inline]
    pub(crate) fn distances_sq(&self, position: Vec3) -> [f32; LANES] {
        std::array::from_fn(|lane| {
            let d = [self.x[lane] - position.x, self.y[lane] - position.y, self.z[lane] - position.z];
            (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]
        })
    }
}

/// Bounds of every block's photons, field by field, with sixteen boxes that nothing touches behind the last.
#[derive(Debug, Default)]
pub(crate) struct Boxes {
    /// Least x, y, z, then largest x, y, z.
    pub(crate) bounds: [Vec<f32>; 6],
    /// Which ways their photons face, see [`facing`].
    pub(crate) facing: Vec<u32>,
}

impl Boxes {
    /// The boxes of blocks, each of which has at least one photon.
    pub(crate) fn new(blocks: &[Block]) -> Self {
        let (mut boxes, mut facing) = (Vec::new(), Vec::new());
        let described = blocks.par_iter().with_min_len(BLOCKS_A_TASK).map(|b| (b.bounds(), facing::of_block(b)));
        described.unzip_into_vecs(&mut boxes, &mut facing);
        facing.extend([0; LANES]);
        let bounds = std::array::from_fn(|side| {
            let of = |b: &Aabb| if side < 3 { b.min[side] } else { b.max[side - 3] };
            boxes.iter().map(of).chain([f32::NAN; LANES]).collect()
        });
        Self { bounds, facing }
    }

    /// Memory, bytes.
    pub(crate) fn bytes(&self) -> usize {
        let facing = self.facing.capacity() * size_of::<u32>();
        facing + self.bounds.iter().map(|b| b.capacity() * size_of::<f32>()).sum::<usize>()
    }
}
