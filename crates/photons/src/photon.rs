//! The photon as it is stored: 24 bytes.

use crate::{PhotonError, flux, octahedral};
use photinus_geometry::Vec3;

/// Largest component of an encoded direction.
const DIRECTION_MAX: i32 = 32767;
/// Largest component of an encoded normal.
pub(crate) const NORMAL_MAX: i32 = 2047;
/// The bits of a surface word that hold the normal: twelve a component, x highest.
pub(crate) const NORMAL_MASK: u32 = 0xFFFF_FF00;
/// The bits of a surface word below the normal: the depth, seven bits, above the caustic flag. The least word with a
/// normal and the word's own low byte thus compare as depths do.
pub(crate) const LOW_MASK: u32 = 0x0000_00FF;
/// Largest depth stored.
const MAX_DEPTH: u32 = 127;

/// A stored photon.
///
/// | bytes | what |
/// |---|---|
/// | 12 | position, f32 |
/// | 4 | flux in W, RGB: three 8-bit mantissas under a shared scale in steps of half an octave |
/// | 4 | direction back to where the photon came from, octahedral, 16 + 16 bits |
/// | 4 | surface normal, octahedral, 12 + 12 bits; depth, 7 bits; caustic flag, 1 bit |
///
/// Positions lie within 1e18 of the origin along each axis, so that no squared distance overflows.
///
/// Errors: each channel of the flux is within 1/170 of the largest channel (1/350 of it on the mean) and exact in the
/// mean over photons; that holds for largest channels of 1e-23 W to 1.6e15 W, smaller ones are rounded to multiples of
/// 2^-84 W. The direction is within 7e-5 rad, the normal within 1.1e-3 rad; both are exact along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Photon {
    position: Vec3,
    flux: u32,
    direction: u32,
    surface: u32,
}

const _: () = assert!(size_of::<Photon>() == 24);

/// The farthest that photons lie from the origin along an axis.
pub(crate) const FARTHEST: f32 = 1e18;

/// Whether a point may be searched from or held: not NaN and not farther out than [`Photon`] says.
#[inline]
pub(crate) fn is_searchable(position: Vec3) -> bool {
    position.abs().cmple(Vec3::splat(FARTHEST)).all()
}

impl Photon {
    /// Packs a photon.
    ///
    /// `position` in scene units; `flux` in W, each channel in `0..1.6e15`; `direction` points back to where the
    /// photon came from and `normal` is that of the surface, both of any length; `depth` counts the path's surface
    /// hits up to this one, 1 for a photon straight from its light, and is stored as 1..=127 (more becomes 127).
    ///
    /// # Errors
    /// A position beyond 1e18 or NaN, a flux out of range, a direction or normal that is zero or not finite.
    #[inline]
    pub fn new(
        position: Vec3,
        flux: Vec3,
        direction: Vec3,
        normal: Vec3,
        depth: u32,
        caustic: bool,
    ) -> Result<Self, PhotonError> {
        let is_direction = |v: Vec3| v.is_finite() && v != Vec3::ZERO;
        if !is_searchable(position) {
            return Err(PhotonError::Position(position));
        }
        if !(flux.cmpge(Vec3::ZERO).all() && flux.cmple(Vec3::splat(flux::MAX_FLUX)).all()) {
            return Err(PhotonError::Flux(flux));
        }
        if !is_direction(direction) {
            return Err(PhotonError::Direction(direction));
        }
        if !is_direction(normal) {
            return Err(PhotonError::Normal(normal));
        }
        let [dx, dy] = octahedral::encode(direction, DIRECTION_MAX);
        let direction = (dx as u32 & 0xFFFF) | (dy as u32) << 16;
        let [nx, ny] = octahedral::encode(normal, NORMAL_MAX);
        let surface =
            (nx as u32) << 20 | (ny as u32 & 0xFFF) << 8 | depth.clamp(1, MAX_DEPTH) << 1 | u32::from(caustic);
        let [x, y, z] = position.to_array().map(f32::to_bits);
        let [r, g, b] = flux.to_array().map(f32::to_bits);
        let flux = flux::pack(flux, flux::dither([x, y, z, r, g, b, direction]));
        Ok(Self { position, flux, direction, surface })
    }

    /// A photon from its six words as [`Photon::to_words`] gives them.
    ///
    /// # Errors
    /// A position beyond 1e18 or NaN; every value of the other words is a photon.
    pub fn from_words(words: [u32; 6]) -> Result<Self, PhotonError> {
        let [x, y, z, flux, direction, surface] = words;
        let position = Vec3::new(f32::from_bits(x), f32::from_bits(y), f32::from_bits(z));
        if is_searchable(position) {
            Ok(Self { position, flux, direction, surface })
        } else {
            Err(PhotonError::Position(position))
        }
    }

    /// A photon from fields that came out of one.
    #[inline]
    pub(crate) fn from_parts(position: [f32; 3], flux: u32, direction: u32, surface: u32) -> Self {
        Self { position: Vec3::from_array(position), flux, direction, surface }
    }

    /// The six words in memory order: position x, y, z as f32 bits, flux, direction, surface.
    pub fn to_words(&self) -> [u32; 6] {
        let [x, y, z] = self.position.to_array().map(f32::to_bits);
        [x, y, z, self.flux, self.direction, self.surface]
    }

    /// Where the photon landed, scene units.
    #[inline]
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// Flux carried, W, one number a channel.
    #[inline]
    pub fn flux(&self) -> Vec3 {
        flux::unpack(self.flux)
    }

    /// Unit direction back to where the photon came from.
    #[inline]
    pub fn direction(&self) -> Vec3 {
        octahedral::decode([(self.direction << 16) as i32 >> 16, self.direction as i32 >> 16], DIRECTION_MAX)
    }

    /// Unit normal of the surface that the photon landed on.
    #[inline]
    pub fn normal(&self) -> Vec3 {
        octahedral::decode(normal_code(self.surface), NORMAL_MAX)
    }

    /// Surface hits of the photon's path up to this one, 1..=127; 127 stands for more, too.
    #[inline]
    pub fn depth(&self) -> u32 {
        (self.surface & LOW_MASK) >> 1
    }

    /// Whether the photon came from its light through specular surfaces only, by the caller's own definition.
    #[inline]
    pub fn is_caustic(&self) -> bool {
        self.surface & 1 != 0
    }

    #[inline]
    pub(crate) fn surface_word(&self) -> u32 {
        self.surface
    }
}

/// The largest low byte of surface words of at most this depth.
#[inline]
pub(crate) fn low_limit(max_depth: u32) -> u32 {
    max_depth.min(MAX_DEPTH) << 1 | 1
}

/// The octahedral integers of a surface word's normal.
#[inline]
pub(crate) fn normal_code(surface: u32) -> [i32; 2] {
    [surface as i32 >> 20, (surface << 12) as i32 >> 20]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn photon(position: Vec3, flux: Vec3) -> Result<Photon, PhotonError> {
        Photon::new(position, flux, Vec3::Z, Vec3::Y, 1, false)
    }

    #[test]
    fn fields_come_back() {
        let (position, flux) = (Vec3::new(1e6, -2.5, 1e-20), Vec3::new(0.25, 1.0, 0.5));
        let (direction, normal) = (Vec3::new(1.0, -2.0, -3.0).normalize(), Vec3::new(-0.6, 0.0, -0.8));
        for (depth, stored) in [(0, 1), (1, 1), (5, 5), (127, 127), (128, 127), (u32::MAX, 127)] {
            for caustic in [false, true] {
                let p = Photon::new(position, flux, direction, normal, depth, caustic).unwrap();
                assert_eq!(p.position(), position);
                assert!((p.flux() - flux).abs().max_element() < 1.0 / 170.0);
                assert!((p.direction() - direction).length() < 7e-5);
                assert!((p.normal() - normal).length() < 1.1e-3);
                assert_eq!((p.depth(), p.is_caustic()), (stored, caustic));
                assert_eq!(Photon::from_words(p.to_words()), Ok(p));
            }
        }
    }

    #[test]
    fn what_is_no_photon_is_refused() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let v = Vec3::new(0.0, bad, 0.0);
            assert!(photon(Vec3::new(0.0, 0.0, 1.01e18), Vec3::ONE).is_err());
            assert!(matches!(photon(v, Vec3::ONE), Err(PhotonError::Position(_))));
            assert!(matches!(photon(Vec3::ZERO, v), Err(PhotonError::Flux(_))));
            assert!(matches!(Photon::new(Vec3::ZERO, Vec3::ONE, v, Vec3::Z, 1, false), Err(PhotonError::Direction(_))));
            assert!(matches!(Photon::new(Vec3::ZERO, Vec3::ONE, Vec3::Z, v, 1, false), Err(PhotonError::Normal(_))));
        }
        assert!(matches!(photon(Vec3::ZERO, Vec3::new(1.0, -1e-30, 1.0)), Err(PhotonError::Flux(_))));
        assert!(matches!(photon(Vec3::ZERO, Vec3::new(1.0, 1.7e15, 1.0)), Err(PhotonError::Flux(_))));
        let zero = Photon::new(Vec3::ZERO, Vec3::ONE, Vec3::ZERO, Vec3::Z, 1, false);
        assert!(matches!(zero, Err(PhotonError::Direction(_))));
        assert!(Photon::from_words([f32::NAN.to_bits(), 0, 0, 0, 0, 0]).is_err());
        assert_eq!(photon(Vec3::ZERO, Vec3::ZERO).unwrap().flux(), Vec3::ZERO);
    }
}
