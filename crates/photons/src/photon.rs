//! The photon as it is stored: 24 bytes.

use photinus_geometry::Vec3;

/// A stored photon.
///
/// | bytes | what |
/// |---|---|
/// | 12 | position, f32 |
/// | 4 | flux in W, RGB with a shared exponent |
/// | 4 | direction back to where the photon came from, octahedral, 16 + 16 bits |
/// | 4 | surface normal, octahedral 12 + 12 bits, and 8 bits of flags |
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Photon {
    /// Where it landed.
    pub position: Vec3,
    /// Packed flux.
    pub flux: u32,
    /// Packed direction.
    pub direction: u32,
    /// Packed normal and flags: see the accessors.
    pub surface: u32,
}
