//! `reinhard`: Reinhard, Stark, Shirley and Ferwerda 2002, "Photographic Tone Reproduction for Digital Images", eq. 4.

use crate::colour::luminance;

/// Smallest luminance that maps to white.
const WHITE: f32 = 4.0;

/// L' = L (1 + L / white^2) / (1 + L) on luminance; the colour keeps its ratios until a channel clips.
pub(super) fn map(rgb: [f32; 3]) -> [f32; 3] {
    let l = luminance(rgb);
    let scale = (1.0 + l / (WHITE * WHITE)) / (1.0 + l);
    rgb.map(|c| c * scale)
}
