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

/// The nearest of 256 codes of an sRGB sample; NaN becomes 0.
fn quantise(encoded: f32) -> u8 {
    // `as` saturates and turns NaN into 0.
    (encoded * 255.0 + 0.5) as u8
}

/// Parts of 0..1 that have their own entry point into the codes: narrow enough for the end of one code each.
const PARTS: usize = 4096;

/// The codes of linear light by table: what [`linear_to_srgb`] gives, rounded to eight bits, without its power.
pub(crate) struct SrgbCodes {
    /// For each code the least light of the next one; infinite for the last.
    ends: [f32; 256],
    /// The code at the lower end of each part.
    first: [u8; PARTS],
}

impl SrgbCodes {
    /// Looks for the ends of all codes.
    pub fn new() -> Self {
        let code = |linear: f32| quantise(linear_to_srgb(linear));
        let mut ends = [f32::INFINITY; 256];
        for (k, end) in ends[..255].iter_mut().enumerate() {
            // The inverse curve leads close to it. Positive floats are ordered as their bits.
            let near = srgb_to_linear((k as f32 + 0.5) / 255.0);
            let (mut below, mut reached) = ((near * 0.9999).to_bits(), (near * 1.0001).to_bits());
            debug_assert!(
                usize::from(code(f32::from_bits(below))) <= k && usize::from(code(f32::from_bits(reached))) > k
            );
            while reached - below > 1 {
                let middle = below + (reached - below) / 2;
                if usize::from(code(f32::from_bits(middle))) > k { reached = middle } else { below = middle }
            }
            *end = f32::from_bits(reached);
        }
        // A part's code is the number of ends that it has reached.
        let mut reached = 0;
        let first = std::array::from_fn(|part| {
            while part as f32 / PARTS as f32 >= ends[reached] {
                reached += 1;
            }
            reached as u8
        });
        Self { ends, first }
    }

    /// The code of linear light; out of range clamps, NaN is 0.
    pub fn nearest(&self, linear: f32) -> u8 {
        if linear >= 1.0 {
            return 255;
        }
        // A product with a power of two is exact; the conversion takes negative numbers and NaN to 0.
        let code = self.first[usize::from((linear * PARTS as f32) as u16)];
        // No branch: which of two codes it is is nothing to guess.
        code + u8::from(linear >= self.ends[usize::from(code)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the formula: around the end of every code and every part, and everywhere between.
    #[test]
    fn codes_are_those_of_the_formula() {
        let codes = SrgbCodes::new();
        let formula = |linear: f32| quantise(linear_to_srgb(linear.clamp(0.0, 1.0)));
        let around = |x: f32| (x.to_bits().saturating_sub(300)..x.to_bits() + 300).map(f32::from_bits);
        let parts = (0..=PARTS).map(|i| i as f32 / PARTS as f32);
        let between = (0..1_000_000).map(|i| i as f32 / 999_983.0);
        for x in codes.ends[..255].iter().copied().chain(parts).flat_map(around).chain(between) {
            assert_eq!(codes.nearest(x), formula(x), "{x}");
        }
        for (x, code) in [(f32::NAN, 0), (-1.0, 0), (f32::NEG_INFINITY, 0), (7.0, 255), (f32::INFINITY, 255)] {
            assert_eq!(codes.nearest(x), code);
        }
    }
}
