//! The sRGB transfer function on bytes, by table.

/// The fifth root of `x` in 0..1 by Newton's method from above, where it falls monotonically.
const fn fifth_root(x: f64) -> f64 {
    let mut y = 1.0;
    let mut i = 0;
    while i < 64 {
        let y4 = y * y * y * y;
        y -= (y4 * y - x) / (5.0 * y4);
        i += 1;
    }
    y
}

/// IEC 61966-2-1, section 5.2: the encoded value in 0..1 as linear light; the exponent 2.4 is 12 / 5.
const fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        return encoded / 12.92;
    }
    let x = (encoded + 0.055) / 1.055;
    let x4 = x * x * x * x;
    fifth_root(x4 * x4 * x4)
}

/// The decoded values of all bytes.
const DECODED: [f32; 256] = {
    let mut table = [0.0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = decode(i as f64 / 255.0) as f32;
        i += 1;
    }
    table
};

/// Linear light in 0..1 of an sRGB byte.
#[inline]
pub fn srgb8_to_linear(byte: u8) -> f32 {
    DECODED[byte as usize]
}

/// The nearest byte changes to `byte + 1` at this linear value, for each byte but the last: between the values of the two,
/// found by halving their distance.
const NEXT_FROM: [f32; 256] = {
    let mut table = [f32::INFINITY; 256];
    let mut byte = 0;
    while byte < 255 {
        let (below, above) = (DECODED[byte], DECODED[byte + 1]);
        let (mut nearer_below, mut nearer_above) = (below.to_bits(), above.to_bits());
        while nearer_above - nearer_below > 1 {
            let bits = nearer_below + (nearer_above - nearer_below) / 2;
            let x = f32::from_bits(bits);
            if x - below < above - x {
                nearer_below = bits;
            } else {
                nearer_above = bits;
            }
        }
        table[byte] = f32::from_bits(nearer_above);
        byte += 1;
    }
    table
};

/// Parts of 0..1 that have their own entry point into the bytes: narrow enough for one change of byte each at most.
const PARTS: usize = 4096;

/// The byte nearest to the lower end of each part.
const FIRST: [u8; PARTS] = {
    let mut table = [0; PARTS];
    let (mut part, mut byte) = (0, 0);
    while part < PARTS {
        while part as f32 / PARTS as f32 >= NEXT_FROM[byte] {
            byte += 1;
        }
        table[part] = byte as u8;
        part += 1;
    }
    table
};

/// The sRGB byte whose linear light is nearest to `linear`; out of range clamps, NaN is 0.
#[inline]
pub fn linear_to_srgb8(linear: f32) -> u8 {
    if linear >= 1.0 {
        return 255;
    }
    // A product with a power of two is exact; the conversion takes negative numbers and NaN to 0.
    let first = FIRST[usize::from((linear * PARTS as f32) as u16)];
    first + u8::from(linear >= NEXT_FROM[usize::from(first)])
}

/// The parts of 1 that bytes stand for.
const PARTS_OF_ONE: [f32; 256] = {
    let mut table = [0.0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = i as f32 / 255.0;
        i += 1;
    }
    table
};

/// The number in 0..1 that a byte stands for.
#[inline]
pub fn unit8_to_linear(byte: u8) -> f32 {
    PARTS_OF_ONE[byte as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_and_round_trip() {
        assert_eq!(srgb8_to_linear(0), 0.0);
        assert_eq!(srgb8_to_linear(255), 1.0);
        for byte in 0..=255u8 {
            let x = f32::from(byte) / 255.0;
            let formula = if x <= 0.04045 { x / 12.92 } else { libm::powf((x + 0.055) / 1.055, 2.4) };
            assert!((srgb8_to_linear(byte) - formula).abs() < 1e-6);
        }
        // 188 / 255 encodes half the light (0.5029), a customary check value.
        assert!((srgb8_to_linear(188) - 0.5029).abs() < 2e-4, "{}", srgb8_to_linear(188));
        for byte in 0..=255u8 {
            assert_eq!(linear_to_srgb8(srgb8_to_linear(byte)), byte);
        }
        assert_eq!(linear_to_srgb8(f32::NAN), 0);
        assert_eq!(linear_to_srgb8(-1.0), 0);
        assert_eq!(linear_to_srgb8(7.0), 255);
        assert_eq!(linear_to_srgb8(f32::INFINITY), 255);
    }

    /// Against a search of the whole table: at and beside every decoded value, every middle between two and the ends of
    /// every part.
    #[test]
    fn bytes_are_the_nearest() {
        let nearest = |linear: f32| {
            let above = DECODED.partition_point(|&v| v < linear).min(255);
            if above > 0 && linear - DECODED[above - 1] < DECODED[above] - linear { above - 1 } else { above }
        };
        let middles = DECODED.windows(2).map(|w| 0.5 * (w[0] + w[1]));
        let parts = (0..=PARTS).map(|i| i as f32 / PARTS as f32);
        for x in DECODED.into_iter().chain(middles).chain(parts) {
            for x in [x.next_down(), x, x.next_up()] {
                assert_eq!(usize::from(linear_to_srgb8(x)), nearest(x), "{x}");
            }
        }
    }
}
