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

/// The sRGB byte whose linear light is nearest to `linear`; out of range clamps, NaN is 0.
pub fn linear_to_srgb8(linear: f32) -> u8 {
    let table = &DECODED;
    let above = table.partition_point(|&v| v < linear);
    match above {
        0 => 0,
        256 => 255,
        i if linear - table[i - 1] < table[i] - linear => (i - 1) as u8,
        i => i as u8,
    }
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
    }
}
