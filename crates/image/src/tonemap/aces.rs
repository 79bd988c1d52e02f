//! `aces`: Narkowicz 2016, "ACES Filmic Tone Mapping Curve": a rational fit of the ACES reference and output transforms.

/// x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), channel by channel.
pub(super) fn map(rgb: [f32; 3]) -> [f32; 3] {
    rgb.map(|x| (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14))
}
