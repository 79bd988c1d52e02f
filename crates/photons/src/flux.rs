//! Flux in one word: three 8-bit mantissas under a shared 8-bit scale.
//!
//! | bits | what |
//! |---|---|
//! | 0..8, 8..16, 16..24 | red, green, blue mantissa |
//! | 24..32 | scale code c, 2..=255: the scale is 2^(c/2 - 85) for even c, 1.5 * 2^((c-1)/2 - 85) for odd c; 0: black |
//!
//! A channel is mantissa * scale. Half steps of the exponent keep the largest mantissa at 170 or above, so that the
//! quantum is at most 1/170 of the largest channel. Mantissas are rounded up or down at random with the probabilities
//! that make the mean exact: a map holds thousands of photons of equal flux, and rounding them all alike would tint
//! the picture.

use photinus_geometry::Vec3;

/// The scale's code, shifted right by two, is in the place of the upper exponent bits and the first mantissa bit of an
/// f32 ...
pub(crate) const RAW_SCALE_MASK: u32 = 0x3FC0_0000;
/// ... which is then the scale but for this factor.
const RAW_UNIT: f32 = (1u64 << 42) as f32;
/// The least code that is no denormal number.
const LEAST_CODE: u32 = 2;

/// Masks of the mantissas in a word.
pub(crate) const MANTISSA_MASKS: [u32; 3] = [0xFF, 0xFF00, 0x00FF_0000];

/// What takes a mantissa in its place in the word, times the raw scale, to W: powers of two, so that sums of such
/// products may be multiplied once.
pub(crate) const PLACED_UNITS: Vec3 = Vec3::new(RAW_UNIT, RAW_UNIT / 256.0, RAW_UNIT / 65536.0);

/// Largest flux of a channel that can be stored, W.
pub(crate) const MAX_FLUX: f32 = 255.0 * 1.5 * RAW_UNIT;

/// The scale of a word but for the factor in [`PLACED_UNITS`].
#[inline]
pub(crate) fn raw_scale(word: u32) -> f32 {
    f32::from_bits((word >> 2) & RAW_SCALE_MASK)
}

/// The three mantissas of a word in their places.
#[inline]
pub(crate) fn placed_mantissas(word: u32) -> Vec3 {
    Vec3::from_array(MANTISSA_MASKS.map(|mask| (word & mask) as f32))
}

/// The flux of a word, W; exact.
#[inline]
pub(crate) fn unpack(word: u32) -> Vec3 {
    placed_mantissas(word) * raw_scale(word) * PLACED_UNITS
}

/// The octave of the scale of a word; zero for black only.
#[inline]
pub(crate) fn octave(word: u32) -> u32 {
    word >> 25
}

/// The channels of a word in units of an octave at or below its own; exact where they are below 2^32.
#[inline]
pub(crate) fn whole(word: u32, least: u32) -> [u32; 3] {
    let halves = 2 + (word >> 24 & 1);
    // Black has no octave, and no bits that could be moved.
    let octaves = octave(word).wrapping_sub(least);
    [0, 8, 16].map(|place| ((word >> place & 0xFF) * halves).wrapping_shl(octaves))
}

/// The unit of [`whole`] numbers, W; anything where `least` is no octave.
#[inline]
pub(crate) fn whole_unit(least: u32) -> f64 {
    // Half of 2^(octave - 85).
    f64::from_bits(u64::from(least.min(127) + 1023 - 86) << 52)
}

/// Packs a flux whose channels lie in `0..=MAX_FLUX`. `dither` holds a random word a channel.
#[inline]
pub(crate) fn pack(flux: Vec3, dither: [u32; 3]) -> u32 {
    let largest = f64::from(flux.max_element());
    if largest == 0.0 {
        return 0;
    }
    // The least code whose 255 quanta hold the largest channel: bits of an f32 in half octaves, rounded up.
    let scale = |code: u32| f64::from(raw_scale(code << 24)) * f64::from(RAW_UNIT);
    let bits = ((largest * (1.0 / 255.0 / f64::from(RAW_UNIT))) as f32).to_bits();
    let mut code = bits.div_ceil(1 << 22).max(LEAST_CODE);
    if 255.0 * scale(code) < largest {
        code += 1;
    }
    let inv = 1.0 / scale(code);
    let mantissa = |value: f32, dither: u32| {
        let dither = f64::from(dither) * (1.0 / 4_294_967_296.0);
        ((f64::from(value) * inv + dither) as u32).min(255)
    };
    mantissa(flux.x, dither[0]) | mantissa(flux.y, dither[1]) << 8 | mantissa(flux.z, dither[2]) << 16 | code << 24
}

/// Three words that look random and depend on nothing but `words`: the dither of a photon.
#[inline]
pub(crate) fn dither(words: impl IntoIterator<Item = u32>) -> [u32; 3] {
    // Multiply-xorshift mixing in 64 bits with odd constants; each channel takes its own finish.
    let mut h = 0x9E37_79B9_7F4A_7C15u64;
    for w in words {
        h = (h ^ u64::from(w)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
        h ^= h >> 32;
    }
    [0x1000_0001u64, 0x2000_0003, 0x3000_0005].map(|salt| {
        let mut x = (h ^ salt).wrapping_mul(0xA24B_AED4_963E_E407);
        x ^= x >> 29;
        (x.wrapping_mul(0x9FB2_1C65_1E98_DF25) >> 32) as u32
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_decade_keeps_the_documented_error() {
        let mut worst = 0f32;
        for i in 0..200_000u32 {
            let d = dither([i, 17]);
            let [a, b, c] = dither([i, 29]).map(|w| w as f32 / 4_294_967_296.0);
            let level = libm::powf(10.0, -12.0 + 24.0 * (i as f32 / 200_000.0));
            let flux = Vec3::new(a, b * a, c) * level;
            if flux.max_element() == 0.0 {
                continue;
            }
            let error = (unpack(pack(flux, d)) - flux).abs().max_element() / flux.max_element();
            worst = worst.max(error);
        }
        assert!(worst <= 1.0 / 170.0, "seeds 17, 29: {worst} of the largest channel");
        assert!(worst > 1.0 / 200.0, "the bound is reached, or the test saw little: {worst}");
    }

    #[test]
    fn what_the_format_holds_is_kept_exactly() {
        for word in [0u32, 0x8001_02FF, 0x80FF_FFFF, 0x7FFF_00AB, 0xFFFF_FFFF, 0x02FF_0001, 0x0200_0001] {
            for d in [0, 1 << 31, u32::MAX] {
                assert_eq!(pack(unpack(word), [d; 3]), word, "{word:x}");
            }
        }
        assert_eq!(pack(Vec3::ZERO, [u32::MAX; 3]), 0);
        assert_eq!(unpack(pack(Vec3::splat(MAX_FLUX), [u32::MAX; 3])), Vec3::splat(MAX_FLUX));
        assert!(unpack(pack(Vec3::splat(1e-40), [5; 3])).max_element() < 1e-20);
    }

    #[test]
    fn whole_numbers_are_the_flux() {
        for word in [0u32, 0x8001_02FF, 0x81FF_FFFF, 0x7FFF_00AB, 0x0300_0001, 0xFF00_0100] {
            let own = octave(word);
            for least in own.saturating_sub(20).max(1)..=own {
                let flux = whole(word, least).map(|w| (f64::from(w) * whole_unit(least)) as f32);
                assert_eq!(Vec3::from_array(flux), unpack(word), "{word:x} in units of octave {least}");
            }
        }
        assert_eq!(whole(0, 77), [0; 3]);
    }

    /// Equal fluxes: the mean of n packed ones has a standard error of at most half a quantum over sqrt(n).
    #[test]
    fn sums_of_equal_fluxes_are_unbiased() {
        const N: u32 = 200_000;
        for flux in [Vec3::new(1.234e-5, 3.3e-6, 7.7e-8), Vec3::new(0.9, 1.0, 0.00123), Vec3::splat(1e7 / 3.0)] {
            let mut sum = [0f64; 3];
            for i in 0..N {
                for (sum, channel) in sum.iter_mut().zip(unpack(pack(flux, dither([i, 5]))).to_array()) {
                    *sum += f64::from(channel);
                }
            }
            let bound = 5.0 * 0.5 / 170.0 * f64::from(flux.max_element()) / f64::from(N).sqrt();
            for (sum, channel) in sum.into_iter().zip(flux.to_array()) {
                let error = (sum / f64::from(N) - f64::from(channel)).abs();
                assert!(error < bound, "{flux}: {error} against {bound}");
            }
        }
    }
}
