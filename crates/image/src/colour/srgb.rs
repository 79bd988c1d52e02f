//! The sRGB transfer function and Rec. 709 luminance.

/// Decodes one sRGB sample (0..1) to linear light; IEC 61966-2-1, values outside 0..1 continue the same curve, NaN stays NaN.
pub fn srgb_to_linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::powf((encoded + 0.055) / 1.055, 2.4) }
}

/// Encodes linear light (0..1) as an sRGB sample, the inverse of [`srgb_to_linear`].
pub fn linear_to_srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 }
}

/// Luminance of linear RGB relative to white = 1; ITU-R BT.709-6, item 3.2 (luma weights are those of the primaries).
pub fn luminance(rgb: [f32; 3]) -> f32 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}
