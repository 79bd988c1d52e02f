//! Photons sixteen at a time, field by field: the form that the vector kernels read; and the blocks' boxes.

use crate::Photon;
use photinus_geometry::{Aabb, Vec3};

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

    /// A full block.
    #[inline]
    pub(crate) fn new(photons: &[Photon; LANES]) -> Self {
        let mut block = Self::EMPTY;
        for (lane, photon) in photons.iter().enumerate() {
            block.set(lane, photon);
        }
        block
    }

    /// The least and the largest position: a block has at least one photon.
    #[inline]
    pub(crate) fn bounds(&self) -> Aabb {
        let fold = |lanes: &[f32; LANES]| {
            // Comparisons with the NaN of empty lanes are false.
            let least = lanes.iter().fold(lanes[0], |least, v| if *v < least { *v } else { least });
            let most = lanes.iter().fold(lanes[0], |most, v| if *v > most { *v } else { most });
            (least, most)
        };
        let (x, y, z) = (fold(&self.x), fold(&self.y), fold(&self.z));
        Aabb { min: Vec3::new(x.0, y.0, z.0), max: Vec3::new(x.1, y.1, z.1) }
    }

    #[inline]
    pub(crate) fn set(&mut self, lane: usize, photon: &Photon) {
        let [x, y, z, flux, direction, surface] = photon.to_words();
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
}

impl Boxes {
    pub(crate) fn new(boxes: Vec<Aabb>) -> Self {
        let bounds = std::array::from_fn(|side| {
            let of = |b: &Aabb| if side < 3 { b.min[side] } else { b.max[side - 3] };
            boxes.iter().map(of).chain([f32::NAN; LANES]).collect()
        });
        Self { bounds }
    }

    /// Memory, bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.bounds.iter().map(|b| b.capacity() * size_of::<f32>()).sum()
    }
}
