//! The one list of tone curves: command line, help, documentation and tests are fed from it.

use super::{aces, agx, filmic, reinhard, srgb};

/// A tone curve with its name.
#[derive(Clone, Copy, Debug)]
pub struct Tonemap {
    /// Name on the command line.
    pub name: &'static str,
    /// One line of help.
    pub summary: &'static str,
    curve: fn([f32; 3]) -> [f32; 3],
}

/// All tone curves; the first is the default.
pub const TONEMAPS: &[Tonemap] = &[
    Tonemap { name: "srgb", summary: "clip at 1, no curve (default)", curve: srgb::map },
    Tonemap { name: "reinhard", summary: "extended Reinhard on luminance, white at 4", curve: reinhard::map },
    Tonemap { name: "filmic", summary: "Hable's filmic curve, white at 11.2", curve: filmic::map },
    Tonemap { name: "aces", summary: "Narkowicz's fit of the ACES curve", curve: aces::map },
    Tonemap { name: "agx", summary: "AgX, base look, in Wrensch's polynomial form", curve: agx::map },
];

impl Tonemap {
    /// Linear scene light to linear display light, each channel in 0..1; encode the result with the sRGB curve.
    /// Negative and NaN channels count as 0, infinite ones as white.
    pub fn map(&self, rgb: [f32; 3]) -> [f32; 3] {
        // False for NaN; the bound keeps squares and sums finite.
        let light = rgb.map(|c| if c > 0.0 { c.min(LARGEST) } else { 0.0 });
        (self.curve)(light).map(|c| c.clamp(0.0, 1.0))
    }
}

/// Brightest light that a curve is given: far beyond every white point, and its square is finite.
const LARGEST: f32 = 1e18;

impl Default for Tonemap {
    fn default() -> Self {
        TONEMAPS[0]
    }
}
