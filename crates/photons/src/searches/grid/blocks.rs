//! Photons sixteen at a time, field by field: the form that the vector kernels read.

use crate::Photon;

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

    /// Squared distance of a lane's photon from `position`; NaN for an empty lane.
    #[inline]
    pub(crate) fn distance_sq(&self, lane: usize, position: [f32; 3]) -> f32 {
        let [dx, dy, dz] = [self.x[lane] - position[0], self.y[lane] - position[1], self.z[lane] - position[2]];
        (dx * dx + dy * dy) + dz * dz
    }
}
